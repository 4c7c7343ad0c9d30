// Problems with a sparse Jacobian: the same answers as with the dense one, and sizes that a dense one
// forbids.
#include <gtest/gtest.h>

#include <vector>

#include "core/complementarity/fischer_burmeister.h"
#include "core/complementarity/normal_equations.h"
#include "core/complementarity/proximal_problem.h"
#include "core/complementarity/solver_chain.h"
#include "core/complementarity/sparse_columns.h"
#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/checks.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using problems::TestProblem;

/// A problem of the table that hands out its Jacobian as a sparse matrix.
class SparseView final : public SparseComplementarityProblem {
 public:
  explicit SparseView(const MixedComplementarityProblem& problem) : problem_(problem) {}
  [[nodiscard]] Index size() const override { return problem_.size(); }
  [[nodiscard]] const VectorXd& lower() const override { return problem_.lower(); }
  [[nodiscard]] const VectorXd& upper() const override { return problem_.upper(); }
  void evaluate_sparse(const VectorXd& z, VectorXd& f, Matrix* jacobian) const override {
    if (jacobian == nullptr) return problem_.evaluate(z, f, nullptr);
    MatrixXd dense(size(), size());
    problem_.evaluate(z, f, &dense);
    *jacobian = dense.sparseView();
  }

 private:
  const MixedComplementarityProblem& problem_;
};

/// Residuals of the search's iterates with either Jacobian. What a singular Newton system leads to differs,
/// so only problems on which no such comes up are compared step by step.
template <typename Solver>
void expect_same_iterates(const TestProblem& test) {
  for (const VectorXd& start : test.starts) {
    Solver dense_solver, sparse_solver;
    VectorXd dense_z = start, sparse_z = start;
    const SolveReport dense = dense_solver.solve(*test.problem, dense_z);
    const SolveReport sparse = sparse_solver.solve(SparseView(*test.problem), sparse_z);
    ASSERT_EQ(sparse.status, dense.status) << test.name;
    ASSERT_EQ(sparse.iterations, dense.iterations) << test.name;
    EXPECT_EQ(sparse.pivots, dense.pivots) << test.name;
    EXPECT_NEAR((sparse_z - dense_z).lpNorm<Eigen::Infinity>(), 0.0, 1e-9) << test.name;
  }
}

TEST(SparseJacobian, PathNewtonTakesTheSameSteps) {
  for (const TestProblem& test : {problems::kojshin(), problems::nash10(), problems::nash5(),
                                  problems::path4(), problems::bimatrix(), problems::obstacle(8)}) {
    expect_same_iterates<PathNewton>(test);
  }
}

TEST(SparseJacobian, SemismoothNewtonTakesTheSameSteps) {
  for (const TestProblem& test : {problems::nash10(), problems::nash5(), problems::obstacle(8)})
    expect_same_iterates<SemismoothNewton>(test);
}

TEST(SparseJacobian, TheChainSolvesEveryStartOfTheTable) {
  SolverChain chain;
  for (const TestProblem& test : problems::all_problems()) {
    for (const VectorXd& start : test.starts) {
      VectorXd z = start;
      const SolveReport report = chain.solve(SparseView(*test.problem), z);
      testing::expect_solved(report, test, z, 1e-10);
    }
  }
}

TEST(SparseJacobian, AMembraneOfTenThousandNodesIsSolved) {
  // Dense matrices of this size would need 0.8 GB each.
  const problems::SparseLinearProblem problem = problems::sparse_obstacle(100);
  SolverChain chain;
  VectorXd z = VectorXd::Zero(problem.size());
  const SolveReport report = chain.solve(problem, z);
  ASSERT_TRUE(report.solved()) << describe(report, problem);
  EXPECT_LE(natural_residual(problem, z).value, 1e-10);
  EXPECT_EQ(report.stages.values()[0].solver, SolverKind::semismooth_newton)
      << "the pivoter's basis is dense";
  const auto on_bump = (z - problem.lower()).array() < 1e-9;
  const auto at_lid = (problem.upper() - z).array() < 1e-9;
  EXPECT_GT(on_bump.count(), 100);
  EXPECT_GT(at_lid.count(), 100);
}

TEST(SparseJacobian, OneSolverTakesEitherKindInTurn) {
  const TestProblem test = problems::nash5();
  const SparseView sparse(*test.problem);
  for (const SolverKind first : {SolverKind::path_newton, SolverKind::semismooth_newton}) {
    SolverChainOptions options;
    options.first = first;
    SolverChain chain(options);
    for (const MixedComplementarityProblem* problem : std::vector<const MixedComplementarityProblem*>{
             test.problem.get(), &sparse, test.problem.get(), &sparse}) {
      VectorXd z = test.starts[0];
      testing::expect_solved(chain.solve(*problem, z), test, z, 1e-10);
    }
  }
}

TEST(SparseJacobian, TheReformulationHasTheDenseJacobian) {
  const TestProblem test = problems::obstacle(4);
  const Index n = test.problem->size();
  FischerBurmeister reformulation;
  reformulation.bind(test.problem->lower(), test.problem->upper(), 0.9);
  for (const VectorXd& z : test.starts) {
    VectorXd f(n);
    MatrixXd jacobian(n, n), h(n, n);
    test.problem->evaluate(z, f, &jacobian);
    reformulation.jacobian(z, f, jacobian, {h.data(), n, n});
    Eigen::SparseMatrix<double> sparse_h;
    reformulation.jacobian(z, f, Eigen::SparseMatrix<double>(jacobian.sparseView()), sparse_h);
    EXPECT_EQ(MatrixXd(sparse_h), h);
  }
}

TEST(NormalEquations, SolveTheRegularisedSystemOfEitherKind) {
  const TestProblem test = problems::obstacle(4);
  const Index n = test.problem->size();
  FischerBurmeister reformulation;
  reformulation.bind(test.problem->lower(), test.problem->upper(), 0.95);
  Iterate at;
  at.z = test.starts[2];
  at.f.resize(n);
  at.phi.resize(n);
  at.jacobian.resize(n, n);
  test.problem->evaluate(at.z, at.f, &at.jacobian);
  reformulation.evaluate(at.z, at.f, at.phi);
  MatrixXd h(n, n);
  reformulation.jacobian(at.z, at.f, at.jacobian, {h.data(), n, n});
  at.sparse_jacobian = at.jacobian.sparseView();
  for (const bool is_sparse : {false, true}) {
    at.is_sparse = is_sparse;
    NormalEquations equations;
    equations.reserve(is_sparse ? 0 : n);
    equations.form(reformulation, at);
    EXPECT_NEAR(equations.matrix_norm(), h.norm(), 1e-12 * h.norm());
    VectorXd step(n);
    ASSERT_TRUE(equations.solve(0.3, step));
    const VectorXd left = h.transpose() * (h * step) + 0.3 * step + h.transpose() * at.phi;
    EXPECT_LE(left.norm(), 1e-12 * (h.transpose() * at.phi).norm());
  }
}

TEST(SparseProximalProblem, AddsWhatTheDenseOneAdds) {
  const TestProblem test = problems::munson1();
  const SparseView view(*test.problem);
  const VectorXd center = Eigen::Vector3d(1, 2, 3);
  const VectorXd z = Eigen::Vector3d(2, 2, 1);
  ProximalProblem dense;
  dense.bind(*test.problem, center, 0.5);
  SparseProximalProblem sparse;
  sparse.bind(view, center, 0.5);
  VectorXd f(3), sparse_f(3);
  MatrixXd jacobian(3, 3), sparse_jacobian(3, 3);
  dense.evaluate(z, f, &jacobian);
  sparse.evaluate(z, sparse_f, &sparse_jacobian);
  EXPECT_EQ(sparse_f, f);
  EXPECT_EQ(sparse_jacobian, jacobian);
  EXPECT_EQ(sparse.row_name(2), "row 2");
}

TEST(SparseColumns, AreThoseOfTheMatrix) {
  const MatrixXd dense = problems::murty_matrix(5);
  const Eigen::SparseMatrix<double> sparse = dense.sparseView();
  const SparseColumns columns(sparse);
  ASSERT_EQ(columns.size(), 5);
  VectorXd column = VectorXd::Constant(5, 7.0);  // entries that are zero are written too
  for (Index j = 0; j < 5; ++j) {
    columns.column(j, column);
    EXPECT_EQ(column, dense.col(j));
  }
}

}  // namespace
}  // namespace touchstone
