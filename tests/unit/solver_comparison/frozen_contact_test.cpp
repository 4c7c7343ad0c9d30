#include "experiments/problems/frozen_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/complementarity/residual.h"
#include "core/complementarity/solver_chain.h"
#include "experiments/problems/recorded_steps.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::problems {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Two contacts that feel each other, of unequal friction.
FrozenContactProblem two_contacts() {
  MatrixXd a(6, 6);
  a << 2, 1, 0, 1, 0, 1, 0, 2, 1, 0, 1, 0, 1, 0, 2, 1, 0, 0, 0, 1, 0, 2, 1, 1, 1, 0, 1, 0, 2, 0, 0, 0, 1, 1,
      0, 2;
  VectorXd q(6);
  q << -1, 0.4, -0.3, -0.6, 1.2, 0.1;
  return {a * a.transpose(), q, Eigen::Vector2d(0.3, 0.8)};
}

TEST(FrozenContact, JacobianMatchesCentralDifferences) {
  const FrozenContactProblem problem = two_contacts();
  // r_n > 0 and < 0, friction inside its disc and outside of it.
  VectorXd sticking(6), sliding(6), apart(6);
  sticking << 50, 0.1, -0.2, 40, 0.3, 0.1;
  sliding << 1, 2, -1, 0.5, 0.4, 3;
  apart << -0.5, 0.3, 0.2, -1, 0.1, -0.4;
  for (const VectorXd& z : {sticking, sliding, apart}) {
    VectorXd f(6), above(6), below(6);
    MatrixXd jacobian(6, 6);
    problem.evaluate(z, f, &jacobian);
    for (Index j = 0; j < 6; ++j) {
      constexpr double kStep = 1e-6;
      VectorXd moved = z;
      moved[j] += kStep;
      problem.evaluate(moved, above, nullptr);
      moved[j] -= 2 * kStep;
      problem.evaluate(moved, below, nullptr);
      const VectorXd difference = (above - below) / (2 * kStep);
      // Rounding is 1e-16 |F| / step, the curvature of the projection of order step^2.
      EXPECT_LE((difference - jacobian.col(j)).lpNorm<Eigen::Infinity>(), 1e-8 * jacobian.norm()) << j;
    }
  }
}

/// A mass on a plane under one normal approach and one tangential velocity, W = I: what Coulomb's law gives.
TEST(FrozenContact, OneContactSticksOrSlidesAsCoulombSays) {
  for (const double mu : {0.2, 0.6}) {
    VectorXd q(3);
    q << -1.0, 0.3, -0.4;  // speed 0.5 along the plane
    const FrozenContactProblem problem(MatrixXd::Identity(3, 3), q, VectorXd::Constant(1, mu));
    SolverChain chain;
    VectorXd z = VectorXd::Zero(3);
    ASSERT_TRUE(chain.solve(problem, z).solved());
    const double friction = std::min(mu * 1.0, 0.5);  // what stops it, unless the cone ends before
    EXPECT_NEAR(z[0], 1.0, 1e-10);
    EXPECT_NEAR(z[1], -friction * 0.3 / 0.5, 1e-10);
    EXPECT_NEAR(z[2], friction * 0.4 / 0.5, 1e-10);
  }
}

TEST(FrozenContact, ASeparatingContactCarriesNothing) {
  VectorXd q(3);
  q << 0.5, 0.3, -0.4;
  const FrozenContactProblem problem(MatrixXd::Identity(3, 3), q, VectorXd::Constant(1, 0.5));
  SolverChain chain;
  VectorXd z = VectorXd::Ones(3);
  ASSERT_TRUE(chain.solve(problem, z).solved());
  EXPECT_LE(z.norm(), 1e-10);
}

/// Coulomb's law on its own terms: the cone, complementarity, friction against the slip.
void expect_coulomb(const FrozenContactProblem& problem, const VectorXd& r, double tolerance) {
  const VectorXd u = problem.w() * r + problem.q();
  for (Index i = 0; i < problem.contacts(); ++i) {
    const double p = r[3 * i];
    const Eigen::Vector2d friction = r.segment<2>(3 * i + 1), slip = u.segment<2>(3 * i + 1);
    EXPECT_GE(p, -tolerance);
    EXPECT_GE(u[3 * i], -tolerance);
    EXPECT_LE(std::abs(p * u[3 * i]), tolerance);
    EXPECT_LE(friction.norm(), problem.mu()[i] * p + tolerance);
    EXPECT_NEAR(friction.dot(slip), -problem.mu()[i] * p * slip.norm(), tolerance);
  }
}

TEST(FrozenContact, StepsOfAPileAreSolvedUnderCoulombsLaw) {
  const auto read = scene_file::read_scene(SCENES "/ten_bodies.toml");
  for (const auto& recorded : record_steps(std::get<Scene<3>>(read), 0.005, {98})) {
    const auto problem = FrozenContactProblem::from(recorded.problem);
    ASSERT_TRUE(problem.has_value());
    EXPECT_GE(problem->contacts(), 10);
    EXPECT_LE((problem->w() - problem->w().transpose()).norm(), 1e-12 * problem->w().norm());
    SolverChain chain;
    VectorXd z = VectorXd::Zero(problem->size());
    const SolveReport report = chain.solve(*problem, z);
    ASSERT_TRUE(report.solved()) << describe(report, *problem);
    expect_coulomb(*problem, z, 1e-8);  // products of a residual of 1e-10 with impulses and speeds below 10
  }
}

TEST(FrozenContact, AStepWithoutContactsHasNone) {
  const auto read = scene_file::read_scene(SCENES "/pendulum.toml");
  std::visit(
      [](const auto& scene) {
        if constexpr (std::is_same_v<std::decay_t<decltype(scene)>, Scene<3>>) {
          ImplicitStepper<3> stepper(scene, {});
          ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
          EXPECT_FALSE(FrozenContactProblem::from(stepper.problem()).has_value());
        }
      },
      read);
}

}  // namespace
}  // namespace touchstone::problems
