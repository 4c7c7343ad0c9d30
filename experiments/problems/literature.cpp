#include "experiments/problems/literature.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

namespace touchstone::problems {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

VectorXd vec(std::initializer_list<double> values) {
  VectorXd v(static_cast<Index>(values.size()));
  Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

// F2 has `b` x3, F3 has `c` x4 - `d`: the two problems differ in these alone.
FunctionProblem::Function kojima_shindo(double b, double c, double d) {
  return [b, c, d](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
    const double x1 = x[0];
    const double x2 = x[1];
    f[0] = 3 * x1 * x1 + 2 * x1 * x2 + 2 * x2 * x2 + x[2] + 3 * x[3] - 6;
    f[1] = 2 * x1 * x1 + x1 + x2 * x2 + b * x[2] + 2 * x[3] - 2;
    f[2] = 3 * x1 * x1 + x1 * x2 + 2 * x2 * x2 + 2 * x[2] + c * x[3] - d;
    f[3] = x1 * x1 + 3 * x2 * x2 + 2 * x[2] + 3 * x[3] - 3;
    if (jacobian == nullptr) return;
    *jacobian << 6 * x1 + 2 * x2, 2 * x1 + 4 * x2, 1, 3,  //
        4 * x1 + 1, 2 * x2, b, 2,                         //
        6 * x1 + x2, x1 + 4 * x2, 2, c,                   //
        2 * x1, 6 * x2, 2, 3;
  };
}

std::vector<VectorXd> kojima_shindo_starts() {
  return {vec({0, 0, 0, 0}), vec({1, 1, 1, 1}), vec({100, 100, 100, 100}), vec({1, 0, 1, 0}),
          vec({1, 0, 0, 0}), vec({0, 1, 1, 0}), vec({1.25, 0, 0, 0.5})};
}

TestProblem make(std::string name, FunctionProblem problem, std::vector<VectorXd> starts,
                 std::vector<VectorXd> solutions) {
  return {std::move(name), std::make_shared<const FunctionProblem>(std::move(problem)), std::move(starts),
          std::move(solutions)};
}

TestProblem make_linear(std::string name, FunctionProblem problem, std::vector<VectorXd> starts,
                        std::vector<VectorXd> solutions) {
  TestProblem test = make(std::move(name), std::move(problem), std::move(starts), std::move(solutions));
  test.linear = true;
  return test;
}

// Cournot equilibrium of Murphy, Sherali & Soyster 1982: marginal cost less marginal revenue of each firm.
FunctionProblem::Function nash(double scale, double gamma, const VectorXd& c, const VectorXd& beta) {
  return [=](const VectorXd& q, VectorXd& f, MatrixXd* jacobian) {
    const double total = q.sum();
    const double price = std::pow(5000.0 / total, 1.0 / gamma);
    const double slope = -price / (gamma * total);
    const double curvature = -slope * (1.0 + 1.0 / gamma) / total;
    for (Index i = 0; i < q.size(); ++i) {
      const double cost = std::pow(scale * q[i], 1.0 / beta[i]);
      f[i] = c[i] + cost - price - q[i] * slope;
      if (jacobian == nullptr) continue;
      for (Index j = 0; j < q.size(); ++j) (*jacobian)(i, j) = -slope - q[i] * curvature;
      (*jacobian)(i, i) += scale * std::pow(scale * q[i], 1.0 / beta[i] - 1.0) / beta[i] - slope;
    }
  };
}

}  // namespace

FunctionProblem::FunctionProblem(Index n, Function function)
    : FunctionProblem(VectorXd::Zero(n), VectorXd::Constant(n, infinity), std::move(function)) {}

FunctionProblem::FunctionProblem(VectorXd lower, VectorXd upper, Function function)
    : lower_(std::move(lower)), upper_(std::move(upper)), function_(std::move(function)) {}

SparseLinearProblem::SparseLinearProblem(VectorXd lower, VectorXd upper, Matrix m, VectorXd q)
    : lower_(std::move(lower)), upper_(std::move(upper)), q_(std::move(q)), m_(std::move(m)) {}

void SparseLinearProblem::evaluate_sparse(const VectorXd& z, VectorXd& f, Matrix* jacobian) const {
  f = q_;
  f += m_ * z;
  if (jacobian != nullptr) *jacobian = m_;
}

FunctionProblem::Function linear(MatrixXd m, VectorXd q) {
  return [m = std::move(m), q = std::move(q)](const VectorXd& z, VectorXd& f, MatrixXd* jacobian) {
    f.noalias() = m * z;
    f += q;
    if (jacobian != nullptr) *jacobian = m;
  };
}

TestProblem kojshin() {
  return make("kojshin", {4, kojima_shindo(10, 9, 9)}, kojima_shindo_starts(),
              {vec({std::sqrt(6.0) / 2, 0, 0, 0.5}), vec({1, 0, 3, 0})});
}

TestProblem josephy() {
  return make("josephy", {4, kojima_shindo(3, 3, 1)}, kojima_shindo_starts(),
              {vec({std::sqrt(6.0) / 2, 0, 0, 0.5})});
}

TestProblem billups() {
  const auto function = [](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
    f[0] = (x[0] - 1) * (x[0] - 1) - 1.01;
    if (jacobian != nullptr) (*jacobian)(0, 0) = 2 * (x[0] - 1);
  };
  return make("billups", {1, function}, {vec({0}), vec({0.5}), vec({0.89}), vec({1}), vec({1.5}), vec({10})},
              {vec({1 + std::sqrt(1.01)})});
}

TestProblem munson1() {
  MatrixXd m(3, 3);
  m << 1, 2, 3, 0, 1, -1, 1, 1, 0;
  return make_linear("munson1", {3, linear(m, vec({-1, 1, 1}))},
                     {vec({0, 0, 0}), vec({1, 1, 1}), vec({0, 10, 0}), vec({0, 0, 10})}, {vec({1, 0, 0})});
}

TestProblem path4() {
  MatrixXd m(4, 4);
  m << 0, 0, -1, -1, 0, 0, 1, -2, 1, -1, 2, -2, 1, 2, -2, 4;
  return make_linear("path4", {4, linear(m, vec({2, 2, -2, -6}))},
                     {vec({0, 0, 0, 0}), vec({1, 1, 1, 1}), vec({10, 0, 10, 0}), vec({100, 100, 100, 100})},
                     {vec({2.8, 0, 0.8, 1.2})});
}

TestProblem nash10() {
  const VectorXd c = vec({5, 3, 8, 5, 1, 3, 7, 4, 6, 3});
  const VectorXd beta = vec({1.2, 1, .9, .6, 1.5, 1, .7, 1.1, .95, .75});
  TestProblem test = make("nash10", {10, nash(10, 1.2, c, beta)},
                          {VectorXd::Constant(10, 1), VectorXd::Constant(10, 10), VectorXd::Constant(10, 100),
                           vec({7, 4, 3, 1, 18, 4, 1, 6, 3, 2}), vec({10, 9, 8, 7, 6, 5, 4, 3, 2, 1})},
                          {vec({7.441547, 4.097810, 2.590644, 0.935386, 17.948952, 4.097810, 1.304726,
                                5.590083, 3.222179, 1.677094})});
  test.solution_tolerance = 1e-6;
  return test;
}

TestProblem nash5() {
  TestProblem test = make("nash5", {5, nash(5, 1.1, vec({10, 8, 6, 4, 2}), vec({1.2, 1.1, 1, .9, .8}))},
                          {VectorXd::Constant(5, 1), VectorXd::Constant(5, 10), VectorXd::Constant(5, 100),
                           vec({15, 12, 10, 7, 5}), vec({1, 2, 3, 4, 5})},
                          {vec({15.429308, 12.498582, 9.663473, 7.165094, 5.132566})});
  test.solution_tolerance = 1e-6;
  return test;
}

MatrixXd murty_matrix(Index n) {
  MatrixXd m = MatrixXd::Identity(n, n);
  m.triangularView<Eigen::StrictlyLower>().setConstant(2.0);
  return m;
}

VectorXd murty_q(Index n) {
  VectorXd q(n);
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) {
    sum += std::ldexp(1.0, static_cast<int>(n - i));
    q[i] = -sum;
  }
  return q;
}

TestProblem murty(Index n) {
  VectorXd solution = VectorXd::Zero(n);
  solution[0] = 1.0;
  return make_linear("murty" + std::to_string(n), {n, linear(murty_matrix(n), VectorXd::Constant(n, -1))},
                     {VectorXd::Zero(n), VectorXd::Ones(n), VectorXd::Constant(n, 10)}, {solution});
}

TestProblem bimatrix() {
  MatrixXd m = MatrixXd::Zero(4, 4);
  m.topRightCorner(2, 2) << 10, 30, 20, 15;
  m.bottomLeftCorner(2, 2) = m.topRightCorner(2, 2).transpose().eval();
  return make_linear("bimatrix", {4, linear(m, VectorXd::Constant(4, -1))},
                     {VectorXd::Zero(4), VectorXd::Ones(4), vec({0.1, 0, 0.1, 0}), vec({0, 1, 0, 1})},
                     {vec({0.1, 0, 0.1, 0}), vec({0, 1.0 / 15, 0, 1.0 / 15}),
                      vec({1.0 / 90, 2.0 / 45, 1.0 / 30, 1.0 / 45})});
}

TestProblem ones2() {
  TestProblem test = make_linear("ones2", {2, linear(MatrixXd::Ones(2, 2), VectorXd::Constant(2, -1))},
                                 {vec({0, 0}), vec({1, 1}), vec({0.3, 0.2}), vec({100, 0}), vec({0.3, 0.7})},
                                 {vec({0.5, 0.5})});
  test.solutions_are_all = false;  // all of the segment z1 + z2 = 1
  return test;
}

SparseLinearProblem sparse_obstacle(Index side) {
  const Index n = side * side;
  const double h = 1.0 / static_cast<double>(side + 1);
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd lower(n);
  for (Index row = 0; row < side; ++row) {
    for (Index column = 0; column < side; ++column) {
      const Index i = row * side + column;
      entries.emplace_back(i, i, 4.0);
      if (row > 0) entries.emplace_back(i, i - side, -1.0);
      if (row + 1 < side) entries.emplace_back(i, i + side, -1.0);
      if (column > 0) entries.emplace_back(i, i - 1, -1.0);
      if (column + 1 < side) entries.emplace_back(i, i + 1, -1.0);
      const double x = 3.2 * static_cast<double>(column + 1) * h;
      const double y = 3.2 * static_cast<double>(row + 1) * h;
      lower[i] = std::max(std::sin(x) * std::sin(y), 0.0) * std::max(std::sin(x) * std::sin(y), 0.0);
    }
  }
  SparseLinearProblem::Matrix m(n, n);
  m.setFromTriplets(entries.begin(), entries.end());
  const VectorXd upper = (lower.array() + 0.9).min(1.05);
  // A load that lifts the membrane to the lid near one corner and lets it sag onto the bump elsewhere.
  VectorXd q(n);
  for (Index i = 0; i < n; ++i) q[i] = h * h * (i % side < side / 2 ? -80.0 : 20.0);
  return {lower, upper, m, q};
}

TestProblem obstacle(Index side) {
  const SparseLinearProblem sparse = sparse_obstacle(side);
  const VectorXd& lower = sparse.lower();
  const VectorXd& upper = sparse.upper();
  return make_linear("obstacle" + std::to_string(side * side),
                     {lower, upper, linear(MatrixXd(sparse.m()), sparse.q())},
                     {lower, upper, 0.5 * (lower + upper), VectorXd::Zero(side * side)}, {});
}

TestProblem undetermined() {
  const auto function = [](const VectorXd& z, VectorXd& f, MatrixXd* jacobian) {
    const double x = z[0] - 1.0;
    f[0] = x + 0.1 * x * x;
    f[1] = 2.0 * x + 0.5 * x * x;
    if (jacobian != nullptr) *jacobian << 1.0 + 0.2 * x, 0.0, 2.0 + x, 0.0;
  };
  TestProblem test =
      make("undetermined", {VectorXd::Constant(2, -infinity), VectorXd::Constant(2, infinity), function},
           {vec({1.5, 7}), vec({0.5, -3}), vec({1, 0})}, {vec({1, 7})});
  test.solutions_are_all = false;  // y is anything
  return test;
}

std::vector<TestProblem> all_problems() {
  return {kojshin(), josephy(), billups(),  munson1(), path4(),     nash10(),
          nash5(),   murty(8),  bimatrix(), ones2(),   obstacle(8), undetermined()};
}

}  // namespace touchstone::problems
