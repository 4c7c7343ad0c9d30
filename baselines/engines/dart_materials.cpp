#include "baselines/engines/dart_materials.h"

#include <algorithm>
#include <cmath>

#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

/// Calls use(i, j, law) for every two bodies that can touch: not both fixed.
template <typename Use>
void for_each_pair(const Scene<3>& scene, const Use& use) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
      if (scene.bodies[i].fixed && scene.bodies[j].fixed) continue;
      use(i, j, scene.law(static_cast<int>(i), static_cast<int>(j)));
    }
  }
}

[[noreturn]] void refuse(const Scene<3>& scene, std::size_t i, std::size_t j, const char* what) {
  throw Unsupported(fmt::format("DART: the {} of '{}' and '{}' cannot be made of one number a body", what,
                                scene.bodies[i].name, scene.bodies[j].name));
}

/// The smaller of two numbers is the law of each pair if each body has the largest of its pairs' and that
/// fits.
void set_friction(const Scene<3>& scene, std::vector<DartMaterial>& materials) {
  for_each_pair(scene, [&](std::size_t i, std::size_t j, const ContactLaw<3>& law) {
    for (DartMaterial* m : {&materials[i], &materials[j]}) {
      m->mu_t = std::max(m->mu_t, law.mu * law.e_t);
      m->mu_o = std::max(m->mu_o, law.mu * law.e_o);
      if (law.e_t != law.e_o) m->tangent = law.tangent;
    }
  });
  for_each_pair(scene, [&](std::size_t i, std::size_t j, const ContactLaw<3>& law) {
    const auto& a = materials[i];
    const auto& b = materials[j];
    if (std::min(a.mu_t, b.mu_t) != law.mu * law.e_t || std::min(a.mu_o, b.mu_o) != law.mu * law.e_o) {
      refuse(scene, i, j, "friction");
    }
    if (law.e_t != law.e_o && (a.tangent != law.tangent || b.tangent != law.tangent)) {
      refuse(scene, i, j, "friction's direction");
    }
  });
}

/// Their square roots, if one coefficient holds everywhere.
void set_restitution(const Scene<3>& scene, std::vector<DartMaterial>& materials) {
  const double e = scene.contact_law.restitution;
  for_each_pair(scene, [&](std::size_t i, std::size_t j, const ContactLaw<3>& law) {
    if (law.restitution != e) refuse(scene, i, j, "restitution");
  });
  for (auto& material : materials) material.restitution = std::sqrt(e);
}

}  // namespace

std::vector<DartMaterial> dart_materials(const Scene<3>& scene) {
  std::vector<DartMaterial> materials(scene.bodies.size());
  set_friction(scene, materials);
  set_restitution(scene, materials);
  return materials;
}

}  // namespace touchstone::engines
