// Random linear problems are what they say, and the chain of solvers says the same of them.
#include "experiments/problems/random_lcp.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/residual.h"
#include "core/complementarity/solver_chain.h"
#include "experiments/problems/literature.h"

namespace touchstone::problems {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kSeeds = 10;

FunctionProblem problem_of(const RandomLcp& lcp) { return {lcp.q.size(), linear(lcp.m, lcp.q)}; }

std::vector<VectorXd> starts(Index n) {
  return {VectorXd::Zero(n), VectorXd::Ones(n), VectorXd::LinSpaced(n, 0, 10)};
}

TEST(RandomLcp, SolutionsSolve) {
  for (const LcpKind kind : {LcpKind::p_matrix, LcpKind::degenerate}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const RandomLcp lcp = random_lcp(kind, 12, seed);
      const VectorXd slack = lcp.m * lcp.solution + lcp.q;
      EXPECT_LE(natural_residual(problem_of(lcp), lcp.solution).value, 1e-14);
      const Index degenerate = (lcp.solution.array() == 0 && slack.array().abs() < 1e-14).count();
      EXPECT_EQ(degenerate, kind == LcpKind::degenerate ? 4 : 0);
    }
  }
}

TEST(RandomLcp, MatricesArePositiveDefiniteOrOfHalfRank) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const MatrixXd p = random_lcp(LcpKind::p_matrix, 10, seed).m;
    EXPECT_GT((p + p.transpose()).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.1);
    EXPECT_GT((p - p.transpose()).norm(), 0.1) << "not symmetric";
    const MatrixXd d = random_lcp(LcpKind::degenerate, 10, seed).m;
    const VectorXd values = d.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_EQ((values.array() < 1e-12).count(), 5);
  }
}

/// By Farkas's lemma: y > 0 with y^T M < 0 and y^T q < 0 leaves no z >= 0 with M z + q >= 0.
TEST(RandomLcp, InfeasibleOnesHaveACertificate) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const RandomLcp lcp = random_lcp(LcpKind::infeasible, 12, seed);
    EXPECT_GT(lcp.certificate.minCoeff(), 0);
    EXPECT_LT((lcp.m.transpose() * lcp.certificate).maxCoeff(), 0);
    EXPECT_LT(lcp.q.dot(lcp.certificate), 0);
  }
}

TEST(RandomLcp, TheChainSolvesThemFromEveryStart) {
  SolverChain chain;
  for (const LcpKind kind : {LcpKind::p_matrix, LcpKind::degenerate}) {
    for (const Index n : {3, 10, 40}) {
      for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const RandomLcp lcp = random_lcp(kind, n, seed);
        for (VectorXd z : starts(n)) {
          const SolveReport report = chain.solve(problem_of(lcp), z);
          EXPECT_TRUE(report.solved()) << to_string(kind) << n << ": " << describe(report, problem_of(lcp));
          EXPECT_LE(natural_residual(problem_of(lcp), z).value, 1e-10);
          if (kind != LcpKind::p_matrix) continue;
          EXPECT_LE((z - lcp.solution).norm(), 1e-8) << "the only solution";
        }
      }
    }
  }
}

TEST(RandomLcp, WithoutASolutionTheChainSaysSoAndWhy) {
  SolverChain chain;
  LinearPath path;
  for (const Index n : {3, 12}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const RandomLcp lcp = random_lcp(LcpKind::infeasible, n, seed);
      for (VectorXd z : starts(n)) {
        const SolveReport report = chain.solve(problem_of(lcp), z);
        EXPECT_FALSE(report.solved());
        EXPECT_NE(report.status, SolveStatus::not_run);
        EXPECT_GT(report.residual, 1e-3);
        EXPECT_GE(report.stages.count(), 4) << "each way was tried";
        for (const SolveStage& stage : report.stages.values()) {
          EXPECT_TRUE(stage.weight > 0.0 || stage.status != SolveStatus::solved);
        }
        EXPECT_EQ(report.residual, natural_residual(problem_of(lcp), z).value);
      }
      VectorXd z;
      EXPECT_EQ(path.lemke(lcp.m, lcp.q, z).status, LinearPathStatus::ray);
    }
  }
}

TEST(RandomLcp, TheSameSeedGivesTheSameProblem) {
  EXPECT_EQ(random_lcp(LcpKind::p_matrix, 6, 3).m, random_lcp(LcpKind::p_matrix, 6, 3).m);
  EXPECT_NE(random_lcp(LcpKind::p_matrix, 6, 3).m, random_lcp(LcpKind::p_matrix, 6, 4).m);
}

}  // namespace
}  // namespace touchstone::problems
