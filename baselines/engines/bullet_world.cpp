#include "baselines/engines/bullet_world.h"

#include <BulletDynamics/ConstraintSolver/btContactConstraint.h>
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include "baselines/engines/loaded_library.h"
#include "baselines/engines/principal_axes.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"

namespace touchstone::engines {

namespace {

/// Bullet turns spinning friction on only where rolling friction is positive too; this much of it [m] is
/// nothing.
constexpr double kLeastRollingFriction = 1e-12;

btScalar to_bullet(double value) { return static_cast<btScalar>(value); }
btVector3 to_bullet(const Vector<3>& v) { return {to_bullet(v.x()), to_bullet(v.y()), to_bullet(v.z())}; }
btQuaternion to_bullet(const Eigen::Quaterniond& q) {
  return {to_bullet(q.x()), to_bullet(q.y()), to_bullet(q.z()), to_bullet(q.w())};
}
btTransform to_bullet(const Pose<3>& pose) {
  return btTransform(to_bullet(pose.rotation.quaternion()), to_bullet(pose.position));
}
Vector<3> from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Matrix<3> from_bullet(const btMatrix3x3& m) {
  Matrix<3> r;
  for (int i = 0; i < 3; ++i) r.row(i) = from_bullet(m.getRow(i)).transpose();
  return r;
}

/// Bullet's hooks for mixing materials are global functions; each finds its scene's law through the bodies.
const ContactLaw<3>& law_of(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<const Scene<3>*>(a->getUserPointer())->law(a->getUserIndex(), b->getUserIndex());
}
void install_laws() {
  gCalculateCombinedFrictionCallback = [](const btCollisionObject* a,
                                          const btCollisionObject* b) -> btScalar {
    const auto& law = law_of(a, b);
    return to_bullet(law.mu * law.e_t);
  };
  gCalculateCombinedRestitutionCallback = [](const btCollisionObject* a,
                                             const btCollisionObject* b) -> btScalar {
    return to_bullet(law_of(a, b).restitution);
  };
  gCalculateCombinedSpinningFrictionCallback = [](const btCollisionObject* a,
                                                  const btCollisionObject* b) -> btScalar {
    const auto& law = law_of(a, b);
    return to_bullet(law.mu * law.e_r);
  };
  gCalculateCombinedRollingFrictionCallback = [](const btCollisionObject* a,
                                                 const btCollisionObject* b) -> btScalar {
    const auto& law = law_of(a, b);
    return to_bullet(law.mu * law.e_r > 0 ? kLeastRollingFriction : 0.0);
  };
}

std::unique_ptr<btCollisionShape> create_shape(const Body<3>& body, const BulletSettings& settings) {
  const auto& geometry = body.shape.geometry;
  if (const auto* s = std::get_if<Sphere<3>>(&geometry))
    return std::make_unique<btSphereShape>(to_bullet(s->radius));
  if (const auto* s = std::get_if<Box<3>>(&geometry)) {
    return std::make_unique<btBoxShape>(to_bullet(s->half_extents));
  }
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    return std::make_unique<btCylinderShapeZ>(to_bullet(Vector<3>(s->radius, s->radius, s->half_height)));
  }
  if (const auto* s = std::get_if<Capsule>(&geometry)) {
    return std::make_unique<btCapsuleShapeZ>(to_bullet(s->radius), to_bullet(2 * s->half_height));
  }
  if (const auto* s = std::get_if<Cone>(&geometry)) {
    auto cone = std::make_unique<btConeShapeZ>(to_bullet(s->radius), to_bullet(s->height));
    cone->setMargin(to_bullet(settings.hull_margin));  // which Bullet adds outside, as for hulls
    return cone;
  }
  if (const auto* s = std::get_if<HalfSpace<3>>(&geometry)) {
    return std::make_unique<btStaticPlaneShape>(to_bullet(s->normal), to_bullet(s->offset));
  }
  if (const auto* s = std::get_if<Polytope<3>>(&geometry)) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const auto& v : s->vertices) hull->addPoint(to_bullet(v), false);
    hull->setMargin(to_bullet(settings.hull_margin));
    hull->recalcLocalAabb();
    return hull;
  }
  refuse_shape("Bullet", body, "the adapter has no Bullet shape for it");
}

class BulletWorld final : public Engine<3> {
 public:
  BulletWorld(const Scene<3>& scene, const BulletSettings& settings, Motion motion)
      : scene_(scene), settings_(settings) {
    refuse_moving_half_spaces("Bullet", scene_);
    install_laws();
    // As for polyhedra that stand on planes: otherwise a box gets one corner a step.
    configuration_.setPlaneConvexMultipointIterations();
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, create_solver(),
                                                       &configuration_);
    world_->setGravity(to_bullet(scene_.gravity));
    configure(world_->getSolverInfo());
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(static_cast<int>(i), motion);
  }

  ~BulletWorld() override {
    for (auto& body : bodies_) world_->removeRigidBody(body.get());
  }

  StepReport advance(double h) override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!scene_.bodies[i].fixed) bodies_[i]->applyCentralForce(to_bullet(scene_.bodies[i].force));
    }
    world_->stepSimulation(to_bullet(h), 0);  // 0: one step of exactly h
    return {};
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    const auto i = static_cast<std::size_t>(index);
    const btTransform& transform = bodies_[i]->getCenterOfMassTransform();
    const Eigen::Quaterniond principal(from_bullet(transform.getBasis()));
    BodyState<3> state;
    state.pose = {from_bullet(transform.getOrigin()),
                  SpatialRotation(principal * inertias_[i].axes.conjugate())};
    state.velocity << from_bullet(bodies_[i]->getLinearVelocity()),
        from_bullet(bodies_[i]->getAngularVelocity());
    return state;
  }

  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const auto i = static_cast<std::size_t>(index);
    const Vector<3> moments = from_bullet(bodies_[i]->getInvInertiaDiagLocal()).cwiseInverse();
    return {1.0 / bodies_[i]->getInvMass(), PrincipalInertia{inertias_[i].axes, moments}.matrix()};
  }

  /// The torsional impulse is not told by Bullet, and reads as 0.
  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
      for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& p = manifold.getContactPoint(k);
        if (p.getDistance() > to_bullet(settings_.contact_below))
          continue;  // did not act; its impulse is an old one
        const ContactPlace<3> place{manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex(),
                                    from_bullet(p.getPositionWorldOnA()),
                                    from_bullet(p.getPositionWorldOnB()), from_bullet(p.m_normalWorldOnB)};
        const btVector3 impulse = p.m_appliedImpulse * p.m_normalWorldOnB +
                                  p.m_appliedImpulseLateral1 * p.m_lateralFrictionDir1 +
                                  p.m_appliedImpulseLateral2 * p.m_lateralFrictionDir2;
        contacts.push_back(contact_impulse<3>(scene_, place, from_bullet(impulse)));
      }
    }
  }

 private:
  btConstraintSolver* create_solver() {
    switch (settings_.solver) {
      case BulletSolver::sequential_impulse:
        solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        break;
      case BulletSolver::nncg:
        solver_ = std::make_unique<btNNCGConstraintSolver>();
        break;
      case BulletSolver::dantzig:
        mlcp_ = std::make_unique<btDantzigSolver>();
        solver_ = std::make_unique<btMLCPSolver>(mlcp_.get());
        break;
      case BulletSolver::pgs:
        mlcp_ = std::make_unique<btSolveProjectedGaussSeidel>();
        solver_ = std::make_unique<btMLCPSolver>(mlcp_.get());
        break;
    }
    return solver_.get();
  }

  void configure(btContactSolverInfo& info) const {
    info.m_numIterations = settings_.iterations;
    info.m_erp2 = to_bullet(settings_.erp);
    info.m_splitImpulsePenetrationThreshold = to_bullet(settings_.split_impulse_below);
    info.m_restitutionVelocityThreshold = to_bullet(settings_.restitution_threshold);
    // With one direction, along the slip, a body at rest is held in one direction only and creeps in the
    // other.
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    if (mlcp_ != nullptr)
      info.m_minimumSolverBatchSize = 1;  // as Bullet's demos do: islands are separate problems
  }

  void add_body(int index, Motion motion) {
    const auto& body = scene_.bodies[static_cast<std::size_t>(index)];
    inertias_.push_back(body.fixed ? PrincipalInertia{} : principal_inertia(body.inertia));
    const SpatialRotation to_body(inertias_.back().axes);
    btCollisionShape* shape = place_shape(body, to_body);
    btRigidBody::btRigidBodyConstructionInfo info(to_bullet(body.fixed ? 0.0 : body.mass), nullptr, shape,
                                                  to_bullet(inertias_.back().moments));
    info.m_startWorldTransform = to_bullet(Pose<3>{body.pose.position, body.pose.rotation * to_body});
    auto rigid = std::make_unique<btRigidBody>(info);
    rigid->setContactProcessingThreshold(to_bullet(settings_.contact_below));
    rigid->setUserIndex(index);
    rigid->setUserPointer(const_cast<Scene<3>*>(&scene_));  // read only, by law_of
    if (!body.fixed) {
      rigid->setActivationState(DISABLE_DEACTIVATION);
      rigid->setLinearVelocity(to_bullet(body.velocity.head<3>()));
      rigid->setAngularVelocity(to_bullet(body.velocity.tail<3>()));
      if (motion == Motion::planar) {
        rigid->setLinearFactor({1, 1, 0});
        rigid->setAngularFactor({0, 0, 1});
      }
    }
    world_->addRigidBody(rigid.get());
    bodies_.push_back(std::move(rigid));
  }

  /// Bullet's body frame is the principal one; a shape that stands elsewhere in it goes into a compound.
  btCollisionShape* place_shape(const Body<3>& body, const SpatialRotation& to_body) {
    shapes_.push_back(create_shape(body, settings_));
    Pose<3> placement = body.shape.placement;
    if (const auto* cone = std::get_if<Cone>(&body.shape.geometry)) {
      // Bullet's cone has its origin at half of its height.
      placement.position = placement.to_world(cone->height / 2 * Vector<3>::UnitZ());
    }
    const SpatialRotation to_principal(to_body.quaternion().conjugate());
    const Pose<3> placed{to_principal.matrix() * placement.position, to_principal * placement.rotation};
    const btTransform transform = to_bullet(placed);
    if (placed.position.isZero(0) && placed.rotation.matrix().isIdentity(0)) return shapes_.back().get();
    auto compound = std::make_unique<btCompoundShape>();
    compound->addChildShape(transform, shapes_.back().get());
    shapes_.push_back(std::move(compound));
    return shapes_.back().get();
  }

  const Scene<3> scene_;
  const BulletSettings settings_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btMLCPSolverInterface> mlcp_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<PrincipalInertia> inertias_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<Engine<3>> make_bullet_world(const Scene<3>& scene, const BulletSettings& settings,
                                             Motion motion) {
  return std::make_unique<BulletWorld>(scene, settings, motion);
}

std::string bullet_version() {
  // btGetVersion is an inline function, and so of the headers.
  const std::string headers = fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100);
  return version_and_file(headers, loaded_file(reinterpret_cast<const void*>(&resolveSingleCollision)),
                          FileNumber::release);
}

}  // namespace touchstone::engines
