#include "core/stepper/step_problem.h"

#include <gtest/gtest.h>

#include <random>

namespace touchstone {
namespace {

/// Two moving bodies and a fixed one, in general position, so that no derivative is zero by symmetry.
Scene<2> planar_scene() {
  Scene<2> scene;
  scene.gravity = {0.3, -9.81};
  scene.contact_law.mu = 0.4;
  scene.contact_law.e_t = 0.8;
  Body<2> disc;
  disc.name = "disc";
  disc.mass = 1.3;
  disc.inertia << 0.45;
  disc.pose = {{0.1, 1.02}, PlanarRotation(0.3)};
  disc.velocity << -3, 0.2, 2.5;
  disc.force = {0.1, 0.2};
  disc.shape = {Sphere<2>{1.0}, {{0.05, -0.02}, PlanarRotation(0.1)}};
  Body<2> ellipse = disc;
  ellipse.name = "ellipse";
  ellipse.mass = 2.1;
  ellipse.pose = {{2.3, 1.3}, PlanarRotation(-0.7)};
  ellipse.velocity << 1, -0.4, -1.5;
  ellipse.shape = {Ellipsoid<2>{{1.2, 0.7}}};
  Body<2> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape = {HalfSpace<2>{Vector<2>(0.1, 1).normalized(), 0.05}};
  scene.bodies = {disc, ellipse, ground};
  return scene;
}

Scene<3> spatial_scene() {
  Scene<3> scene;
  scene.gravity = {0.3, -0.2, -9.81};
  scene.contact_law = {
      .mu = 0.4, .e_t = 0.8, .e_o = 1.2, .e_r = 0.3, .restitution = 0, .tangent = {1, 0.2, 0.1}};
  Body<3> ball;
  ball.name = "ball";
  ball.mass = 1.3;
  ball.inertia = Vector<3>(0.45, 0.5, 0.6).asDiagonal();
  ball.pose = {{0.1, 0.2, 1.02}, SpatialRotation(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2))};
  ball.velocity << -3, 0.2, 0.4, 2.5, -1.1, 0.7;
  ball.shape = {Sphere<3>{1.0}, {{0.05, -0.02, 0.03}, {}}};
  Body<3> ellipsoid = ball;
  ellipsoid.name = "ellipsoid";
  ellipsoid.mass = 2.1;
  ellipsoid.pose = {{1.9, 0.5, 1.3}, SpatialRotation(Eigen::Quaterniond(0.5, 0.4, -0.1, 0.6))};
  ellipsoid.velocity << 1, -0.4, 0.3, -1.5, 0.9, 2.0;
  ellipsoid.shape = {Ellipsoid<3>{{1.2, 0.7, 0.9}}};
  Body<3> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape = {HalfSpace<3>{Vector<3>(0.1, -0.2, 1).normalized(), 0.05}};
  scene.bodies = {ball, ellipsoid, ground};
  return scene;
}

template <int Dim>
Scene<Dim> general_scene() {
  if constexpr (Dim == 2) {
    return planar_scene();
  } else {
    return spatial_scene();
  }
}

template <int Dim>
struct Fixture {
  Scene<Dim> scene;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces;
  std::vector<ContactPair<Dim>> contacts;
  StepProblem<Dim> problem;

  explicit Fixture(Scene<Dim> given = general_scene<Dim>(), double h = 0.05)
      : scene(std::move(given)), problem(scene) {
    for (const auto& body : scene.bodies) surfaces.push_back(make_surface(body.shape));
    add(0, 2);
    add(1, 2);
    add(0, 1);
    problem.prepare(initial_state(scene), h, contacts);
  }
  void add(int a, int b) {
    contacts.push_back({a, b, make_side(*surfaces[static_cast<std::size_t>(a)]),
                        make_side(*surfaces[static_cast<std::size_t>(b)]), scene.contact_law});
  }
};

/// Largest difference of the analytic Jacobian from central differences at z.
double jacobian_error(const MixedComplementarityProblem& problem, const Eigen::VectorXd& z) {
  const Eigen::Index n = problem.size();
  Eigen::MatrixXd analytic(n, n);
  Eigen::VectorXd f(n);
  Eigen::VectorXd ahead(n);
  Eigen::VectorXd behind(n);
  problem.evaluate(z, f, &analytic);
  double worst = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double step = 1e-6;
    Eigen::VectorXd moved = z;
    moved[j] += step;
    problem.evaluate(moved, ahead, nullptr);
    moved[j] -= 2 * step;
    problem.evaluate(moved, behind, nullptr);
    const Eigen::VectorXd difference = (ahead - behind) / (2 * step) - analytic.col(j);
    worst = std::max(worst, difference.cwiseAbs().maxCoeff());
  }
  return worst;
}

/// A ball that is to pass below a fixed one; the law's t points up, nearly along the normal.
Scene<3> ball_below_ball() {
  Scene<3> scene;
  scene.contact_law.mu = 0.5;
  scene.contact_law.tangent = Vector<3>::UnitZ();
  Body<3> ball;
  ball.name = "ball";
  ball.mass = 1.0;
  ball.inertia = 0.4 * Matrix<3>::Identity();
  ball.shape = {Sphere<3>{1.0}};
  Body<3> fixed = ball;
  fixed.name = "fixed";
  fixed.fixed = true;
  fixed.pose.position.z() = 2.1;
  scene.bodies = {ball, fixed};
  return scene;
}

// Friction in z is told in t and o: were they chosen anew with every normal, one that goes to and fro about
// where the law's t stops being usable would turn it to and fro.
TEST(StepProblemPoints, FoundAnewLeaveTheDirectionOfFrictionWhereItIs) {
  const Scene<3> scene = ball_below_ball();
  const auto surface = make_surface(scene.bodies[0].shape);
  StepProblem<3> problem(scene);
  problem.prepare(initial_state(scene), 0.05,
                  {{0, 1, make_side(*surface), make_side(*surface), scene.contact_law}});
  Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
  const auto direction_at = [&](double speed) {
    z[0] = speed;
    problem.find_points(0, z);
    return problem.prepared(0).reference;
  };
  const Vector<3> law = direction_at(4.4);  // sin of the angle between t and n: 0.104, and 0.095 at 4
  EXPECT_EQ(law, Vector<3>::UnitZ());
  const Vector<3> other = direction_at(4.0);
  EXPECT_NE(other, law);
  EXPECT_EQ(direction_at(4.4), other);
  EXPECT_EQ(direction_at(4.0), other);
}

template <typename T>
class StepProblemTest : public testing::Test {};
struct Planar {
  static constexpr int dim = 2;
};
struct Spatial {
  static constexpr int dim = 3;
};
using Dimensions = testing::Types<Planar, Spatial>;
TYPED_TEST_SUITE(StepProblemTest, Dimensions);

TYPED_TEST(StepProblemTest, JacobianMatchesCentralDifferences) {
  Fixture<TypeParam::dim> fixture;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const FrictionForm form :
       {FrictionForm::fritz_john, FrictionForm::projection, FrictionForm::no_slip}) {
    for (const GapFunction gap : {GapFunction::workspace, GapFunction::distance}) {
      fixture.problem.set_form(form);
      fixture.problem.set_gap(gap);
      for (int sample = 0; sample < 20; ++sample) {
        Eigen::VectorXd z(fixture.problem.size());
        for (auto& entry : z) entry = uniform(random);
        EXPECT_LT(jacobian_error(fixture.problem, z), 2e-7);
      }
    }
  }
}

TYPED_TEST(StepProblemTest, JacobianWithIntersectionsMatchesCentralDifferences) {
  constexpr int dim = TypeParam::dim;
  std::mt19937 random(13);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Scene<dim> scene = general_scene<dim>();
  // A lens on the ground, a box on an ellipsoid, and two intersections on each other.
  const Shape<dim> above = {Sphere<dim>{1.5}, {-0.8 * Vector<dim>::UnitX(), {}}};
  const Shape<dim> below = {Ellipsoid<dim>{Vector<dim>::Constant(1.4)}, {0.7 * Vector<dim>::UnitX(), {}}};
  scene.bodies[0].shape = {Intersection<dim>{{above, below}}};
  for (const int other : {1, 2}) {
    if (other == 1) scene.bodies[1].shape = {Box<dim>{Vector<dim>::Constant(0.6)}};
    Fixture<dim> fixture(scene);
    EXPECT_GT(fixture.problem.size(), fixture.problem.layout().free_size() + 2 * 3);
    for (int sample = 0; sample < 20; ++sample) {
      Eigen::VectorXd z(fixture.problem.size());
      for (auto& entry : z) entry = uniform(random);
      EXPECT_LT(jacobian_error(fixture.problem, z), 2e-7);
    }
  }
}

TYPED_TEST(StepProblemTest, JacobianWithJointsMatchesCentralDifferences) {
  constexpr int dim = TypeParam::dim;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const JointType type : {JointType::ball, JointType::hinge, JointType::slider, JointType::fixed}) {
    Scene<dim> scene = general_scene<dim>();
    const Vector<dim> anchor = Vector<dim>::Constant(0.7);
    const Vector<dim> axis = (Vector<dim>::Constant(0.3) + Vector<dim>::UnitX()).normalized();
    scene.joints = {{type, 0, 1, anchor, axis}, {type, 1, 2, -anchor, axis}};
    StepProblem<dim> problem(scene);
    problem.prepare(initial_state(scene), 0.05, {});
    for (int sample = 0; sample < 10; ++sample) {
      Eigen::VectorXd z(problem.size());
      for (auto& entry : z) entry = uniform(random);
      EXPECT_LT(jacobian_error(problem, z), 2e-7);
    }
    // The joints hold in the pose that they were made in.
    Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
    Eigen::VectorXd f(problem.size());
    problem.evaluate(z, f, nullptr);
    EXPECT_LT(f.tail(problem.size() - problem.layout().joints()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(StepProblemSize, DiscOnPlaneHasTheNineUnknownsOfThePaper) {
  Fixture<2> fixture;
  fixture.scene.bodies.erase(fixture.scene.bodies.begin() + 1);
  StepProblem<2> problem(fixture.scene);
  std::vector<ContactPair<2>> contact = {fixture.contacts[0]};
  contact[0].body_2 = 1;
  problem.prepare(initial_state(fixture.scene), 0.01, contact);
  EXPECT_EQ(problem.size(), 9);
  EXPECT_EQ(problem.layout().free_size(), 7);  // nu (3), a_1 (2), a_2x (1), p_t; then p_n, sigma >= 0
}

TEST(StepProblemSize, BallOnTwoBallsHasTheTwentyEightUnknownsOfThePaper) {
  Scene<3> scene = spatial_scene();
  Fixture<3> fixture;
  scene.bodies[1].fixed = true;
  scene.bodies[2] = scene.bodies[1];
  scene.bodies[2].name = "other";
  StepProblem<3> problem(scene);
  std::vector<ContactPair<3>> contacts = {fixture.contacts[2], fixture.contacts[2]};
  contacts[1].body_2 = 2;
  problem.prepare(initial_state(scene), 0.01, contacts);
  EXPECT_EQ(problem.size(), 28);
  EXPECT_EQ(problem.layout().free_size(), 6 + 9 * 2);  // 6 n_b + 9 n_c
}

}  // namespace
}  // namespace touchstone
