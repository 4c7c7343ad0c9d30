#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <dart/collision/CollisionObject.hpp>
#include <dart/collision/ode/OdeCollisionDetector.hpp>
#include <dart/config.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ContactConstraint.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/dynamics.hpp>
#include <dart/simulation/World.hpp>
#include <map>
#include <mutex>

#include "baselines/engines/dart_materials.h"
#include "baselines/engines/engines.h"
#include "baselines/engines/loaded_library.h"
#include "baselines/engines/ode_start.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/spatial_engine.h"

/// DART 6.12: spatial, double precision, articulated bodies, friction boxes; overlaps found by ODE's
/// colliders.
namespace touchstone::engines {

namespace {

enum class Solver { dantzig, pgs };

/// Overlap that is left alone [m]. DART's default is 0, with which a body at rest creeps out of contact. DART
/// keeps it in a global, so it is a constant and not an option. It is smaller than in ODE because DART acts
/// at the body's deepest point, so that a skin lengthens the lever arm.
constexpr double kErrorAllowance = 1e-5;

struct Settings {
  Solver solver;
  int iterations;  ///< of projected Gauss-Seidel
};

Settings read_settings(OptionReader& read, Solver solver) {
  Settings s{solver, 0};
  if (solver == Solver::pgs) s.iterations = read.integer("iterations", 100, 1, 100000);
  return s;
}

Eigen::Isometry3d to_dart(const Pose<3>& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = pose.rotation.matrix();
  transform.translation() = pose.position;
  return transform;
}

aiVector3D to_assimp(const Vector<3>& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// A closed mesh of triangles. Its vertices are in single precision, because assimp's are.
aiMesh* triangle_mesh(const Polytope<3>& polytope) {
  auto* mesh = new aiMesh;
  mesh->mNumVertices = static_cast<unsigned>(polytope.vertices.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  mesh->mNormals = new aiVector3D[mesh->mNumVertices];
  for (std::size_t k = 0; k < polytope.vertices.size(); ++k) {
    mesh->mVertices[k] = to_assimp(polytope.vertices[k]);
    mesh->mNormals[k] = to_assimp(polytope.vertices[k].normalized());
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto& face : face_corners(polytope)) {
    for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
  }
  mesh->mNumFaces = static_cast<unsigned>(triangles.size());
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    mesh->mFaces[k].mNumIndices = 3;
    mesh->mFaces[k].mIndices = new unsigned[3];
    std::copy_n(triangles[k].begin(), 3, mesh->mFaces[k].mIndices);
  }
  return mesh;
}

/// Owned by the shape that it goes into, which releases it.
aiScene* mesh_scene(const Polytope<3>& polytope) {
  auto* scene = new aiScene;
  scene->mNumMeshes = 1;
  scene->mMeshes = new aiMesh* [1] { triangle_mesh(polytope) };
  scene->mRootNode = new aiNode;
  scene->mRootNode->mNumMeshes = 1;
  scene->mRootNode->mMeshes = new unsigned[1]{0};
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  return scene;
}

dart::dynamics::ShapePtr create_shape(const Body<3>& body) {
  using namespace dart::dynamics;
  const auto geometry = inflated(body.shape.geometry, kErrorAllowance / 4);
  if (const auto* s = std::get_if<Sphere<3>>(&geometry)) return std::make_shared<SphereShape>(s->radius);
  if (const auto* s = std::get_if<Box<3>>(&geometry)) return std::make_shared<BoxShape>(2 * s->half_extents);
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    return std::make_shared<CylinderShape>(s->radius, 2 * s->half_height);
  }
  if (const auto* s = std::get_if<Capsule>(&geometry)) {
    return std::make_shared<CapsuleShape>(s->radius, 2 * s->half_height);
  }
  if (const auto* s = std::get_if<HalfSpace<3>>(&geometry)) {
    return std::make_shared<PlaneShape>(s->normal, s->offset);
  }
  if (const auto* s = std::get_if<Polytope<3>>(&geometry)) {
    return std::make_shared<MeshShape>(Vector<3>::Ones(), mesh_scene(*s));
  }
  refuse_shape("DART", body, "DART has no shape for it that ODE's colliders know");
}

class DartWorld final : public Engine<3> {
 public:
  DartWorld(const Scene<3>& scene, const Settings& settings, Motion motion)
      : scene_(scene), motion_(motion), world_(dart::simulation::World::create()) {
    refuse_moving_half_spaces("DART", scene_);
    dart::constraint::ContactConstraint::setErrorAllowance(kErrorAllowance);
    world_->setGravity(scene_.gravity);
    world_->setConstraintSolver(create_solver(settings));
    const auto materials = dart_materials(scene_);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i, materials[i]);
  }

  ~DartWorld() override {
    const std::lock_guard lock(ode_start());
    world_.reset();
  }

  StepReport advance(double h) override {
    h_ = h;
    if (world_->getTimeStep() != h) world_->setTimeStep(h);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!scene_.bodies[i].fixed) bodies_[i]->addExtForce(scene_.bodies[i].force);
    }
    world_->step();
    return {};
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    const auto i = static_cast<std::size_t>(index);
    if (scene_.bodies[i].fixed) return {scene_.bodies[i].pose, Twist<3>::Zero()};
    const Eigen::Isometry3d& transform = bodies_[i]->getWorldTransform();
    BodyState<3> state;
    state.pose = {transform.translation(), SpatialRotation(Eigen::Quaterniond(transform.linear()))};
    state.velocity << bodies_[i]->getLinearVelocity(), bodies_[i]->getAngularVelocity();
    return state;
  }

  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const auto& inertia = bodies_[static_cast<std::size_t>(index)]->getInertia();
    return {inertia.getMass(), inertia.getMoment()};
  }

  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (const auto& c : world_->getLastCollisionResult().getContacts()) {
      const int a = index_of(c.collisionObject1);
      const int b = index_of(c.collisionObject2);
      if (scene_.bodies[static_cast<std::size_t>(a)].fixed &&
          scene_.bodies[static_cast<std::size_t>(b)].fixed)
        continue;
      // DART's normal points into the first body, which its force acts on.
      const ContactPlace<3> place{a, b, c.point, c.point, c.normal};
      contacts.push_back(contact_impulse<3>(scene_, place, h_ * c.force));
    }
  }

 private:
  static std::unique_ptr<dart::constraint::ConstraintSolver> create_solver(const Settings& settings) {
    using namespace dart::constraint;
    std::unique_ptr<BoxedLcpConstraintSolver> solver;
    if (settings.solver == Solver::dantzig) {
      // DART's own combination: where Dantzig's method fails, Gauss-Seidel takes over.
      solver = std::make_unique<BoxedLcpConstraintSolver>(std::make_shared<DantzigBoxedLcpSolver>());
    } else {
      const auto pgs = std::make_shared<PgsBoxedLcpSolver>();
      pgs->setOption(PgsBoxedLcpSolver::Option(settings.iterations));
      solver = std::make_unique<BoxedLcpConstraintSolver>(pgs, nullptr);
    }
    // The default detector replaces spheres by meshes, on which a ball does not roll.
    solver->setCollisionDetector(dart::collision::OdeCollisionDetector::create());
    return solver;
  }

  int index_of(const dart::collision::CollisionObject* object) const {
    const auto* body = object->getShapeFrame()->asShapeNode()->getBodyNodePtr().get();
    return body_index_.at(body);
  }

  void add_body(std::size_t i, const DartMaterial& material) {
    using namespace dart::dynamics;
    const auto& body = scene_.bodies[i];
    const auto skeleton = Skeleton::create(fmt::format("{}", i));
    BodyNode* node = nullptr;
    if (body.fixed) {
      const auto [joint, created] = skeleton->createJointAndBodyNodePair<WeldJoint>();
      joint->setTransformFromParentBodyNode(to_dart(body.pose));
      node = created;
    } else {
      node = motion_ == Motion::planar ? add_planar(*skeleton, body) : add_free(*skeleton, body);
      dart::dynamics::Inertia inertia;
      inertia.setMass(body.mass);
      inertia.setMoment(body.inertia);
      node->setInertia(inertia);
    }
    auto* shape = node->createShapeNodeWith<CollisionAspect, DynamicsAspect>(create_shape(body));
    shape->setRelativeTransform(to_dart(body.shape.placement));
    set_material(*shape->getDynamicsAspect(), material);
    world_->addSkeleton(skeleton);
    bodies_.push_back(node);
    body_index_[node] = static_cast<int>(i);
  }

  static dart::dynamics::BodyNode* add_free(dart::dynamics::Skeleton& skeleton, const Body<3>& body) {
    const auto [joint, node] = skeleton.createJointAndBodyNodePair<dart::dynamics::FreeJoint>();
    joint->setTransform(to_dart(body.pose));
    joint->setLinearVelocity(body.velocity.head<3>());
    joint->setAngularVelocity(body.velocity.tail<3>());
    return node;
  }

  static dart::dynamics::BodyNode* add_planar(dart::dynamics::Skeleton& skeleton, const Body<3>& body) {
    const auto [joint, node] = skeleton.createJointAndBodyNodePair<dart::dynamics::PlanarJoint>();
    joint->setXYPlane();
    const auto& r = body.pose.rotation.matrix();
    joint->setPositions(
        Vector<3>(body.pose.position.x(), body.pose.position.y(), std::atan2(r(1, 0), r(0, 0))));
    joint->setVelocities(Vector<3>(body.velocity[0], body.velocity[1], body.velocity[5]));
    return node;
  }

  static void set_material(dart::dynamics::DynamicsAspect& aspect, const DartMaterial& material) {
    aspect.setPrimaryFrictionCoeff(material.mu_t);
    aspect.setSecondaryFrictionCoeff(material.mu_o);
    aspect.setFirstFrictionDirection(material.tangent);
    aspect.setFirstFrictionDirectionFrame(dart::dynamics::Frame::World());
    aspect.setRestitutionCoeff(material.restitution);
  }

  const Scene<3> scene_;
  const Motion motion_;
  dart::simulation::WorldPtr world_;
  std::vector<dart::dynamics::BodyNode*> bodies_;
  std::map<const dart::dynamics::BodyNode*, int> body_index_;
  double h_ = 0;
};

template <Solver solver>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const Settings settings = read_settings(read, solver);
  read.finish();
  const std::lock_guard lock(ode_start());
  return std::make_unique<DartWorld>(scene, settings, motion);
}

/// DART tells its version in no function.
std::string version() {
  return version_and_file(DART_VERSION, loaded_file(reinterpret_cast<const void*>(&dart::math::expMapRot)),
                          FileNumber::release);
}

constexpr Capabilities kCapabilities{
    .contact_impulses = true, .torsional_friction = false, .anisotropic_friction = true, .restitution = true};
constexpr SpatialEngine kDantzig{"dart_dantzig", kCapabilities, kDoublePrecision, &load<Solver::dantzig>};
constexpr SpatialEngine kPgs{"dart_pgs", kCapabilities, kDoublePrecision, &load<Solver::pgs>};
constexpr const char* kDantzigText = "DART: boxed LCP by Dantzig's method, friction boxes, ODE's colliders";
constexpr const char* kPgsText = "DART: boxed LCP by projected Gauss-Seidel, friction boxes, ODE's colliders";

constexpr MethodEntry<2> kPlanar[] = {
    {kDantzig.key, kDantzigText, &make_planar<kDantzig>, &version},
    {kPgs.key, kPgsText, &make_planar<kPgs>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kDantzig.key, kDantzigText, &make_spatial<kDantzig>, &version},
    {kPgs.key, kPgsText, &make_spatial<kPgs>, &version},
};

}  // namespace

Rows dart_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
