// One step against its own conditions, written out here from the read-back state and impulses, and against
// the same problem put together in one piece with every vertex and solved by Lemke's method as it stands.
#include <random>
#include <vector>

#include "core/complementarity/linear_path.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kInertia = 0.5;

/// All vertices of a polygon of unit mass above the ground y = 0 at the start of a step.
struct PlainProblem {
  std::vector<double> gaps;
  std::vector<Vector<2>> arms;
  Twist<2> free = Twist<2>::Zero();
  double mu = 0.0;
  double h = 0.0;
};

PlainProblem plain_problem(const Body<2>& polygon, const BodyState<2>& state, double mu, double h) {
  PlainProblem problem;
  const auto& shape = std::get<RegularPolygon>(polygon.shape.geometry);
  for (int k = 0; k < shape.edges; ++k) {
    problem.arms.emplace_back(state.pose.rotation.matrix() * shape.vertex(k));
    problem.gaps.push_back(state.pose.position.y() + problem.arms.back().y());
  }
  problem.free = state.velocity;
  problem.free[1] -= h * kGravity;
  problem.mu = mu;
  problem.h = h;
  return problem;
}

Twist<2> normal_wrench(const Vector<2>& arm) { return {0, 1, arm.x()}; }
Twist<2> tangent_wrench(const Vector<2>& arm) { return {1, 0, -arm.y()}; }

/// M^-1 W with columns n, +t, -t of every vertex, and the LCP (a), (b), (c) of lcp_step.h as a dense matrix.
Twist<2> solve_in_one_piece(const PlainProblem& problem) {
  const auto count = static_cast<Eigen::Index>(problem.arms.size());
  Eigen::MatrixXd wrenches(3, 4 * count);
  Eigen::VectorXd q(4 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector<2>& arm = problem.arms[static_cast<std::size_t>(i)];
    wrenches.middleCols(4 * i, 4) << normal_wrench(arm), tangent_wrench(arm), -tangent_wrench(arm),
        Twist<2>::Zero();
    q.segment(4 * i, 4) = wrenches.middleCols(4 * i, 4).transpose() * problem.free;
    q[4 * i] += problem.gaps[static_cast<std::size_t>(i)] / problem.h;
  }
  const Twist<2> inverse_mass(1, 1, 1 / kInertia);
  Eigen::MatrixXd m = wrenches.transpose() * inverse_mass.asDiagonal() * wrenches;
  for (Eigen::Index i = 0; i < count; ++i) {
    m(4 * i + 1, 4 * i + 3) = m(4 * i + 2, 4 * i + 3) = 1;
    m.row(4 * i + 3).segment(4 * i, 3) << problem.mu, -1, -1;
  }
  LinearPath path;
  Eigen::VectorXd z;
  EXPECT_TRUE(path.lemke(m, q, z).solved());
  return problem.free + inverse_mass.asDiagonal() * wrenches * z;
}

/// Complementarity and Coulomb's law at every vertex, at nu' and the impulses read back.
void expect_solved(const PlainProblem& problem, const Body<2>& polygon, const Method<2>& method) {
  const BodyState<2>& state = method.state()[0];
  const double scale = problem.free.norm();
  const auto& shape = std::get<RegularPolygon>(polygon.shape.geometry);
  std::vector<Vector<2>> impulses(problem.arms.size(), Vector<2>::Zero());
  for (const auto& contact : method.contacts()) {
    const Vector<2> body_point = state.pose.to_body(contact.point_a);
    for (int k = 0; k < shape.edges; ++k) {
      if ((shape.vertex(k) - body_point).norm() > 1e-9) continue;
      impulses[static_cast<std::size_t>(k)] = {contact.friction_impulse[0], contact.normal_impulse};
    }
  }
  Twist<2> nu = problem.free;
  for (std::size_t k = 0; k < impulses.size(); ++k) {
    const Vector<2>& arm = problem.arms[k];
    const auto [friction, normal] = std::pair(impulses[k].x(), impulses[k].y());
    nu += Twist<2>(1, 1, 1 / kInertia)
              .cwiseProduct(normal_wrench(arm) * normal + tangent_wrench(arm) * friction);
    const double closing = problem.gaps[k] / problem.h + normal_wrench(arm).dot(state.velocity);
    const double slip = tangent_wrench(arm).dot(state.velocity);
    EXPECT_GE(normal, 0);
    EXPECT_GE(closing, -1e-11 * scale) << "vertex " << k;
    EXPECT_NEAR(normal * closing, 0, 1e-11 * scale * scale) << "vertex " << k;
    EXPECT_LE(std::abs(friction), problem.mu * normal + 1e-11 * scale);
    EXPECT_NEAR(friction * slip + problem.mu * normal * std::abs(slip), 0, 1e-11 * scale * scale)
        << "vertex " << k;
  }
  EXPECT_NEAR((nu - state.velocity).norm(), 0, 1e-11 * scale) << "momentum of the impulses";
}

Body<2> random_polygon(std::mt19937& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  Body<2> polygon = body<2>("polygon", {RegularPolygon{std::uniform_int_distribution(3, 60)(random), 1.0}},
                            {0, 1.02 + 0.03 * real(random)});
  polygon.pose.rotation = PlanarRotation(3 * real(random));
  polygon.inertia << kInertia;
  polygon.velocity << 4 * real(random), 3 * real(random), 6 * real(random);
  return polygon;
}

TEST(StewartTrinkleLcp, SolvesTheProblemOfAllVertices) {
  std::mt19937 random(6);
  int touching = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Body<2> polygon = random_polygon(random);
    const double mu = std::uniform_real_distribution(0.0, 1.0)(random);
    const double h = std::pow(10.0, std::uniform_real_distribution(-4.0, -1.0)(random));
    const auto method = make_stewart_trinkle<2>(scene<2>(mu, {polygon, ground<2>()}), {});
    const PlainProblem problem = plain_problem(polygon, method->state()[0], mu, h);
    advance(*method, h, 1);
    expect_solved(problem, polygon, *method);
    for (const auto& contact : method->contacts()) touching += contact.normal_impulse > 0 ? 1 : 0;
    if (::testing::Test::HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GE(touching, 100);
}

TEST(StewartTrinkleLcp, IsLemkesSolutionOfTheWholeProblem) {
  for (const auto& [edges, steps] : {std::pair{10, 300}, std::pair{37, 100}, std::pair{100, 5}}) {
    const auto method = make_stewart_trinkle<2>(rolling_disc(), {{"edges", std::to_string(edges)}});
    const Body<2>& polygon = method->scene().bodies[0];
    for (int k = 0; k < steps; ++k) {
      const PlainProblem problem = plain_problem(polygon, method->state()[0], 0.4, 0.01);
      advance(*method, 0.01, 1);
      const Twist<2> whole = solve_in_one_piece(problem);
      ASSERT_NEAR((method->state()[0].velocity - whole).norm(), 0, 1e-11) << edges << " edges, step " << k;
    }
  }
}

// A disc between floor and ceiling that are closer than its diameter: no velocity meets both gaps.
TEST(StewartTrinkleLcp, FailureLeavesTheStateAndSaysWhy) {
  Scene<2> jammed = scene<2>(0.4, {disc("disc", {0, 1}, {0.5, 0, 0}), ground<2>()});
  jammed.bodies.push_back(wall<2>("ceiling", {0, -1}, {0, 1.9}));
  for (const char* edges : {"0", "8"}) {
    const auto method = make_stewart_trinkle<2>(jammed, {{"edges", edges}});
    const BodyState<2> before = method->state()[0];
    const StepReport report = method->step(0.01);
    EXPECT_EQ(report.status, StepStatus::not_converged);
    EXPECT_EQ(report.reason, "Lemke's method ended on a ray");
    EXPECT_EQ(difference(before, method->state()[0]), 0.0);
    EXPECT_TRUE(method->contacts().empty());
  }
}

}  // namespace
}  // namespace touchstone::testing
