#include "core/model/scene.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/model/errors.h"

namespace touchstone {

namespace {

void require_finite_nonnegative(double value, const std::string& field, const std::string& unit) {
  if (!(value >= 0) || !std::isfinite(value)) {
    throw InputError(field, value, fmt::format("a finite number >= 0{}", unit));
  }
}

void require_finite(bool finite, const std::string& field) {
  if (!finite) throw InputError(field, "a value that is not finite", "finite numbers");
}

template <int Dim>
void validate_law(const ContactLaw<Dim>& law, const std::string& field) {
  require_finite_nonnegative(law.mu, field + ".mu", "");
  for (const auto& [value, name] : {std::pair{law.e_t, ".e_t"}, std::pair{law.e_o, ".e_o"}}) {
    if (!(value > 0) || !std::isfinite(value)) throw InputError(field + name, value, "a finite number > 0");
  }
  require_finite_nonnegative(law.e_r, field + ".e_r", " [m]");
  if (!(law.restitution >= 0 && law.restitution <= 1)) {
    throw InputError(field + ".restitution", law.restitution, "a number from 0 to 1");
  }
  if (!law.tangent.allFinite() || law.tangent.norm() == 0) {
    throw InputError(field + ".tangent", "zero or not finite", "a direction");
  }
}

void validate_inertia(const Inertia<2>& inertia, const std::string& field) {
  if (!(inertia(0, 0) > 0) || !std::isfinite(inertia(0, 0))) {
    throw InputError(field, inertia(0, 0), "a finite number > 0 [kg m^2]");
  }
}

/// Principal moments are positive and none exceeds the sum of the other two, or no mass distribution has
/// them.
void validate_inertia(const Inertia<3>& inertia, const std::string& field) {
  require_finite(inertia.allFinite(), field);
  const double scale = inertia.cwiseAbs().maxCoeff();
  if ((inertia - inertia.transpose()).cwiseAbs().maxCoeff() > 1e-12 * scale) {
    throw InputError(field, "a matrix that is not symmetric", "a symmetric matrix");
  }
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Inertia<3>>(inertia).eigenvalues();
  if (!(principal[0] > 0))
    throw InputError(field + " (least principal moment)", principal[0], "> 0 [kg m^2]");
  if (principal[2] > (principal[0] + principal[1]) * (1 + 1e-9)) {
    throw InputError(field + " (largest principal moment)", principal[2],
                     fmt::format("at most the sum of the other two, {}", principal[0] + principal[1]));
  }
}

template <int Dim>
void validate_body(const Body<Dim>& body) {
  const std::string field = fmt::format("body '{}'", body.name);
  require_finite(body.pose.is_finite(), field + " pose");
  validate(body.shape, field + " shape");
  if (body.fixed) return;
  if (!(body.mass > 0) || !std::isfinite(body.mass)) {
    throw InputError(field + " mass", body.mass, "a finite number > 0 [kg]");
  }
  validate_inertia(body.inertia, field + " inertia");
  require_finite(body.velocity.allFinite(), field + " velocity");
  require_finite(body.force.allFinite(), field + " force");
}

template <int Dim>
void validate_joint(const Joint<Dim>& joint, const std::vector<Body<Dim>>& bodies) {
  const int count = static_cast<int>(bodies.size());
  for (const int index : {joint.body_a, joint.body_b}) {
    if (index < 0 || index >= count)
      throw InputError("joint body", std::to_string(index), "an existing body");
  }
  if (joint.body_a == joint.body_b) throw InputError("joint", "one body twice", "two different bodies");
  if (bodies[static_cast<std::size_t>(joint.body_a)].fixed &&
      bodies[static_cast<std::size_t>(joint.body_b)].fixed) {
    throw InputError("joint", "two fixed bodies", "at least one body that moves");
  }
  require_finite(joint.anchor.allFinite(), "joint.anchor");
  if (!(std::abs(joint.axis.norm() - 1) <= 1e-9)) {
    throw InputError("joint.axis (its length)", joint.axis.norm(), "a unit vector, within 1e-9");
  }
}

}  // namespace

template <>
FrictionVector<2> ContactLaw<2>::semi_axes() const {
  return FrictionVector<2>(e_t);
}
template <>
FrictionVector<3> ContactLaw<3>::semi_axes() const {
  return {e_t, e_o, e_r};
}

template <int Dim>
const ContactLaw<Dim>& Scene<Dim>::law(int body_a, int body_b) const {
  for (const auto& pair : pair_laws) {
    if ((pair.body_a == body_a && pair.body_b == body_b) ||
        (pair.body_a == body_b && pair.body_b == body_a)) {
      return pair.law;
    }
  }
  return contact_law;
}

template <int Dim>
bool Scene<Dim>::jointed(int body_a, int body_b) const {
  return std::any_of(joints.begin(), joints.end(), [&](const Joint<Dim>& joint) {
    return (joint.body_a == body_a && joint.body_b == body_b) ||
           (joint.body_a == body_b && joint.body_b == body_a);
  });
}

template <int Dim>
int Scene<Dim>::body(const std::string& name) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == name) return static_cast<int>(i);
  }
  throw InputError("body", "'" + name + "'", "the name of a body of the scene");
}

template <int Dim>
void Scene<Dim>::validate() const {
  if (bodies.empty()) throw InputError("scene.bodies", "none", "at least one body");
  require_finite(gravity.allFinite(), "scene.gravity");
  validate_law(contact_law, "friction");
  std::set<std::string> names;
  for (const auto& body : bodies) {
    if (!names.insert(body.name).second) {
      throw InputError("body name", "'" + body.name + "' twice", "a different name for each body");
    }
    validate_body(body);
  }
  const int count = static_cast<int>(bodies.size());
  for (const auto& pair : pair_laws) {
    for (const int index : {pair.body_a, pair.body_b}) {
      if (index < 0 || index >= count)
        throw InputError("pair body", std::to_string(index), "an existing body");
    }
    if (pair.body_a == pair.body_b) throw InputError("pair", "one body twice", "two different bodies");
    validate_law(pair.law, "pair");
  }
  for (const auto& joint : joints) validate_joint(joint, bodies);
}

template <int Dim>
std::vector<BodyState<Dim>> initial_state(const Scene<Dim>& scene) {
  std::vector<BodyState<Dim>> state;
  state.reserve(scene.bodies.size());
  for (const auto& body : scene.bodies) {
    state.push_back({body.pose, body.fixed ? Twist<Dim>(Twist<Dim>::Zero()) : body.velocity});
  }
  return state;
}

template struct Scene<2>;
template struct Scene<3>;
template std::vector<BodyState<2>> initial_state(const Scene<2>&);
template std::vector<BodyState<3>> initial_state(const Scene<3>&);

}  // namespace touchstone
