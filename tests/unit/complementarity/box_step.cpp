#include "tests/unit/complementarity/box_step.h"

#include <cmath>
#include <limits>
#include <unsupported/Eigen/AutoDiff>

namespace touchstone::testing {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double g = 9.81;  // [m/s^2]

using Derivatives = Eigen::Matrix<double, BoxStep::unknowns, 1>;
using Dual = Eigen::AutoDiffScalar<Derivatives>;

}  // namespace

BoxStep::BoxStep(const BoxScene& scene, const BoxState& state)
    : scene_(scene),
      state_(state),
      lower_(VectorXd::Zero(unknowns)),
      upper_(VectorXd::Constant(unknowns, infinity)) {
  lower_.head(5).setConstant(-infinity);
  lower_[10] = -infinity;
}

Vector2d BoxStep::gravity() const { return {g * std::sin(scene_.slope), -g * std::cos(scene_.slope)}; }

double BoxStep::inertia() const { return scene_.mass * scene_.half_extents.squaredNorm() / 3.0; }

template <typename Scalar>
void BoxStep::rows(const Eigen::Matrix<Scalar, unknowns, 1>& z, Eigen::Matrix<Scalar, unknowns, 1>& f) const {
  using std::cos;
  using std::sin;
  using Vector = Eigen::Matrix<Scalar, 2, 1>;
  const double h = scene_.h;
  const Vector center{state_.q[0] + h * z[0], state_.q[1] + h * z[1]};
  const Scalar angle = state_.q[2] + h * z[2];
  const Scalar c = cos(angle);
  const Scalar s = sin(angle);
  const Vector arm{z[3] - center[0], z[4] - center[1]};
  const Vector body{c * arm[0] + s * arm[1], -s * arm[0] + c * arm[1]};
  const Scalar& p_n = z[9];
  const Scalar& p_t = z[10];
  const Vector2d applied = h * scene_.mass * gravity();
  f[0] = scene_.mass * (z[0] - state_.nu[0]) - applied[0] - p_t;
  f[1] = scene_.mass * (z[1] - state_.nu[1]) - applied[1] - p_n;
  f[2] = inertia() * (z[2] - state_.nu[2]) - (arm[0] * p_n - arm[1] * p_t);
  // Faces in the order +x, -x, +y, -y of the body.
  const Scalar along_x = z[5] - z[6];
  const Scalar along_y = z[7] - z[8];
  f[3] = c * along_x - s * along_y;
  f[4] = s * along_x + c * along_y + 1.0;
  f[5] = scene_.half_extents[0] - body[0];
  f[6] = scene_.half_extents[0] + body[0];
  f[7] = scene_.half_extents[1] - body[1];
  f[8] = scene_.half_extents[1] + body[1];
  f[9] = z[4];
  // p_t = projection of p_t - rho v_t onto [-mu p_n, mu p_n], rho = m.
  const Scalar slip = z[0] - arm[1] * z[2];
  const Scalar target = p_t - scene_.mass * slip;
  const Scalar limit = scene_.mu * p_n;
  Scalar projected = target;
  if (target > limit) projected = limit;
  if (target < -limit) projected = -limit;
  f[10] = p_t - projected;
}

void BoxStep::evaluate(const VectorXd& z, VectorXd& f, Eigen::MatrixXd* jacobian) const {
  if (jacobian == nullptr) {
    Derivatives values;
    rows<double>(z, values);
    f = values;
    return;
  }
  Eigen::Matrix<Dual, unknowns, 1> dual_z;
  Eigen::Matrix<Dual, unknowns, 1> dual_f;
  for (Index i = 0; i < unknowns; ++i) dual_z[i] = Dual(z[i], unknowns, static_cast<int>(i));
  rows<Dual>(dual_z, dual_f);
  for (Index i = 0; i < unknowns; ++i) {
    f[i] = dual_f[i].value();
    jacobian->row(i) = dual_f[i].derivatives().transpose();
  }
}

VectorXd BoxStep::predicted_start() const {
  VectorXd z = VectorXd::Zero(unknowns);
  z.head(3) = state_.nu;
  z.head(2) += scene_.h * gravity();
  const double angle = state_.q[2] + scene_.h * z[2];
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  // The face normal that has the largest component downwards of each pair: (c, s) or its opposite, (-s, c)
  // likewise.
  const double x = s > 0.0 ? -scene_.half_extents[0] : scene_.half_extents[0];
  const double y = c > 0.0 ? -scene_.half_extents[1] : scene_.half_extents[1];
  z[3] = state_.q[0] + scene_.h * z[0] + c * x - s * y;
  z[4] = state_.q[1] + scene_.h * z[1] + s * x + c * y;
  z[s > 0.0 ? 6 : 5] = std::abs(s);
  z[c > 0.0 ? 8 : 7] = std::abs(c);
  return z;
}

BoxState BoxStep::next_state(const VectorXd& z) const {
  BoxState next;
  next.nu = z.head<3>();
  next.q = state_.q + scene_.h * next.nu;
  return next;
}

double BoxStep::energy(const BoxState& state) const {
  return 0.5 * scene_.mass * state.nu.head<2>().squaredNorm() + 0.5 * inertia() * state.nu[2] * state.nu[2] -
         scene_.mass * gravity().dot(state.q.head<2>());
}

}  // namespace touchstone::testing
