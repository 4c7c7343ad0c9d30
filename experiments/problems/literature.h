#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/complementarity/problem.h"
#include "core/complementarity/sparse_problem.h"

namespace touchstone::problems {

/// A problem whose F and Jacobian are a function object; z >= 0 unless bounds are given.
class FunctionProblem final : public MixedComplementarityProblem {
 public:
  using Function = std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&, Eigen::MatrixXd*)>;

  FunctionProblem(Eigen::Index n, Function function);
  FunctionProblem(Eigen::VectorXd lower, Eigen::VectorXd upper, Function function);

  [[nodiscard]] Eigen::Index size() const override { return lower_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    function_(z, f, jacobian);
  }

 private:
  Eigen::VectorXd lower_, upper_;
  Function function_;
};

/// F(z) = M z + q with a sparse M.
class SparseLinearProblem final : public SparseComplementarityProblem {
 public:
  SparseLinearProblem(Eigen::VectorXd lower, Eigen::VectorXd upper, Matrix m, Eigen::VectorXd q);

  [[nodiscard]] Eigen::Index size() const override { return q_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate_sparse(const Eigen::VectorXd& z, Eigen::VectorXd& f, Matrix* jacobian) const override;
  [[nodiscard]] const Matrix& m() const { return m_; }
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }

 private:
  Eigen::VectorXd lower_, upper_, q_;
  Matrix m_;
};

/// F(z) = M z + q.
[[nodiscard]] FunctionProblem::Function linear(Eigen::MatrixXd m, Eigen::VectorXd q);

/// A named problem with starts, and its solutions where they are known: all of them, or one of many.
struct TestProblem {
  std::string name;
  std::shared_ptr<const FunctionProblem> problem;
  std::vector<Eigen::VectorXd> starts;
  std::vector<Eigen::VectorXd> solutions;
  bool solutions_are_all = true;
  bool linear = false;               ///< F is M z + q
  double solution_tolerance = 1e-6;  ///< how well the listed solutions are known
};

// Kojima & Shindo 1986, Josephy 1979, Billups 1995, Murphy, Sherali & Soyster 1982, as in MCPLIB (Dirkse &
// Ferris 1995), and small linear problems of the literature.
[[nodiscard]] TestProblem kojshin();
[[nodiscard]] TestProblem josephy();
[[nodiscard]] TestProblem billups();
[[nodiscard]] TestProblem munson1();
[[nodiscard]] TestProblem path4();
[[nodiscard]] TestProblem nash10();
[[nodiscard]] TestProblem nash5();
/// Murty 1978: Lemke's method with covering vector 1 needs 2^n pivots for murty_q(n).
[[nodiscard]] Eigen::MatrixXd murty_matrix(Eigen::Index n);
[[nodiscard]] Eigen::VectorXd murty_q(Eigen::Index n);
[[nodiscard]] TestProblem murty(Eigen::Index n);
[[nodiscard]] TestProblem bimatrix();
[[nodiscard]] TestProblem ones2();
/// A membrane on the unit square, `side`^2 inner nodes of a grid, between a bump below and a lid above.
[[nodiscard]] TestProblem obstacle(Eigen::Index side);
/// The same with its five entries a row.
[[nodiscard]] SparseLinearProblem sparse_obstacle(Eigen::Index side);

/// Two equations that tell the same of x and nothing of y, consistent at x = 1 and, beyond the first order,
/// only there: the Jacobian is singular everywhere.
[[nodiscard]] TestProblem undetermined();

/// All of the above, the obstacle at a small size.
[[nodiscard]] std::vector<TestProblem> all_problems();

}  // namespace touchstone::problems
