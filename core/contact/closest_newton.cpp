#include "core/contact/closest_newton.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/surfaces/active_set.h"

namespace touchstone {

namespace {

/// One body's half of the conditions, in world axes.
template <int Dim>
class ActiveSide {
 public:
  using Values = typename ActiveSet<Dim>::Values;

  ActiveSide(const StandingBody<Dim>& body, const Vector<Dim>& point, const Vector<Dim>& outward,
             double slack)
      : body_(body), set_(body.surface(), body.to_body(point), body.turned_to_body(outward), slack) {}

  [[nodiscard]] int size() const { return set_.size(); }
  [[nodiscard]] Vector<Dim> a() const { return body_.to_world(set_.x()); }
  [[nodiscard]] const Values& values() const { return set_.values(); }
  [[nodiscard]] Vector<Dim> normal() const { return body_.rotation() * set_.normal(); }
  [[nodiscard]] typename ActiveSet<Dim>::Gradients gradients() const {
    return body_.rotation() * set_.gradients();
  }
  [[nodiscard]] Matrix<Dim> hessian() const {
    return body_.rotation() * set_.hessian() * body_.rotation().transpose();
  }

  /// @return true if the active set changed
  bool move(const Vector<Dim>& da, const Values& dl) {
    constexpr double kOutside = 1e-13;  // over size
    set_.move(body_.turned_to_body(da), dl);
    const bool changed = set_.exchange(kOutside * body_.surface().bounding_ball().radius);
    set_.update();
    return changed;
  }

 private:
  const StandingBody<Dim>& body_;
  ActiveSet<Dim> set_;
};

/// The conditions at one point of the iteration. Lengths are divided by the pair's size.
template <int Dim>
class Conditions {
 public:
  static constexpr int kLargest = 4 * Dim + 1;
  using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kLargest, 1>;
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kLargest, kLargest>;

  Conditions(const ActiveSide<Dim>& side_1, const ActiveSide<Dim>& side_2, double psi, double unit)
      : side_1_(side_1), side_2_(side_2), psi_(psi / unit), unit_(unit) {}

  /// Solves for the changes of a_1, a_2, psi, l of body 1, l of body 2, lengths over `unit`.
  [[nodiscard]] Unknowns newton_step() const {
    const int n_1 = side_1_.size();
    const int n_2 = side_2_.size();
    const int size = 2 * Dim + 1 + n_1 + n_2;
    const Vector<Dim> n = side_2_.normal();
    const Matrix<Dim> h_1 = unit_ * side_1_.hessian();
    const Matrix<Dim> h_2 = unit_ * side_2_.hessian();
    const auto g_1 = side_1_.gradients();
    const auto g_2 = side_2_.gradients();
    const int l_1 = 2 * Dim + 1;
    const int l_2 = l_1 + n_1;
    Unknowns f(size);
    Jacobian j = Jacobian::Zero(size, size);

    f.template head<Dim>() = (side_1_.a() - side_2_.a()) / unit_ - psi_ * n;
    j.template block<Dim, Dim>(0, 0).setIdentity();
    j.template block<Dim, Dim>(0, Dim) = -Matrix<Dim>::Identity() - psi_ * h_2;
    j.template block<Dim, 1>(0, 2 * Dim) = -n;
    j.block(0, l_2, Dim, n_2) = -psi_ * g_2;

    f.template segment<Dim>(Dim) = side_1_.normal() + n;
    j.template block<Dim, Dim>(Dim, 0) = h_1;
    j.template block<Dim, Dim>(Dim, Dim) = h_2;
    j.block(Dim, l_1, Dim, n_1) = g_1;
    j.block(Dim, l_2, Dim, n_2) = g_2;

    f[2 * Dim] = 0.5 * (n.squaredNorm() - 1);
    j.template block<1, Dim>(2 * Dim, Dim) = n.transpose() * h_2;
    j.block(2 * Dim, l_2, 1, n_2) = n.transpose() * g_2;

    f.segment(l_1, n_1) = side_1_.values() / unit_;
    j.block(l_1, 0, n_1, Dim) = g_1.transpose();
    f.segment(l_2, n_2) = side_2_.values() / unit_;
    j.block(l_2, Dim, n_2, Dim) = g_2.transpose();

    return -solve_equilibrated(j, f);
  }

 private:
  /// Solves J x = f with rows and columns scaled to one size: a needle's curvature and a floor's flatness are
  /// many decades apart. A pivoted QR leaves what the rows do not determine (flat on flat) at 0.
  static Unknowns solve_equilibrated(Jacobian& j, Unknowns& f) {
    constexpr double kSingular = 1e-13;
    for (Eigen::Index row = 0; row < j.rows(); ++row) {
      const double largest = j.row(row).cwiseAbs().maxCoeff();
      if (!(largest > 0)) continue;
      j.row(row) /= largest;
      f[row] /= largest;
    }
    Unknowns scale(j.cols());
    for (Eigen::Index column = 0; column < j.cols(); ++column) {
      const double largest = j.col(column).cwiseAbs().maxCoeff();
      scale[column] = largest > 0 ? 1 / largest : 1.0;
      j.col(column) *= scale[column];
    }
    Eigen::ColPivHouseholderQR<Jacobian> qr(j.rows(), j.cols());
    qr.setThreshold(kSingular);
    return scale.cwiseProduct(qr.compute(j).solve(f));
  }

  const ActiveSide<Dim>& side_1_;
  const ActiveSide<Dim>& side_2_;
  double psi_;
  double unit_;
};

/// Applies a Newton step, or the part of it that the linear model can be trusted with.
/// @return true if an active set changed
template <int Dim>
bool apply(const typename Conditions<Dim>::Unknowns& change, double unit, ActiveSide<Dim>& side_1,
           ActiveSide<Dim>& side_2, double& psi) {
  constexpr double kLongest = 0.3;  // over the bodies' size
  const double longest = change.template head<2 * Dim>().cwiseAbs().maxCoeff();
  const double t = longest > kLongest ? kLongest / longest : 1.0;
  psi += t * unit * change[2 * Dim];
  const int n_1 = side_1.size();
  const bool changed_1 =
      side_1.move(t * unit * change.template head<Dim>(), t * change.segment(2 * Dim + 1, n_1));
  const bool changed_2 =
      side_2.move(t * unit * change.template segment<Dim>(Dim), t * change.tail(side_2.size()));
  return changed_1 || changed_2;
}

}  // namespace

template <int Dim>
double defect(const BodyPair<Dim>& bodies, const Candidate<Dim>& candidate) {
  const Vector<Dim> d = candidate.a_1 - candidate.a_2;
  const double psi = candidate.normal.dot(d);
  const double off_normal = (d - psi * candidate.normal).norm();
  const double outside = std::max(bodies.body_1.outside(candidate.a_1), bodies.body_2.outside(candidate.a_2));
  return std::max({off_normal, outside, std::abs(psi - bodies.separation(candidate.normal))});
}

template <int Dim>
double closest_newton(const BodyPair<Dim>& bodies, double slack, Candidate<Dim>& candidate) {
  constexpr int kMaximumSteps = 30;
  constexpr double kSmall = 1e-9;  // motion, over size, that shrinks quadratically or is rounding ...
  constexpr double kLevel = 0.1;   // ... if all changes together do not shrink to this
  ActiveSide<Dim> side_1(bodies.body_1, candidate.a_1, -candidate.normal, slack);
  ActiveSide<Dim> side_2(bodies.body_2, candidate.a_2, candidate.normal, slack);
  double psi = candidate.gap();
  double last = std::numeric_limits<double>::infinity();  // change, with the same active inequalities
  for (int step = 0; step < kMaximumSteps && side_1.size() > 0 && side_2.size() > 0; ++step) {
    const auto change = Conditions<Dim>(side_1, side_2, psi, bodies.size).newton_step();
    if (!change.allFinite()) break;
    const bool exchanged = apply<Dim>(change, bodies.size, side_1, side_2, psi);
    const double changed = change.norm();
    if (change.template head<2 * Dim>().norm() <= kSmall && changed >= kLevel * last) break;
    last = exchanged ? std::numeric_limits<double>::infinity() : changed;
  }
  const double start = defect(bodies, candidate);
  const Candidate<Dim> reached{side_1.a(), side_2.a(), side_2.normal().normalized()};
  // A search that ends with multipliers of 0 has no normal, and nothing would be missed by it.
  constexpr double kUnit = 1e-3;
  const bool has_normal = std::abs(reached.normal.norm() - 1) < kUnit;
  const double end = has_normal ? defect(bodies, reached) : start;
  if (end < start) candidate = reached;
  return std::min(start, end);
}

template double defect(const BodyPair<2>&, const Candidate<2>&);
template double defect(const BodyPair<3>&, const Candidate<3>&);
template double closest_newton(const BodyPair<2>&, double, Candidate<2>&);
template double closest_newton(const BodyPair<3>&, double, Candidate<3>&);

}  // namespace touchstone
