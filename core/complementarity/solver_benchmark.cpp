// Time of one solve by problem size: Lemke's method on linear complementarity problems with a positive
// definite matrix, the two Newton methods on the same with a cubic term. Seeds are fixed; every solve starts
// from z = 0.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <limits>
#include <random>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"

namespace touchstone {
namespace {

/// 0 <= z _|_ M z + q + c z^3 >= 0, M positive definite and not symmetric, about half of the z positive at
/// the solution.
class CubicProblem final : public MixedComplementarityProblem {
 public:
  CubicProblem(Eigen::Index n, double cubic)
      : lower_(Eigen::VectorXd::Zero(n)),
        upper_(Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity())),
        cubic_(cubic) {
    std::mt19937_64 random(static_cast<std::uint64_t>(n));
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(n, n, draw) / std::sqrt(static_cast<double>(n));
    const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(n, n, draw) / std::sqrt(static_cast<double>(n));
    m_ = a * a.transpose() + 0.5 * (b - b.transpose()) + 0.1 * Eigen::MatrixXd::Identity(n, n);
    q_ = Eigen::VectorXd::NullaryExpr(n, draw);
  }
  [[nodiscard]] Eigen::Index size() const override { return q_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    f.noalias() = m_ * z;
    f += q_;
    f.array() += cubic_ * z.array().cube();
    if (jacobian == nullptr) return;
    *jacobian = m_;
    jacobian->diagonal().array() += 3 * cubic_ * z.array().square();
  }
  [[nodiscard]] const Eigen::MatrixXd& m() const { return m_; }
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }

 private:
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  double cubic_;
  Eigen::MatrixXd m_;
  Eigen::VectorXd q_;
};

void lemke(benchmark::State& state) {
  const CubicProblem problem(state.range(0), 0.0);
  LinearPath path;
  Eigen::VectorXd z(problem.size());
  int pivots = 0;
  for (auto _ : state) {
    const LinearPathResult result = path.lemke(problem.m(), problem.q(), z);
    if (!result.solved()) state.SkipWithError("not solved");
    pivots = result.pivots;
  }
  state.counters["pivots"] = pivots;
}

template <typename Solver>
void newton(benchmark::State& state) {
  const CubicProblem problem(state.range(0), 1.0);
  Solver solver;
  Eigen::VectorXd z(problem.size());
  int iterations = 0;
  for (auto _ : state) {
    z.setZero();
    const SolveReport report = solver.solve(problem, z);
    if (!report.solved()) state.SkipWithError("not solved");
    iterations = report.iterations;
  }
  state.counters["iterations"] = iterations;
}

BENCHMARK(lemke)->RangeMultiplier(2)->Range(4, 256);
BENCHMARK(newton<PathNewton>)->Name("path_newton")->RangeMultiplier(2)->Range(4, 256);
BENCHMARK(newton<SemismoothNewton>)->Name("semismooth_newton")->RangeMultiplier(2)->Range(4, 256);

}  // namespace
}  // namespace touchstone

BENCHMARK_MAIN();
