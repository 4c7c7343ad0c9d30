#include "baselines/engines/simbody_world.h"

#include <Simbody.h>
#include <fmt/format.h>

#include "baselines/engines/shapes.h"
#include "baselines/engines/silence.h"
#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

constexpr const char* kName = "Simbody";

SimTK::Vec3 to_simtk(const Vector<3>& v) { return {v.x(), v.y(), v.z()}; }
SimTK::Rotation to_simtk(const SpatialRotation& r) {
  const auto& q = r.quaternion();
  return SimTK::Rotation(SimTK::Quaternion(q.w(), q.x(), q.y(), q.z()));
}
SimTK::Transform to_simtk(const Pose<3>& pose) { return {to_simtk(pose.rotation), to_simtk(pose.position)}; }
Vector<3> from_simtk(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::MassProperties mass_properties_of(const Body<3>& body) {
  const Inertia<3>& I = body.inertia;
  return {body.mass, SimTK::Vec3(0), SimTK::Inertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))};
}

/// The bodies and loads, which both ways of contact share. Fixed bodies are parts of the ground.
class SimbodyBodies : public SimbodyWorld {
 public:
  [[nodiscard]] BodyState<3> body(int index) const final {
    const auto i = static_cast<std::size_t>(index);
    if (scene_.bodies[i].fixed) return {scene_.bodies[i].pose, Twist<3>::Zero()};
    const SimTK::State& state = current();
    const SimTK::Quaternion q = bodies_[i].getBodyRotation(state).convertRotationToQuaternion();
    BodyState<3> result;
    result.pose = {from_simtk(bodies_[i].getBodyOriginLocation(state)),
                   SpatialRotation(Eigen::Quaterniond(q[0], q[1], q[2], q[3]))};
    result.velocity << from_simtk(bodies_[i].getBodyOriginVelocity(state)),
        from_simtk(bodies_[i].getBodyAngularVelocity(state));
    return result;
  }

  [[nodiscard]] double mass(int index) const final {
    return bodies_[static_cast<std::size_t>(index)].getBodyMassProperties(current()).getMass();
  }

  [[nodiscard]] Inertia<3> inertia(int index) const final {
    const auto& properties = bodies_[static_cast<std::size_t>(index)].getBodyMassProperties(current());
    const SimTK::Mat33 matrix = properties.getInertia().toMat33();
    Inertia<3> inertia;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) inertia(i, j) = matrix(i, j);
    }
    return inertia;
  }

 protected:
  SimbodyBodies(const Scene<3>& scene, Motion motion) : scene_(scene), matter_(system_), forces_(system_) {
    refuse_moving_half_spaces(kName, scene_);
    SimTK::Force::UniformGravity(forces_, matter_, to_simtk(scene_.gravity));
    for (const auto& body : scene_.bodies) {
      bodies_.push_back(body.fixed ? SimTK::MobilizedBody(matter_.Ground()) : add_body(body, motion));
    }
  }

  /// The stepper's or the integrator's, realised to velocities.
  [[nodiscard]] virtual const SimTK::State& current() const = 0;

  /// Everything is in the system: its first state.
  SimTK::State initial() {
    SimTK::State state = system_.realizeTopology();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto& body = scene_.bodies[i];
      if (body.fixed) continue;
      bodies_[i].setQToFitTransform(state, to_simtk(body.pose));
      const Twist<3>& nu = body.velocity;
      bodies_[i].setUToFitVelocity(state, {to_simtk(nu.tail<3>()), to_simtk(nu.head<3>())});
    }
    system_.realize(state, SimTK::Stage::Velocity);
    return state;
  }

  /// Where the body's shape stands in the frame of the Simbody body that carries it.
  [[nodiscard]] Pose<3> carried(const Body<3>& body) const {
    const Pose<3>& placement = body.shape.placement;
    if (!body.fixed) return placement;
    return {body.pose.to_world(placement.position), body.pose.rotation * placement.rotation};
  }

  const Scene<3> scene_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  std::vector<SimTK::MobilizedBody> bodies_;

 private:
  SimTK::MobilizedBody add_body(const Body<3>& body, Motion motion) {
    const SimTK::Body::Rigid rigid(mass_properties_of(body));
    SimTK::MobilizedBody mobilized;
    if (motion == Motion::planar) {
      mobilized = SimTK::MobilizedBody::Planar(matter_.Ground(), rigid);
    } else {
      mobilized = SimTK::MobilizedBody::Free(matter_.Ground(), rigid);
    }
    SimTK::Force::ConstantForce(forces_, mobilized, SimTK::Vec3(0), to_simtk(body.force));
    return mobilized;
  }
};

// Rigid contacts.

class RigidSimbody final : public SimbodyBodies {
 public:
  RigidSimbody(const Scene<3>& scene, const SimbodyRigidSettings& settings, Motion motion)
      : SimbodyBodies(scene, motion), planar_(motion == Motion::planar) {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      for (std::size_t j = i + 1; j < scene_.bodies.size(); ++j) add_contacts(i, j);
    }
    const SilencedStdout silence;
    const SimTK::State state = initial();
    stepper_ = std::make_unique<SimTK::SemiExplicitEulerTimeStepper>(system_);
    stepper_->setConstraintTolerance(settings.proximity);
    stepper_->setRestitutionModel(SimTK::SemiExplicitEulerTimeStepper::Newton);
    stepper_->setPositionProjectionMethod(SimTK::SemiExplicitEulerTimeStepper::Unilateral);
    auto* solver = new SimTK::PGSImpulseSolver(settings.proximity);  // the stepper owns it
    solver->setMaxIterations(settings.iterations);
    solver->setConvergenceTol(settings.tolerance);
    stepper_->setImpulseSolver(solver);
    stepper_->initialize(state);
  }

  int advance(double h) override {
    const SilencedStdout silence;  // Debian's build prints each step
    stepper_->stepTo(stepper_->getTime() + h);
    system_.realize(stepper_->getState(), SimTK::Stage::Velocity);
    return 0;
  }

 private:
  [[nodiscard]] const SimTK::State& current() const override { return stepper_->getState(); }

  /// The pairs that Simbody has unilateral constraints for: spheres and corners on planes, spheres on
  /// spheres.
  void add_contacts(std::size_t i, std::size_t j) {
    const auto& a = scene_.bodies[i];
    const auto& b = scene_.bodies[j];
    if (a.fixed && b.fixed) return;
    if (std::holds_alternative<HalfSpace<3>>(a.shape.geometry)) {
      add_on_plane(i, j);
    } else if (std::holds_alternative<HalfSpace<3>>(b.shape.geometry)) {
      add_on_plane(j, i);
    } else {
      add_spheres(i, j);
    }
  }

  void add_on_plane(std::size_t ground, std::size_t other) {
    const auto& law = scene_.law(static_cast<int>(ground), static_cast<int>(other));
    const double mu = law.mu * law.e_t;
    const auto& body = scene_.bodies[other];
    const Pose<3> frame = carried(scene_.bodies[ground]);
    const auto& half_space = std::get<HalfSpace<3>>(scene_.bodies[ground].shape.geometry);
    const Vector<3> n = frame.rotation.matrix() * half_space.normal;
    const double height = half_space.offset + n.dot(frame.position);
    const SimTK::UnitVec3 normal(to_simtk(n));
    if (const auto* s = std::get_if<Sphere<3>>(&body.shape.geometry)) {
      matter_.adoptUnilateralContact(new SimTK::SpherePlaneContact(
          matter_.Ground(), normal, height, bodies_[other], to_simtk(body.shape.placement.position),
          s->radius, law.restitution, mu, mu, 0.0));
      return;
    }
    std::vector<Vector<3>> corners = convex_corners(body.shape.geometry);
    if (corners.empty()) refuse_shape(kName, body, "its rigid contacts know spheres and corners on planes");
    if (planar_) keep_one_of_each_in_plane(corners);
    for (const auto& corner : corners) {
      matter_.adoptUnilateralContact(new SimTK::PointPlaneContact(
          matter_.Ground(), normal, height, bodies_[other], to_simtk(body.shape.placement.to_world(corner)),
          law.restitution, mu, mu, 0.0));
    }
  }

  void add_spheres(std::size_t i, std::size_t j) {
    const auto& law = scene_.law(static_cast<int>(i), static_cast<int>(j));
    const auto* a = std::get_if<Sphere<3>>(&scene_.bodies[i].shape.geometry);
    const auto* b = std::get_if<Sphere<3>>(&scene_.bodies[j].shape.geometry);
    if (a == nullptr) refuse_shape(kName, scene_.bodies[i], "its rigid contacts know it on planes only");
    if (b == nullptr) refuse_shape(kName, scene_.bodies[j], "its rigid contacts know it on planes only");
    const auto centre = [&](std::size_t k) { return to_simtk(carried(scene_.bodies[k]).position); };
    const double mu = law.mu * law.e_t;
    matter_.adoptUnilateralContact(new SimTK::SphereSphereContact(
        bodies_[i], centre(i), a->radius, bodies_[j], centre(j), b->radius, law.restitution, mu, mu, 0.0));
  }

  const bool planar_;
  std::unique_ptr<SimTK::SemiExplicitEulerTimeStepper> stepper_;
};

// Compliant contacts.

/// Simbody combines the coefficients of two surfaces to 2 a b / (a + b), which no choice makes a general
/// pair's law.
double common_mu(const Scene<3>& scene) {
  const auto& law = scene.contact_law;
  for (const auto& pair : scene.pair_laws) {
    if (pair.law.mu * pair.law.e_t == law.mu * law.e_t) continue;
    throw Unsupported("Simbody's compliant contacts: friction that differs between pairs of bodies");
  }
  return law.mu * law.e_t;
}

SimTK::ContactGeometry compliant_geometry(const Body<3>& body) {
  const auto& geometry = body.shape.geometry;
  if (const auto* s = std::get_if<Sphere<3>>(&geometry)) return SimTK::ContactGeometry::Sphere(s->radius);
  if (const auto* s = std::get_if<Ellipsoid<3>>(&geometry)) {
    return SimTK::ContactGeometry::Ellipsoid(to_simtk(s->semi_axes));
  }
  if (std::holds_alternative<HalfSpace<3>>(geometry)) return SimTK::ContactGeometry::HalfSpace();
  refuse_shape(kName, body, "Hunt and Crossley's law needs smooth surfaces");
}

/// Simbody's half-space is x > 0, so its x axis points into the solid.
Pose<3> geometry_frame(const Body<3>& body, const Pose<3>& frame) {
  const auto* s = std::get_if<HalfSpace<3>>(&body.shape.geometry);
  if (s == nullptr) return frame;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector<3>::UnitX(), -s->normal);
  return {frame.to_world(s->offset * s->normal), frame.rotation * SpatialRotation(turn)};
}

class CompliantSimbody final : public SimbodyBodies {
 public:
  CompliantSimbody(const Scene<3>& scene, const SimbodyCompliantSettings& settings, Motion motion)
      : SimbodyBodies(scene, motion), tracker_(system_), compliant_(system_, tracker_) {
    compliant_.setTransitionVelocity(settings.transition_velocity);
    const double mu = common_mu(scene_);
    const SimTK::ContactMaterial material(settings.stiffness, settings.dissipation, mu, mu, 0.0);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const auto& body = scene_.bodies[i];
      const SimTK::ContactSurface surface(compliant_geometry(body), material);
      bodies_[i].updBody().addContactSurface(to_simtk(geometry_frame(body, carried(body))), surface);
    }
    refuse_pairs_without_tracker();
    const SimTK::State state = initial();
    integrator_ = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
    integrator_->setAccuracy(settings.accuracy);
    integrator_->setAllowInterpolation(false);  // the step ends where it is asked to
    stepper_ = std::make_unique<SimTK::TimeStepper>(system_, *integrator_);
    stepper_->initialize(state);
  }

  int advance(double h) override {
    const int before = integrator_->getNumStepsTaken();
    stepper_->stepTo(integrator_->getTime() + h);
    system_.realize(integrator_->getState(), SimTK::Stage::Velocity);
    return integrator_->getNumStepsTaken() - before;
  }

 private:
  [[nodiscard]] const SimTK::State& current() const override { return integrator_->getState(); }

  /// Simbody lets bodies pass through each other whose kinds of surface it has no tracker for.
  void refuse_pairs_without_tracker() const {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      for (std::size_t j = i + 1; j < scene_.bodies.size(); ++j) {
        if (scene_.bodies[i].fixed && scene_.bodies[j].fixed) continue;
        const auto a = compliant_geometry(scene_.bodies[i]).getTypeId();
        const auto b = compliant_geometry(scene_.bodies[j]).getTypeId();
        bool reversed = false;
        if (tracker_.hasContactTracker(a, b)) {
          static_cast<void>(tracker_.getContactTracker(a, b, reversed));
          continue;
        }
        refuse_shape(kName, scene_.bodies[i],
                     "no tracker for its contact with '" + scene_.bodies[j].name + "'");
      }
    }
  }

  SimTK::ContactTrackerSubsystem tracker_;
  SimTK::CompliantContactSubsystem compliant_;
  std::unique_ptr<SimTK::RungeKuttaMersonIntegrator> integrator_;
  std::unique_ptr<SimTK::TimeStepper> stepper_;
};

}  // namespace

std::unique_ptr<SimbodyWorld> make_simbody_world(const Scene<3>& scene, const SimbodyRigidSettings& settings,
                                                 Motion motion) {
  return std::make_unique<RigidSimbody>(scene, settings, motion);
}

std::unique_ptr<SimbodyWorld> make_simbody_world(const Scene<3>& scene,
                                                 const SimbodyCompliantSettings& settings, Motion motion) {
  return std::make_unique<CompliantSimbody>(scene, settings, motion);
}

std::string simbody_version() {
  int major = 0;
  int minor = 0;
  int build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return fmt::format("{}.{}.{}", major, minor, build);
}

}  // namespace touchstone::engines
