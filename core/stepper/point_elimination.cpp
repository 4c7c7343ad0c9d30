#include "core/stepper/point_elimination.h"

#include <cmath>

namespace touchstone {

namespace {

/// Smallest determinant of G, relative to what its entries are compared with, that counts as regular.
constexpr double kRegular = 1e-8;

/// 1x1 or 2x2.
double determinant(const Eigen::Matrix<double, 1, 1>& g) { return g(0, 0); }
double determinant(const Eigen::Matrix<double, 2, 2>& g) { return g(0, 0) * g(1, 1) - g(0, 1) * g(1, 0); }

}  // namespace

template <int Dim>
bool PointElimination<Dim>::factor(const ContactPair<Dim>& pair, const ContactState<Dim>& state,
                                   double length, double h) {
  plane_ = pair.side_2.kind == SideKind::plane;
  length_ = length;
  tangents_ = state.frame.tangents;
  normal_ = state.frame.normal;
  frame_curvature_ = state.frame_curvature;
  chart_ = state.side[1].chart;
  const SideState<Dim>& side_1 = state.side[0];
  gradient_2_ = plane_ ? 1.0 : state.side[1].length;
  for (int i = 0; i < kTangent; ++i) {
    const Matrix<Dim>& turned = state.frame_derivative[static_cast<std::size_t>(i)];
    closeness_by_normal_.row(i) = state.separation.transpose().lazyProduct(turned);
    alignment_by_normal_.row(i) = side_1.normal.transpose().lazyProduct(turned);
  }
  const Vector<Dim>& gradient = side_1.gradients[0];
  along_ = gradient.dot(normal_);
  if (!(std::abs(along_) > kRegular * side_1.length)) return false;
  const Across curvature = tangents_.transpose().lazyProduct(side_1.curvature);
  const Eigen::Matrix<double, 1, kTangent> slope = gradient.transpose().lazyProduct(tangents_) / along_;
  slide_1_ = tangents_ - normal_ * slope;
  alignment_by_u_1_ = curvature.lazyProduct(slide_1_);
  alignment_by_surface_1_ = curvature.lazyProduct(normal_) / along_;
  u_1_by_u_2_.setIdentity();
  Square g;
  if (plane_) {
    g = alignment_by_u_1_;
  } else {
    const Tangents turn = frame_curvature_.lazyProduct(tangents_);
    u_1_by_u_2_ -= closeness_by_normal_.lazyProduct(turn);
    g = alignment_by_u_1_.lazyProduct(u_1_by_u_2_) + alignment_by_normal_.lazyProduct(turn);
  }
  // Curvatures are compared with what the same columns have in the rows of closeness.
  double scale = 1;
  for (int i = 0; i < kTangent; ++i) scale *= std::max(g.col(i).cwiseAbs().maxCoeff(), 1 / length);
  if (!(std::abs(determinant(g)) > kRegular * scale)) return false;
  inverse_ = g.inverse();
  if (!inverse_.allFinite()) return false;
  find_motions(state, h);
  return true;
}

template <int Dim>
void PointElimination<Dim>::find_motions(const ContactState<Dim>& state, double h) {
  using Columns = Eigen::Matrix<double, kTangent, kVelocity>;
  velocities_ = 0;
  carrier_ = -1;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const BodyAtEnd<Dim>& body = state.body[k];
    if (body.column < 0) continue;
    velocities_ += kVelocity;
    ByVelocity rigid;  // dp + dtheta x r
    rigid.template leftCols<Dim>() = h * Matrix<Dim>::Identity();
    rigid.template rightCols<kAngular>() = lever(state.side[k].arm).lazyProduct(body.turn);
    // dN_1, or dn, as the body turns.
    const LeverMatrix<Dim> turned =
        lever(k == 0 ? state.side[0].normal : state.frame.normal).lazyProduct(body.turn);
    Columns u_1 = tangents_.transpose().lazyProduct(rigid);  // less what u_2 adds to it
    if (k == 0) {
      u_1 = -u_1;
    } else {
      u_1.template rightCols<kAngular>() -= closeness_by_normal_.lazyProduct(turned);
    }
    Columns left = -alignment_by_u_1_.lazyProduct(u_1);
    left.template rightCols<kAngular>() -=
        (k == 0 ? Across(tangents_.transpose()) : alignment_by_normal_).lazyProduct(turned);
    const Columns u_2 = inverse_.lazyProduct(left);
    u_1 += u_1_by_u_2_.lazyProduct(u_2);
    const ByVelocity on_body_2 = tangents_.lazyProduct(u_2);
    auto columns = motions_.template middleCols<kVelocity>(body.column);
    columns.template topRows<Dim>() = slide_1_.lazyProduct(u_1);
    columns.template middleRows<Dim>(Dim) = on_body_2;
    columns.template middleRows<Dim>(Dim * static_cast<Eigen::Index>(k)) += rigid;
    if (plane_) {
      columns.template bottomRows<Dim>().setZero();
    } else {
      columns.template bottomRows<Dim>() = frame_curvature_.lazyProduct(on_body_2);
    }
    if (k == 0) continue;
    columns.template bottomRightCorner<Dim, kAngular>() += turned;
    if (!plane_) continue;
    carrier_ = body.column;
    carried_ = rigid;
  }
}

template <int Dim>
auto PointElimination<Dim>::motion_of(const double* rows) const -> Motion {
  const Few closeness = length_ * Eigen::Map<const Few>(rows);
  const Few alignment = Eigen::Map<const Few>(rows + kTangent);
  const double surface_1 = length_ * rows[2 * kTangent];
  Vector<Dim> along = Vector<Dim>::Zero();  // of body 2's point, along n, and what that does to n
  Vector<Dim> turned = Vector<Dim>::Zero();
  if (!plane_) {
    along = length_ * rows[2 * kTangent + 1] / gradient_2_ * normal_;
    turned = frame_curvature_ * along;
  }
  Few u_1 = closeness - closeness_by_normal_ * turned;
  const Few left = alignment - alignment_by_u_1_ * u_1 - surface_1 * alignment_by_surface_1_ -
                   alignment_by_normal_ * turned;
  const Few u_2 = inverse_ * left;
  u_1 += u_1_by_u_2_ * u_2;
  Motion motion;
  motion.template head<Dim>() = slide_1_ * u_1 + surface_1 / along_ * normal_;
  const Vector<Dim> across = tangents_ * u_2;
  motion.template segment<Dim>(Dim) = across + along;
  motion.template tail<Dim>().setZero();
  if (!plane_) motion.template tail<Dim>() = frame_curvature_ * across + turned;
  return motion;
}

template <int Dim>
void PointElimination<Dim>::read_unknowns(const Motion& rest, const double* velocities,
                                          double* unknowns) const {
  using Eigen::Map;
  const Map<const Eigen::VectorXd> nu(velocities, velocities_);
  Eigen::Matrix<double, 2 * Dim, 1> points = rest.template head<2 * Dim>();
  for (Eigen::Index c = 0; c < velocities_; ++c) points += nu[c] * motions_.col(c).template head<2 * Dim>();
  Map<Vector<Dim>>{unknowns} = points.template head<Dim>();
  Vector<Dim> second = points.template tail<Dim>();
  if (!plane_) {
    Map<Vector<Dim>>{unknowns + Dim} = second;
    return;
  }
  if (carrier_ >= 0) second -= carried_ * nu.template segment<kVelocity>(carrier_);
  Map<Vector<kTangent>>{unknowns + Dim} = chart_.transpose() * second;
}

template class PointElimination<2>;
template class PointElimination<3>;

}  // namespace touchstone
