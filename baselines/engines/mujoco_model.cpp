#include "baselines/engines/mujoco_model.h"

#include <fmt/format.h>

#include "baselines/engines/principal_axes.h"
#include "baselines/engines/shapes.h"

namespace touchstone::engines {

namespace {

std::string numbers(const Vector<3>& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string numbers(const SpatialRotation& r) {
  const auto& q = r.quaternion();
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

/// A geom's type, size and the shape's own turn and shift in its frame.
struct Geom {
  std::string attributes;
  Pose<3> placement{};
};

Geom plane(const HalfSpace<3>& s) {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector<3>::UnitZ(), s.normal);
  return {R"(type="plane" size="0 0 1")", {s.offset * s.normal, SpatialRotation(turn)}};
}

Geom geom_of(const Body<3>& body, int index) {
  const auto& geometry = body.shape.geometry;
  if (const auto* s = std::get_if<Sphere<3>>(&geometry)) {
    return {fmt::format(R"(type="sphere" size="{}")", s->radius)};
  }
  if (const auto* s = std::get_if<Ellipsoid<3>>(&geometry)) {
    return {fmt::format(R"(type="ellipsoid" size="{}")", numbers(s->semi_axes))};
  }
  if (const auto* s = std::get_if<Box<3>>(&geometry)) {
    return {fmt::format(R"(type="box" size="{}")", numbers(s->half_extents))};
  }
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    return {fmt::format(R"(type="cylinder" size="{} {}")", s->radius, s->half_height)};
  }
  if (const auto* s = std::get_if<Capsule>(&geometry)) {
    return {fmt::format(R"(type="capsule" size="{} {}")", s->radius, s->half_height)};
  }
  if (const auto* s = std::get_if<HalfSpace<3>>(&geometry)) return plane(*s);
  if (std::holds_alternative<Polytope<3>>(geometry)) {
    return {fmt::format(R"(type="mesh" mesh="m{}")", index)};
  }
  refuse_shape("MuJoCo", body, "MuJoCo has no geom for it");
}

/// condim and friction of a law: none, sliding, or sliding and torsion. MuJoCo's coefficients are mu and, in
/// metres, mu e_r, which make its elliptic cone the friction ellipsoid.
std::string friction(const ContactLaw<3>& law, bool pair) {
  const int condim = law.mu == 0 ? 1 : law.e_r > 0 ? 4 : 3;
  const double slide = law.mu * law.e_t;
  const double torsion = law.mu * law.e_r;
  const std::string slides = pair ? fmt::format("{} {}", slide, slide) : fmt::format("{}", slide);
  const std::string rolls = pair ? "0 0" : "0";
  return fmt::format(R"(condim="{}" friction="{} {} {}")", condim, slides, torsion, rolls);
}

std::string softness(const MujocoSettings& s) {
  return fmt::format(R"(solref="{} {}" solimp="{} {} {}" margin="{}")", s.timeconst, s.dampratio, s.dmin,
                     s.dmax, s.width, s.margin);
}

std::string header(const Scene<3>& scene, const MujocoSettings& s) {
  // Room for contacts: MuJoCo drops what does not fit.
  const std::size_t contacts = 64 + 32 * scene.bodies.size();
  return fmt::format(
      R"(<compiler angle="radian" inertiafromgeom="false"/>
<size nconmax="{}" njmax="{}"/>
<option gravity="{}" cone="{}" solver="Newton" integrator="Euler" impratio="{}" noslip_iterations="{}" iterations="{}" tolerance="{}"/>
)",
      contacts, 6 * contacts, numbers(scene.gravity), s.cone, s.impratio, s.noslip_iterations, s.iterations,
      s.tolerance);
}

std::string meshes(const Scene<3>& scene) {
  std::string text = "<asset>\n";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto* polytope = std::get_if<Polytope<3>>(&scene.bodies[i].shape.geometry);
    if (polytope == nullptr) continue;
    text += fmt::format("<mesh name=\"m{}\" vertex=\"", i);
    for (const auto& v : polytope->vertices) text += numbers(v) + " ";
    text += "\"/>\n";
  }
  return text + "</asset>\n";
}

std::string geom_element(const Scene<3>& scene, const MujocoSettings& settings, std::size_t i) {
  const auto& body = scene.bodies[i];
  const Geom geom = geom_of(body, static_cast<int>(i));
  // A fixed body is a geom of the world.
  Pose<3> frame = body.fixed ? body.pose : Pose<3>{};
  for (const Pose<3>& inner : {body.shape.placement, geom.placement}) {
    frame = {frame.to_world(inner.position), frame.rotation * inner.rotation};
  }
  return fmt::format(R"(<geom name="g{}" {} pos="{}" quat="{}" {} {}/>)", i, geom.attributes,
                     numbers(frame.position), numbers(frame.rotation), friction(scene.contact_law, false),
                     softness(settings));
}

std::string body_element(const Scene<3>& scene, const MujocoSettings& settings, Motion motion,
                         std::size_t i) {
  const auto& body = scene.bodies[i];
  // Diagonal by our own means: MuJoCo's are good to 1e-6 only.
  const PrincipalInertia inertia = principal_inertia(body.inertia);
  const char* joints = motion == Motion::spatial ? "<freejoint/>" : R"(<joint type="slide" axis="1 0 0"/>
<joint type="slide" axis="0 1 0"/><joint type="hinge" axis="0 0 1"/>)";
  return fmt::format(R"(<body name="b{}">{}
<inertial pos="0 0 0" quat="{}" mass="{}" diaginertia="{}"/>
{}
</body>
)",
                     i, joints, numbers(SpatialRotation(inertia.axes)), body.mass, numbers(inertia.moments),
                     geom_element(scene, settings, i));
}

std::string pairs(const Scene<3>& scene, const MujocoSettings& settings) {
  std::string text = "<contact>\n";
  for (const auto& pair : scene.pair_laws) {
    text += fmt::format("<pair geom1=\"g{}\" geom2=\"g{}\" {} {}/>\n", pair.body_a, pair.body_b,
                        friction(pair.law, true), softness(settings));
  }
  return text + "</contact>\n";
}

}  // namespace

std::string mujoco_xml(const Scene<3>& scene, const MujocoSettings& settings, Motion motion) {
  std::string text = "<mujoco>\n" + header(scene, settings) + meshes(scene) + "<worldbody>\n";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    text += scene.bodies[i].fixed ? geom_element(scene, settings, i) + "\n"
                                  : body_element(scene, settings, motion, i);
  }
  return text + "</worldbody>\n" + pairs(scene, settings) + "</mujoco>\n";
}

}  // namespace touchstone::engines
