#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>

#include "baselines/engines/engines.h"
#include "baselines/engines/principal_axes.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/spatial_engine.h"

/// Bullet 3.24, its double-precision build: persistent manifolds, speculative contacts, four solvers.
namespace touchstone::engines {

namespace {

enum class Solver { sequential_impulse, nncg, dantzig, pgs };

struct Settings {
  Solver solver;
  int iterations;                ///< of the iterative solvers; Dantzig's pivots do not count
  double erp;                    ///< share of an overlap that one step removes
  double restitution_threshold;  ///< approach speed below which nothing bounces [m/s]
  double hull_margin;            ///< thickness around a convex hull [m]
  double split_impulse_below;    ///< distance below which overlap is removed by pseudo-velocities alone [m]
  double contact_below;          ///< distance below which a contact acts [m]; large: speculative contacts
};

/// Bullet lets a contact act before the bodies touch, so that they do not overlap: psi + h psi' >= 0. But the
/// speed after an impact is then e |v| - psi / h, which is anything. Where a pair bounces, contacts therefore
/// act on touch, which is within rounding, and the overlap of the impact is removed without adding to the
/// speed.
constexpr double kSpeculative = 1e6;
constexpr double kTouching = 1e-6;
constexpr double kBulletsSplitImpulse = -0.04;

bool bounces(const Scene<3>& scene) {
  return scene.contact_law.restitution > 0 ||
         std::any_of(scene.pair_laws.begin(), scene.pair_laws.end(),
                     [](const auto& pair) { return pair.law.restitution > 0; });
}

Settings read_settings(OptionReader& read, const Scene<3>& scene, Solver solver) {
  Settings s{};
  s.solver = solver;
  s.iterations = read.integer("iterations", 50, 1, 100000);
  s.erp = read.number("erp", 0.2, 0.0, 1.0);
  s.restitution_threshold = read.number("restitution_threshold", 0.0, 0.0, 1e6);
  s.hull_margin = read.number("hull_margin", 0.0, 0.0, 1.0);
  const bool bounce = bounces(scene);
  s.contact_below = read.number("contact_below", bounce ? kTouching : kSpeculative, 0.0, kSpeculative);
  s.split_impulse_below = read.number("split_impulse_below", bounce ? 0.0 : kBulletsSplitImpulse, -1e6, 0.0);
  return s;
}

/// Bullet turns spinning friction on only where rolling friction is positive too; this much of it [m] is
/// nothing.
constexpr double kLeastRollingFriction = 1e-12;

btVector3 to_bullet(const Vector<3>& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion to_bullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
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
    return law.mu * law.e_t;
  };
  gCalculateCombinedRestitutionCallback = [](const btCollisionObject* a,
                                             const btCollisionObject* b) -> btScalar {
    return law_of(a, b).restitution;
  };
  gCalculateCombinedSpinningFrictionCallback = [](const btCollisionObject* a,
                                                  const btCollisionObject* b) -> btScalar {
    const auto& law = law_of(a, b);
    return law.mu * law.e_r;
  };
  gCalculateCombinedRollingFrictionCallback = [](const btCollisionObject* a,
                                                 const btCollisionObject* b) -> btScalar {
    const auto& law = law_of(a, b);
    return law.mu * law.e_r > 0 ? kLeastRollingFriction : 0.0;
  };
}

std::unique_ptr<btCollisionShape> create_shape(const Body<3>& body, const Settings& settings) {
  const auto& geometry = body.shape.geometry;
  if (const auto* s = std::get_if<Sphere<3>>(&geometry)) return std::make_unique<btSphereShape>(s->radius);
  if (const auto* s = std::get_if<Box<3>>(&geometry)) {
    return std::make_unique<btBoxShape>(to_bullet(s->half_extents));
  }
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    return std::make_unique<btCylinderShapeZ>(btVector3(s->radius, s->radius, s->half_height));
  }
  if (const auto* s = std::get_if<Capsule>(&geometry)) {
    return std::make_unique<btCapsuleShapeZ>(s->radius, 2 * s->half_height);
  }
  if (const auto* s = std::get_if<HalfSpace<3>>(&geometry)) {
    return std::make_unique<btStaticPlaneShape>(to_bullet(s->normal), s->offset);
  }
  if (const auto* s = std::get_if<Polytope<3>>(&geometry)) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const auto& v : s->vertices) hull->addPoint(to_bullet(v), false);
    hull->setMargin(settings.hull_margin);
    hull->recalcLocalAabb();
    return hull;
  }
  refuse_shape("Bullet", body, "the adapter has no Bullet shape for it");
}

class BulletWorld final : public Engine<3> {
 public:
  BulletWorld(const Scene<3>& scene, const Settings& settings, Motion motion)
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
    world_->stepSimulation(h, 0);  // 0: one step of exactly h
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
    return {1 / bodies_[i]->getInvMass(), PrincipalInertia{inertias_[i].axes, moments}.matrix()};
  }

  /// The torsional impulse is not told by Bullet, and reads as 0.
  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
      for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& p = manifold.getContactPoint(k);
        if (p.getDistance() > settings_.contact_below) continue;  // did not act; its impulse is an old one
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
      case Solver::sequential_impulse:
        solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        break;
      case Solver::nncg:
        solver_ = std::make_unique<btNNCGConstraintSolver>();
        break;
      case Solver::dantzig:
        mlcp_ = std::make_unique<btDantzigSolver>();
        solver_ = std::make_unique<btMLCPSolver>(mlcp_.get());
        break;
      case Solver::pgs:
        mlcp_ = std::make_unique<btSolveProjectedGaussSeidel>();
        solver_ = std::make_unique<btMLCPSolver>(mlcp_.get());
        break;
    }
    return solver_.get();
  }

  void configure(btContactSolverInfo& info) const {
    info.m_numIterations = settings_.iterations;
    info.m_erp2 = settings_.erp;
    info.m_splitImpulsePenetrationThreshold = settings_.split_impulse_below;
    info.m_restitutionVelocityThreshold = settings_.restitution_threshold;
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
    btRigidBody::btRigidBodyConstructionInfo info(body.fixed ? 0.0 : body.mass, nullptr, shape,
                                                  to_bullet(inertias_.back().moments));
    info.m_startWorldTransform = to_bullet(Pose<3>{body.pose.position, body.pose.rotation * to_body});
    auto rigid = std::make_unique<btRigidBody>(info);
    rigid->setContactProcessingThreshold(settings_.contact_below);
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
    const Pose<3>& placement = body.shape.placement;
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
  const Settings settings_;
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

template <Solver solver>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const Settings settings = read_settings(read, scene, solver);
  read.finish();
  return std::make_unique<BulletWorld>(scene, settings, motion);
}

std::string version() { return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100); }

constexpr Capabilities kIterative{.contact_impulses = true, .torsional_friction = true, .restitution = true};
constexpr Capabilities kMlcp{.contact_impulses = true, .torsional_friction = false, .restitution = true};
constexpr SpatialEngine kDantzig{"bullet_dantzig", kMlcp, kDoublePrecision, &load<Solver::dantzig>};
constexpr SpatialEngine kNncg{"bullet_nncg", kIterative, kDoublePrecision, &load<Solver::nncg>};
constexpr SpatialEngine kPgs{"bullet_pgs", kMlcp, kDoublePrecision, &load<Solver::pgs>};
constexpr SpatialEngine kSi{"bullet_si", kIterative, kDoublePrecision, &load<Solver::sequential_impulse>};
constexpr const char* kDantzigText = "Bullet, double: mixed LCP by Dantzig's method, friction boxes";
constexpr const char* kNncgText = "Bullet, double: nonsmooth nonlinear conjugate gradients, friction boxes";
constexpr const char* kPgsText = "Bullet, double: mixed LCP by projected Gauss-Seidel, friction boxes";
constexpr const char* kSiText = "Bullet, double: sequential impulses, friction boxes";

constexpr MethodEntry<2> kPlanar[] = {
    {kDantzig.key, kDantzigText, &make_planar<kDantzig>, &version},
    {kNncg.key, kNncgText, &make_planar<kNncg>, &version},
    {kPgs.key, kPgsText, &make_planar<kPgs>, &version},
    {kSi.key, kSiText, &make_planar<kSi>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kDantzig.key, kDantzigText, &make_spatial<kDantzig>, &version},
    {kNncg.key, kNncgText, &make_spatial<kNncg>, &version},
    {kPgs.key, kPgsText, &make_spatial<kPgs>, &version},
    {kSi.key, kSiText, &make_spatial<kSi>, &version},
};

}  // namespace

Rows bullet_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
