#include <ode/ode.h>

#include <array>
#include <deque>
#include <mutex>

#include "baselines/engines/engines.h"
#include "baselines/engines/loaded_library.h"
#include "baselines/engines/ode_start.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/spatial_engine.h"

/// ODE 0.16: spatial, double precision, friction boxes; contact joints made anew each step from overlaps.
namespace touchstone::engines {

namespace {

enum class Solver { step, quickstep };

struct Settings {
  Solver solver;
  double erp;            ///< share of the overlap beyond the layer that one step removes
  double cfm;            ///< softness of every constraint, ODE's own default for double precision
  double surface_layer;  ///< overlap that is left alone [m]; ODE's manual recommends 0.001 against jitter
  int iterations;        ///< of QuickStep
  double over_relaxation;
};

constexpr int kMostContactsOfAPair = 64;

Settings read_settings(OptionReader& read, Solver solver) {
  Settings s{};
  s.solver = solver;
  s.erp = read.number("erp", 0.2, 0.0, 1.0);
  s.cfm = read.number("cfm", 1e-10, 0.0, 1.0);
  s.surface_layer = read.number("surface_layer", 0.001, 0.0, 1.0);
  if (solver == Solver::quickstep) {
    s.iterations = read.integer("iterations", 20, 1, 100000);
    s.over_relaxation = read.number("over_relaxation", 1.3, 0.0, 2.0);
  }
  return s;
}

/// What ODE would have printed on stderr in this thread's last step; empty if nothing.
thread_local bool complained = false;
void note_message(int, const char*, va_list) { complained = true; }

/// ODE wants a global start once and some memory for each thread; both live as long as the process.
void enter_ode() {
  static const int started = [] {
    const std::lock_guard lock(ode_start());
    return dInitODE2(0);
  }();
  static_cast<void>(started);
  dSetMessageHandler(&note_message);
  thread_local const int allocated = dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll));
  static_cast<void>(allocated);
}

Vector<3> from_ode(const dReal* v) { return {v[0], v[1], v[2]}; }
void to_ode(const Vector<3>& v, dReal* out) { std::copy_n(v.data(), 3, out); }
std::array<dReal, 4> to_ode(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// The arrays of a convex geom, which ODE refers to and does not copy.
struct ConvexData {
  std::vector<dReal> planes;
  std::vector<dReal> points;
  std::vector<unsigned int> polygons;  ///< corner count, then corners, face after face

  explicit ConvexData(const Polytope<3>& polytope) {
    const auto faces = face_corners(polytope);
    for (std::size_t i = 0; i < polytope.normals.size(); ++i) {
      planes.insert(planes.end(), polytope.normals[i].data(), polytope.normals[i].data() + 3);
      planes.push_back(polytope.offsets[i]);
      polygons.push_back(static_cast<unsigned int>(faces[i].size()));
      for (const int corner : faces[i]) polygons.push_back(static_cast<unsigned int>(corner));
    }
    for (const auto& v : polytope.vertices) points.insert(points.end(), v.data(), v.data() + 3);
  }
};

/// One contact joint of the step under way.
struct LiveContact {
  dJointFeedback feedback{};
  ContactPlace<3> place;
};

class OdeWorld final : public Engine<3> {
 public:
  OdeWorld(const Scene<3>& scene, const Settings& settings, Motion motion)
      : scene_(scene), settings_(settings), motion_(motion) {
    refuse_moving_half_spaces("ODE", scene_);
    enter_ode();
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contact_group_ = dJointGroupCreate(0);
    use_own_threading();
    configure();
    try {
      for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(static_cast<int>(i));
    } catch (...) {
      release();
      throw;
    }
  }
  ~OdeWorld() override { release(); }

  StepReport advance(double h) override {
    enter_ode();
    complained = false;
    apply_forces();
    detect_contacts();
    solve(h);
    if (motion_ == Motion::planar) clean_plane();
    h_ = h;
    if (complained) return {.status = StepStatus::not_converged, .reason = "ODE reports an error of its LCP"};
    return {};
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    const dBodyID body = bodies_[static_cast<std::size_t>(index)];
    if (body == nullptr) return {scene_.bodies[static_cast<std::size_t>(index)].pose, Twist<3>::Zero()};
    const dReal* q = dBodyGetQuaternion(body);
    BodyState<3> state;
    state.pose = {from_ode(dBodyGetPosition(body)),
                  SpatialRotation(Eigen::Quaterniond(q[0], q[1], q[2], q[3]))};
    state.velocity << from_ode(dBodyGetLinearVel(body)), from_ode(dBodyGetAngularVel(body));
    return state;
  }

  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    dMass mass;
    dBodyGetMass(bodies_[static_cast<std::size_t>(index)], &mass);
    MassProperties<3> properties{mass.mass, {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) properties.inertia(i, j) = mass.I[4 * i + j];
    }
    return properties;
  }

  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (const auto& live : live_) {
      const Vector<3> force = from_ode(live.feedback.f1);
      const Vector<3> centre =
          from_ode(dBodyGetPosition(bodies_[static_cast<std::size_t>(live.place.body_a)]));
      // ODE took the moments about the centres before the step.
      const Vector<3> arm = live.place.point_a - (centre - h_ * body(live.place.body_a).velocity.head<3>());
      const double torsion = live.place.normal.dot(from_ode(live.feedback.t1) - arm.cross(force));
      contacts.push_back(contact_impulse<3>(scene_, live.place, h_ * force, h_ * torsion));
    }
  }

 private:
  /// Worlds share one global implementation unless told otherwise, and then must not step at the same time.
  void use_own_threading() {
    threading_ = dThreadingAllocateSelfThreadedImplementation();
    dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_),
                                         threading_);
  }

  void configure() {
    dWorldSetGravity(world_, scene_.gravity.x(), scene_.gravity.y(), scene_.gravity.z());
    dWorldSetERP(world_, settings_.erp);
    dWorldSetCFM(world_, settings_.cfm);
    dWorldSetContactSurfaceLayer(world_, settings_.surface_layer);
    dWorldSetAutoDisableFlag(world_, 0);
    if (settings_.solver == Solver::quickstep) {
      dWorldSetQuickStepNumIterations(world_, settings_.iterations);
      dWorldSetQuickStepW(world_, settings_.over_relaxation);
    }
  }

  void release() {
    dJointGroupDestroy(contact_group_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dThreadingFreeImplementation(threading_);
  }

  void add_body(int index) {
    const auto& body = scene_.bodies[static_cast<std::size_t>(index)];
    bodies_.push_back(body.fixed ? nullptr : create_body(body));
    const dGeomID geom = create_geom(body);
    dGeomSetData(geom, reinterpret_cast<void*>(static_cast<std::intptr_t>(index)));
    if (dGeomGetClass(geom) == dPlaneClass) return;
    const Pose<3>& placement = body.shape.placement;
    if (body.fixed) {
      const Vector<3> p = body.pose.to_world(placement.position);
      dGeomSetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetQuaternion(geom, to_ode((body.pose.rotation * placement.rotation).quaternion()).data());
    } else {
      dGeomSetBody(geom, bodies_.back());
      const Vector<3>& p = placement.position;
      dGeomSetOffsetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetOffsetQuaternion(geom, to_ode(placement.rotation.quaternion()).data());
    }
  }

  dBodyID create_body(const Body<3>& body) {
    const dBodyID id = dBodyCreate(world_);
    const Vector<3>& p = body.pose.position;
    const Twist<3>& nu = body.velocity;
    dBodySetPosition(id, p.x(), p.y(), p.z());
    dBodySetQuaternion(id, to_ode(body.pose.rotation.quaternion()).data());
    dBodySetLinearVel(id, nu[0], nu[1], nu[2]);
    dBodySetAngularVel(id, nu[3], nu[4], nu[5]);
    const Inertia<3>& I = body.inertia;
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    dBodySetMass(id, &mass);
    // Turns by the finite rotation h omega; the default's first-order update is 7e-5 short at 0.03 rad a
    // step.
    dBodySetFiniteRotationMode(id, 1);
    if (motion_ == Motion::planar) dJointAttach(dJointCreatePlane2D(world_, nullptr), id, nullptr);
    return id;
  }

  /// With a quarter of the layer around each shape, so that a pair that touches overlaps by half the layer:
  /// the contact is there in the first step and is not pushed.
  dGeomID create_geom(const Body<3>& body) {
    const auto geometry = inflated(body.shape.geometry, settings_.surface_layer / 4);
    if (const auto* s = std::get_if<Sphere<3>>(&geometry)) return dCreateSphere(space_, s->radius);
    if (const auto* s = std::get_if<Cylinder>(&geometry)) {
      return dCreateCylinder(space_, s->radius, 2 * s->half_height);
    }
    if (const auto* s = std::get_if<Capsule>(&geometry)) {
      return dCreateCapsule(space_, s->radius, 2 * s->half_height);
    }
    if (const auto* s = std::get_if<Box<3>>(&geometry)) {
      const Vector<3> sides = 2 * s->half_extents;
      return dCreateBox(space_, sides.x(), sides.y(), sides.z());
    }
    if (const auto* s = std::get_if<HalfSpace<3>>(&geometry)) {
      const Pose<3> pose{body.pose.to_world(body.shape.placement.position),
                         body.pose.rotation * body.shape.placement.rotation};
      const Vector<3> n = pose.rotation.matrix() * s->normal;
      return dCreatePlane(space_, n.x(), n.y(), n.z(), s->offset + n.dot(pose.position));
    }
    if (const auto* s = std::get_if<Polytope<3>>(&geometry)) {
      ConvexData& data = convex_data_.emplace_back(*s);
      return dCreateConvex(space_, data.planes.data(), static_cast<unsigned>(s->normals.size()),
                           data.points.data(), static_cast<unsigned>(s->vertices.size()),
                           data.polygons.data());
    }
    refuse_shape("ODE", body, "ODE has no geom for it");
  }

  void apply_forces() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Vector<3>& f = scene_.bodies[i].force;
      if (bodies_[i] != nullptr) dBodyAddForce(bodies_[i], f.x(), f.y(), f.z());
    }
  }

  void detect_contacts() {
    dJointGroupEmpty(contact_group_);
    live_.clear();
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID g1, dGeomID g2) { static_cast<OdeWorld*>(self)->collide(g1, g2); });
  }

  void collide(dGeomID g1, dGeomID g2) {
    if (dGeomGetBody(g1) == nullptr && dGeomGetBody(g2) == nullptr) return;
    std::array<dContactGeom, kMostContactsOfAPair> found;
    const int count = dCollide(g1, g2, kMostContactsOfAPair, found.data(), sizeof(dContactGeom));
    for (int k = 0; k < count; ++k) add_contact(found[static_cast<std::size_t>(k)]);
  }

  void add_contact(const dContactGeom& geom) {
    const auto index = [](dGeomID g) {
      return static_cast<int>(reinterpret_cast<std::intptr_t>(dGeomGetData(g)));
    };
    // body_a is the one that moves and that ODE gives the forces on; ODE's normal points into its first geom.
    const bool swap = dGeomGetBody(geom.g1) == nullptr;
    ContactPlace<3> place;
    place.body_a = index(swap ? geom.g2 : geom.g1);
    place.body_b = index(swap ? geom.g1 : geom.g2);
    place.normal = from_ode(geom.normal) * (swap ? -1.0 : 1.0);
    place.point_a = from_ode(geom.pos);
    if (dGeomGetClass(geom.g1) == dPlaneClass || dGeomGetClass(geom.g2) == dPlaneClass) {
      // ODE acts at the body's deepest point. The middle of the overlap is where the skins are not felt as a
      // longer lever arm.
      place.point_a += geom.depth / 2 * place.normal;
    }
    place.point_b = place.point_a;

    dContact contact{};
    contact.geom = geom;
    to_ode(place.point_a, contact.geom.pos);
    set_law(place, contact);
    const dJointID joint = dJointCreateContact(world_, contact_group_, &contact);
    dJointAttach(joint, dGeomGetBody(geom.g1), dGeomGetBody(geom.g2));
    live_.push_back({{}, place});
    dJointSetFeedback(joint, &live_.back().feedback);
  }

  /// Friction limits in proportion to the normal force (dContactApprox1), along the law's t and o.
  void set_law(const ContactPlace<3>& place, dContact& contact) const {
    const auto& law = scene_.law(place.body_a, place.body_b);
    contact.surface.mode = dContactApprox1 | dContactFDir1 | dContactAxisDep;
    contact.surface.mu = law.mu * law.e_t;
    contact.surface.mu2 = law.mu * law.e_o;
    to_ode(contact_tangents(place.normal, law).col(0), contact.fdir1);
    if (law.e_r > 0) {
      contact.surface.mode |= dContactRolling;
      contact.surface.rhoN = law.mu * law.e_r;  // rho = rho2 = 0: no rolling resistance
    }
    if (law.restitution > 0) {
      contact.surface.mode |= dContactBounce;
      contact.surface.bounce = law.restitution;
      contact.surface.bounce_vel = 0;
    }
  }

  void solve(double h) {
    if (settings_.solver == Solver::step) {
      dWorldStep(world_, h);
      return;
    }
    // QuickStep shuffles its rows by ODE's one random generator. Each world has its own seed, so that a run
    // does not depend on what else runs in the process.
    static std::mutex generator;
    const std::lock_guard lock(generator);
    dRandSetSeed(seed_);
    dWorldQuickStep(world_, h);
    seed_ = dRandGetSeed();
  }

  /// ODE's recipe for its plane joint: it holds velocities only, so rounding off the plane is removed.
  void clean_plane() {
    for (const dBodyID body : bodies_) {
      if (body == nullptr) continue;
      const dReal* q = dBodyGetQuaternion(body);
      const double length = std::hypot(q[0], q[3]);
      const dQuaternion about_z = {q[0] / length, 0, 0, q[3] / length};
      const Vector<3> p = from_ode(dBodyGetPosition(body));
      const Vector<3> v = from_ode(dBodyGetLinearVel(body));
      const double spin = dBodyGetAngularVel(body)[2];
      dBodySetPosition(body, p.x(), p.y(), 0);
      dBodySetQuaternion(body, about_z);
      dBodySetLinearVel(body, v.x(), v.y(), 0);
      dBodySetAngularVel(body, 0, 0, spin);
    }
  }

  const Scene<3> scene_;
  const Settings settings_;
  const Motion motion_;
  dWorldID world_ = nullptr;
  dThreadingImplementationID threading_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contact_group_ = nullptr;
  std::vector<dBodyID> bodies_;  ///< null for a fixed body
  std::deque<ConvexData> convex_data_;
  std::deque<LiveContact> live_;  ///< a deque, because ODE keeps pointers to the feedback
  unsigned long seed_ = 0;
  double h_ = 0;
};

template <Solver solver>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const Settings settings = read_settings(read, solver);
  read.finish();
  return std::make_unique<OdeWorld>(scene, settings, motion);
}

/// ODE tells its version in no function.
std::string version() {
  return version_and_file(dODE_VERSION, loaded_file(reinterpret_cast<const void*>(&dWorldStep)),
                          FileNumber::interface);
}

constexpr Capabilities kCapabilities{
    .contact_impulses = true, .torsional_friction = true, .anisotropic_friction = true, .restitution = true};
constexpr SpatialEngine kStep{"ode_step", kCapabilities, kDoublePrecision, &load<Solver::step>};
constexpr SpatialEngine kQuickStep{"ode_quickstep", kCapabilities, kDoublePrecision,
                                   &load<Solver::quickstep>};
constexpr const char* kStepText = "ODE: dWorldStep, LCP by Dantzig's method, friction boxes";
constexpr const char* kQuickStepText = "ODE: dWorldQuickStep, over-relaxed Gauss-Seidel, friction boxes";

constexpr MethodEntry<2> kPlanar[] = {
    {kQuickStep.key, kQuickStepText, &make_planar<kQuickStep>, &version},
    {kStep.key, kStepText, &make_planar<kStep>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kQuickStep.key, kQuickStepText, &make_spatial<kQuickStep>, &version},
    {kStep.key, kStepText, &make_spatial<kStep>, &version},
};

}  // namespace

Rows ode_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
