#include "baselines/engines/laws.h"

#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

template <int Dim>
void refuse_law(const std::string& method, const ContactLaw<Dim>& law, const Capabilities& capabilities) {
  const auto refuse = [&](const std::string& what) {
    throw Unsupported(fmt::format("{}: it has no {}", method, what));
  };
  if (law.restitution > 0 && !capabilities.restitution) {
    refuse(fmt::format("coefficient of restitution (restitution = {})", law.restitution));
  }
  if constexpr (Dim == 3) {
    if (law.mu > 0 && law.e_r > 0 && !capabilities.torsional_friction) {
      refuse(fmt::format("torsional friction (e_r = {} m)", law.e_r));
    }
    if (law.mu > 0 && law.e_t != law.e_o && !capabilities.anisotropic_friction) {
      refuse(fmt::format("anisotropic friction (e_t = {}, e_o = {})", law.e_t, law.e_o));
    }
  }
}

}  // namespace

template <int Dim>
void refuse_unsupported(const std::string& method, const Scene<Dim>& scene,
                        const Capabilities& capabilities) {
  refuse_law(method, scene.contact_law, capabilities);
  for (const auto& pair : scene.pair_laws) refuse_law(method, pair.law, capabilities);
  if (!scene.joints.empty() && !capabilities.joints) {
    throw Unsupported(
        fmt::format("{}: the adapter has no joints, the scene has {}", method, scene.joints.size()));
  }
}
template void refuse_unsupported(const std::string&, const Scene<2>&, const Capabilities&);
template void refuse_unsupported(const std::string&, const Scene<3>&, const Capabilities&);

}  // namespace touchstone::engines
