#include "baselines/engines/extruded.h"

#include <algorithm>
#include <cmath>

#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

/// [m], [rad], [m/s] and [rad/s] alike: far above rounding, far below what a result shows.
constexpr double kPlaneTolerance = 1e-6;

Vector<3> in_plane(const Vector<2>& v) { return {v.x(), v.y(), 0.0}; }

Pose<3> in_plane(const Pose<2>& pose) {
  const Eigen::AngleAxisd turn(pose.rotation.angle(), Vector<3>::UnitZ());
  return {in_plane(pose.position), SpatialRotation(Eigen::Quaterniond(turn))};
}

/// Thick enough beside its size to stand firmly; the plane's physics does not depend on it.
double half_depth(double size) { return 0.5 * size; }

Polytope<3> prism(const Polytope<2>& section) {
  Polytope<3> solid;
  double size = 0;
  for (const auto& v : section.vertices) size = std::max(size, v.norm());
  for (std::size_t i = 0; i < section.normals.size(); ++i) {
    solid.normals.push_back(in_plane(section.normals[i]));
    solid.offsets.push_back(section.offsets[i]);
  }
  for (const double side : {-1.0, 1.0}) {
    const Vector<3> end = side * half_depth(size) * Vector<3>::UnitZ();
    solid.normals.push_back(side * Vector<3>::UnitZ());
    solid.offsets.push_back(half_depth(size));
    for (const auto& v : section.vertices) solid.vertices.push_back(in_plane(v) + end);
  }
  return solid;
}

struct Extrude {
  const Body<2>& body;
  DiscAs disc;
  using Solid = Geometry<3>::Variant;

  Solid operator()(const Sphere<2>& s) const {
    if (disc == DiscAs::sphere) return Sphere<3>{s.radius};
    return Cylinder{s.radius, half_depth(s.radius)};
  }
  Solid operator()(const Ellipsoid<2>& s) const {
    return Ellipsoid<3>{{s.semi_axes.x(), s.semi_axes.y(), s.semi_axes.minCoeff()}};
  }
  Solid operator()(const Superellipsoid<2>& s) const {
    return Superellipsoid<3>{{s.semi_axes.x(), s.semi_axes.y(), s.semi_axes.minCoeff()},
                             {s.exponents.x(), s.exponents.y(), 2.0}};
  }
  Solid operator()(const HalfSpace<2>& s) const { return HalfSpace<3>{in_plane(s.normal), s.offset}; }
  Solid operator()(const Box<2>& s) const {
    return Box<3>{{s.half_extents.x(), s.half_extents.y(), half_depth(s.half_extents.maxCoeff())}};
  }
  Solid operator()(const Polytope<2>& s) const { return prism(s); }
  Solid operator()(const RegularPolygon& s) const { return prism(as_polytope(s)); }
  Solid operator()(const Intersection<2>&) const {
    refuse_shape("extrusion", body, "an intersection has no counterpart in the engines");
  }
};

ContactLaw<3> in_space(const ContactLaw<2>& law) {
  return {.mu = law.mu,
          .e_t = law.e_t,
          .e_o = law.e_t,
          .e_r = 0.0,
          .restitution = law.restitution,
          .tangent = in_plane(law.tangent)};
}

Body<3> in_space(const Body<2>& body, DiscAs disc) {
  Body<3> solid;
  solid.name = body.name;
  solid.fixed = body.fixed;
  solid.mass = body.mass;
  solid.inertia = body.inertia(0, 0) * Inertia<3>::Identity();
  solid.pose = in_plane(body.pose);
  solid.velocity << in_plane(body.velocity.head<2>()), 0.0, 0.0, body.velocity[2];
  solid.force = in_plane(body.force);
  solid.shape.geometry = std::visit(Extrude{body, disc}, body.shape.geometry);
  solid.shape.placement = in_plane(body.shape.placement);
  return solid;
}

double out_of_plane(const BodyState<3>& s) {
  const auto& tilt = s.pose.rotation.matrix();
  return std::max({std::abs(s.pose.position.z()), std::abs(tilt(2, 0)), std::abs(tilt(2, 1)),
                   std::abs(s.velocity[2]), std::abs(s.velocity[3]), std::abs(s.velocity[4])});
}

/// @param expected_angle  near the angle [rad], so that whole turns are counted
BodyState<2> to_plane(const BodyState<3>& s, double expected_angle) {
  const auto& r = s.pose.rotation.matrix();
  const double angle = unwrapped(std::atan2(r(1, 0), r(0, 0)), expected_angle);
  return {{s.pose.position.head<2>(), PlanarRotation(angle)}, {s.velocity[0], s.velocity[1], s.velocity[5]}};
}

bool same_place(const ContactImpulse<2>& a, const ContactImpulse<2>& b) {
  return a.body_a == b.body_a && a.body_b == b.body_b && (a.point_a - b.point_a).norm() < kPlaneTolerance &&
         (a.normal - b.normal).norm() < kPlaneTolerance;
}

}  // namespace

Scene<3> extruded(const Scene<2>& scene, DiscAs disc) {
  Scene<3> solid;
  solid.gravity = in_plane(scene.gravity);
  solid.contact_law = in_space(scene.contact_law);
  for (const auto& pair : scene.pair_laws) {
    solid.pair_laws.push_back({pair.body_a, pair.body_b, in_space(pair.law)});
  }
  for (const auto& body : scene.bodies) solid.bodies.push_back(in_space(body, disc));
  return solid;
}

ExtrudedMethod::ExtrudedMethod(Scene<2> scene, Options effective, std::unique_ptr<Method<3>> spatial)
    : scene_(std::move(scene)), effective_(std::move(effective)), spatial_(std::move(spatial)) {
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    state_.push_back(to_plane(spatial_->state()[i], scene_.bodies[i].pose.rotation.angle()));
  }
}

Capabilities ExtrudedMethod::capabilities() const {
  Capabilities c = spatial_->capabilities();
  c.torsional_friction = false;  // there is none in the plane
  c.anisotropic_friction = false;
  return c;
}

StepReport ExtrudedMethod::step(double h) {
  constexpr StepReport kLeftPlane{.status = StepStatus::not_converged,
                                  .reason = "a body left the plane z = 0"};
  if (left_plane_) return kLeftPlane;
  const StepReport report = spatial_->step(h);
  if (report.status != StepStatus::solved) return report;
  const auto solid = spatial_->state();
  left_plane_ = std::any_of(solid.begin(), solid.end(),
                            [](const auto& s) { return out_of_plane(s) > kPlaneTolerance; });
  if (left_plane_) return kLeftPlane;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    state_[i] = to_plane(solid[i], state_[i].pose.rotation.angle() + h * solid[i].velocity[5]);
  }
  read_contacts();
  return report;
}

void ExtrudedMethod::read_contacts() {
  contacts_.clear();
  for (const auto& solid : spatial_->contacts()) {
    const ContactPlace<2> place{solid.body_a, solid.body_b, solid.point_a.head<2>(), solid.point_b.head<2>(),
                                solid.normal.head<2>().normalized()};
    const Vector<3> impulse =
        solid.normal_impulse * solid.normal + solid.tangents * solid.friction_impulse.head<2>();
    const auto contact = contact_impulse<2>(scene_, place, impulse.head<2>());
    // The contact points along the depth of a prism or cylinder are one point of the plane.
    const auto twin = std::find_if(contacts_.begin(), contacts_.end(),
                                   [&](const auto& known) { return same_place(known, contact); });
    if (twin == contacts_.end()) {
      contacts_.push_back(contact);
    } else {
      twin->normal_impulse += contact.normal_impulse;
      twin->friction_impulse += contact.friction_impulse;
    }
  }
}

MassProperties<2> ExtrudedMethod::mass_properties(int index) const {
  const auto solid = dynamic_cast<const TellsMass<3>&>(*spatial_).mass_properties(index);
  return {solid.mass, Inertia<2>(solid.inertia(2, 2))};
}

}  // namespace touchstone::engines
