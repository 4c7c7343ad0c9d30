#include "core/complementarity/fischer_burmeister.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace touchstone {

using Eigen::Index;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// phi(a, b) with its derivatives.
struct Phi {
  double value = 0.0;
  double by_a = 0.0;
  double by_b = 0.0;
};

double value_of(double a, double b, double weight) {
  const double root = std::sqrt(a * a + b * b);
  // For a + b > 0 the difference cancels; this is the same without.
  const double fischer = a + b > 0.0 ? 2.0 * a * b / (a + b + root) : a + b - root;
  if (weight == 1.0) return fischer;
  return weight * fischer + (1.0 - weight) * std::max(a, 0.0) * std::max(b, 0.0);
}

Phi phi_of(double a, double b, double weight) {
  Phi phi;
  phi.value = value_of(a, b, weight);
  const double root = std::sqrt(a * a + b * b);
  // At the kink, where every (1 - x, 1 - y) with x^2 + y^2 = 1 is a limit of gradients: the one between the
  // two branches.
  const double x = root > 0.0 ? a / root : std::sqrt(0.5);
  const double y = root > 0.0 ? b / root : std::sqrt(0.5);
  phi.by_a = weight * (1.0 - x);
  phi.by_b = weight * (1.0 - y);
  if (a > 0.0 && b > 0.0) {
    phi.by_a += (1.0 - weight) * b;
    phi.by_b += (1.0 - weight) * a;
  }
  return phi;
}

// -phi(u - z, -F): the derivatives by z and F come out as those of phi by its own arguments.
Phi upper_phi(double z, double f, double upper, double weight) {
  Phi phi = phi_of(upper - z, -f, weight);
  phi.value = -phi.value;
  return phi;
}

}  // namespace

void FischerBurmeister::bind(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double weight) {
  assert(lower.size() == upper.size());
  lower_ = &lower;
  upper_ = &upper;
  weight_ = weight;
  by_z_.resize(lower.size());
  by_f_.resize(lower.size());
}

void FischerBurmeister::evaluate(const Eigen::VectorXd& z, const Eigen::VectorXd& f,
                                 Eigen::VectorXd& phi) const {
  for (Index i = 0; i < z.size(); ++i) {
    const double lower = (*lower_)[i];
    const double upper = (*upper_)[i];
    double value = f[i];
    if (upper < infinity) value = -value_of(upper - z[i], -value, weight_);
    if (lower > -infinity) value = value_of(z[i] - lower, value, weight_);
    phi[i] = value;
  }
}

// The two diagonal matrices of H.
void FischerBurmeister::find_slopes(const Eigen::VectorXd& z, const Eigen::VectorXd& f) {
  for (Index i = 0; i < z.size(); ++i) {
    Phi inner{f[i], 0.0, 1.0};
    if ((*upper_)[i] < infinity) inner = upper_phi(z[i], f[i], (*upper_)[i], weight_);
    by_z_[i] = inner.by_a;
    by_f_[i] = inner.by_b;
    if ((*lower_)[i] > -infinity) {
      const Phi outer = phi_of(z[i] - (*lower_)[i], inner.value, weight_);
      by_z_[i] = outer.by_a + outer.by_b * inner.by_a;
      by_f_[i] = outer.by_b * inner.by_b;
    }
  }
}

void FischerBurmeister::jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& f,
                                 const Eigen::SparseMatrix<double>& jacobian,
                                 Eigen::SparseMatrix<double>& h) {
  find_slopes(z, f);
  Eigen::SparseMatrix<double> diagonal(z.size(), z.size());
  diagonal = by_z_.asDiagonal();
  h = by_f_.asDiagonal() * jacobian;
  h += diagonal;
}

void FischerBurmeister::jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& f,
                                 const Eigen::MatrixXd& jacobian, Eigen::Map<Eigen::MatrixXd> h) {
  find_slopes(z, f);
  const Index n = z.size();
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) h(i, j) = by_f_[i] * jacobian(i, j);
    h(j, j) += by_z_[j];
  }
}

}  // namespace touchstone
