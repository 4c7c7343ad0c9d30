#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdlib>

#include "baselines/engines/engines.h"
#include "baselines/engines/loaded_library.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/silence.h"
#include "baselines/engines/simple_contacts.h"
#include "baselines/engines/spatial_engine.h"

/// Siconos 4.4's solvers of friction-contact problems (FC3D) in a Moreau-Jean time-stepper of our own, whose
/// geometry is frozen at the start of the step: the scheme of Siconos's kernel (MoreauJeanOSI), for single
/// rigid bodies.
///
///   v_free = v + h M^-1 (m g + f - w x I w)
///   W p + u_free = u',  0 <= u_n' + e u_n _|_ p_n >= 0  and Coulomb's law, for contacts whose predicted gap
///   closes v' = v_free + M^-1 H^T p,  q' = q (+) h ((1 - theta) v + theta v')
namespace touchstone::engines {

namespace {

enum class Solver { nsn, nsgs };

struct Settings {
  Solver solver;
  double theta;       ///< 0.5 as Siconos's default: second order without contacts
  double activation;  ///< a contact acts if psi + h/2 u_n is below this [m]; a body at rest has a gap of
                      ///< rounding
  double tolerance;   ///< of the solver, relative, on its natural map
  int iterations;
};

Settings read_settings(OptionReader& read, Solver solver) {
  Settings s{};
  s.solver = solver;
  s.theta = read.number("theta", 0.5, 0.5, 1.0);
  s.activation = read.number("activation", 1e-9, 0.0, 1.0);
  s.tolerance = read.number("tolerance", 1e-12, 1e-16, 1.0);
  s.iterations = read.integer("iterations", solver == Solver::nsn ? 1000 : 100000, 1, 100000000);
  return s;
}

struct DeleteOptions {
  void operator()(SolverOptions* options) const {
    solver_options_delete(options);
    std::free(options);
  }
};

/// Rows of a contact: velocity of body_a relative to body_b along n, e_t t, e_o o. In these scaled components
/// the friction ellipsoid is the circle that FC3D knows.
struct ContactRows {
  PointContact contact;
  Eigen::Matrix<double, 3, 6> on_a;
  Eigen::Matrix<double, 3, 6> on_b;
  Vector<3> semi_axes;  ///< 1, e_t, e_o
  double mu = 0.0;
  double restitution = 0.0;
};

Eigen::Matrix<double, 3, 6> point_jacobian(const Matrix<3>& directions, const Vector<3>& arm) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << directions.transpose(), directions.transpose() * lever(arm);
  return jacobian;
}

class SiconosWorld final : public Engine<3> {
 public:
  SiconosWorld(const Scene<3>& scene, const Settings& settings, Motion motion)
      : scene_(scene),
        settings_(settings),
        motion_(motion),
        geometry_(scene_, motion == Motion::planar),
        state_(initial_state(scene_)),
        options_(solver_options_create(settings.solver == Solver::nsn ? SICONOS_FRICTION_3D_NSN_AC
                                                                      : SICONOS_FRICTION_3D_NSGS)) {
    refuse_moving_half_spaces("Siconos", scene_);
    numerics_set_verbose(0);
    options_->dparam[SICONOS_DPARAM_TOL] = settings_.tolerance;
    options_->iparam[SICONOS_IPARAM_MAX_ITER] = settings_.iterations;
    if (settings_.solver == Solver::nsn) {
      // Newton from the point that an extragradient phase finds. Alone it meets singular systems where there
      // are more contacts than the bodies have freedoms, as under a polygon, and prints about them.
      options_->iparam[SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY] =
          SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY_VI_EG_NSN;
    }
  }

  StepReport advance(double h) override {
    h_ = h;
    free_velocities(h);
    active_contacts(h);
    StepReport report;
    if (!rows_.empty()) report = solve();
    if (report.status != StepStatus::solved) return report;
    apply_impulses();
    integrate(h);
    return report;
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    return state_[static_cast<std::size_t>(index)];
  }

  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const auto& body = scene_.bodies[static_cast<std::size_t>(index)];
    return {body.mass, body.inertia};
  }

  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const auto& c = rows_[k].contact;
      const Vector<3> p =
          impulse_.segment<3>(static_cast<Eigen::Index>(3 * k)).cwiseProduct(rows_[k].semi_axes);
      const Vector<3> impulse = directions(c) * p;
      contacts.push_back(
          contact_impulse<3>(scene_, {c.body_a, c.body_b, c.point_a, c.point_b, c.normal}, impulse));
    }
  }

 private:
  [[nodiscard]] Matrix<3> directions(const PointContact& c) const {
    Matrix<3> d;
    d << c.normal, contact_tangents(c.normal, scene_.law(c.body_a, c.body_b));
    return d;
  }

  void free_velocities(double h) {
    velocity_.resize(state_.size());
    inverse_mass_.resize(state_.size());
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto& body = scene_.bodies[i];
      velocity_[i] = state_[i].velocity;
      inverse_mass_[i].setZero();
      if (body.fixed) continue;
      const Vector<3> omega = state_[i].velocity.tail<3>();
      const Inertia<3> inertia = world_inertia(body.inertia, state_[i].pose.rotation);
      inverse_mass_[i].topLeftCorner<3, 3>() = Matrix<3>::Identity() / body.mass;
      inverse_mass_[i].bottomRightCorner<3, 3>() = inertia.inverse();
      velocity_[i].head<3>() += h * (scene_.gravity + body.force / body.mass);
      velocity_[i].tail<3>() -= h * inertia.inverse() * omega.cross(inertia * omega);
    }
  }

  /// Siconos's rule: half of the step ahead with the velocity that the step starts with.
  void active_contacts(double h) {
    geometry_.at(state_, candidates_);
    rows_.clear();
    for (const auto& c : candidates_) {
      const auto a = static_cast<std::size_t>(c.body_a);
      const auto b = static_cast<std::size_t>(c.body_b);
      const auto& law = scene_.law(c.body_a, c.body_b);
      ContactRows row{c, {}, {}, {1.0, law.e_t, law.e_o}, law.mu, law.restitution};
      const Matrix<3> scaled = directions(c) * row.semi_axes.asDiagonal();
      row.on_a = point_jacobian(scaled, c.point_a - state_[a].pose.position);
      row.on_b = -point_jacobian(scaled, c.point_b - state_[b].pose.position);
      const double approach =
          row.on_a.row(0).dot(state_[a].velocity) + row.on_b.row(0).dot(state_[b].velocity);
      if (c.gap + h / 2 * approach <= settings_.activation) rows_.push_back(row);
    }
  }

  /// W = H M^-1 H^T, and q = u_free with e u_n added to the normal rows.
  void assemble() {
    const auto n = static_cast<Eigen::Index>(3 * rows_.size());
    matrix_.setZero(n, n);
    right_.resize(n);
    mu_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto& row = rows_[i];
      const auto a = static_cast<std::size_t>(row.contact.body_a);
      const auto b = static_cast<std::size_t>(row.contact.body_b);
      const auto at = static_cast<Eigen::Index>(3 * i);
      mu_[i] = row.mu;
      right_.segment<3>(at) = row.on_a * velocity_[a] + row.on_b * velocity_[b];
      right_[at] += row.restitution *
                    (row.on_a.row(0).dot(state_[a].velocity) + row.on_b.row(0).dot(state_[b].velocity));
      for (std::size_t j = 0; j < rows_.size(); ++j)
        matrix_.block<3, 3>(at, static_cast<Eigen::Index>(3 * j)) = coupling(row, rows_[j]);
    }
  }

  [[nodiscard]] Matrix<3> coupling(const ContactRows& x, const ContactRows& y) const {
    Matrix<3> w = Matrix<3>::Zero();
    const auto add = [&](int body_x, const auto& jx, int body_y, const auto& jy) {
      if (body_x == body_y) w += jx * inverse_mass_[static_cast<std::size_t>(body_x)] * jy.transpose();
    };
    add(x.contact.body_a, x.on_a, y.contact.body_a, y.on_a);
    add(x.contact.body_a, x.on_a, y.contact.body_b, y.on_b);
    add(x.contact.body_b, x.on_b, y.contact.body_a, y.on_a);
    add(x.contact.body_b, x.on_b, y.contact.body_b, y.on_b);
    return w;
  }

  StepReport solve() {
    assemble();
    const int n = static_cast<int>(right_.size());
    NumericsMatrix* matrix = NM_create_from_data(NM_DENSE, n, n, matrix_.data());  // column-major, as Eigen's
    FrictionContactProblem problem{3, static_cast<int>(rows_.size()), matrix, right_.data(), mu_.data()};
    impulse_.setZero(n);
    slip_.setZero(n);
    const int info = [&] {
      const SilencedStderr silence;  // of every singular matrix that Newton meets on its way
      return fc3d_driver(&problem, impulse_.data(), slip_.data(), options_.get());
    }();
    matrix->matrix0 = nullptr;  // it is ours
    NM_clear(matrix);
    std::free(matrix);
    StepReport report{.iterations = options_->iparam[SICONOS_IPARAM_ITER_DONE],
                      .residual = options_->dparam[SICONOS_DPARAM_RESIDU]};
    if (info != 0) {
      report.status = StepStatus::not_converged;
      report.reason = "Siconos's solver did not reach its tolerance";
    }
    return report;
  }

  void apply_impulses() {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Vector<3> p = impulse_.segment<3>(static_cast<Eigen::Index>(3 * k));
      const auto& row = rows_[k];
      const auto add = [&](int body, const auto& jacobian) {
        const auto i = static_cast<std::size_t>(body);
        velocity_[i] += inverse_mass_[i] * (jacobian.transpose() * p);
      };
      add(row.contact.body_a, row.on_a);
      add(row.contact.body_b, row.on_b);
    }
  }

  void integrate(double h) {
    for (std::size_t i = 0; i < state_.size(); ++i) {
      if (scene_.bodies[i].fixed) continue;
      if (motion_ == Motion::planar) velocity_[i].segment<3>(2).setZero();  // rounding out of the plane
      const Twist<3> mean = (1 - settings_.theta) * state_[i].velocity + settings_.theta * velocity_[i];
      state_[i].pose = advanced(state_[i].pose, mean, h);
      state_[i].velocity = velocity_[i];
    }
  }

  const Scene<3> scene_;
  const Settings settings_;
  const Motion motion_;
  const SimpleContacts geometry_;
  std::vector<BodyState<3>> state_;
  std::unique_ptr<SolverOptions, DeleteOptions> options_;
  std::vector<Twist<3>> velocity_;                         ///< v_free, then v'
  std::vector<Eigen::Matrix<double, 6, 6>> inverse_mass_;  ///< world frame; zero for fixed bodies
  std::vector<PointContact> candidates_;
  std::vector<ContactRows> rows_;
  Eigen::MatrixXd matrix_;  ///< W
  Eigen::VectorXd right_;
  std::vector<double> mu_;
  Eigen::VectorXd impulse_;  ///< in the scaled components n, t, o [N s]
  Eigen::VectorXd slip_;
  double h_ = 0;
};

template <Solver solver>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const Settings settings = read_settings(read, solver);
  read.finish();
  return std::make_unique<SiconosWorld>(scene, settings, motion);
}

/// Siconos tells its version neither in a function nor in a header.
std::string version() {
  return version_and_file(TOUCHSTONE_SICONOS_VERSION,
                          loaded_file(reinterpret_cast<const void*>(&fc3d_driver)), FileNumber::interface);
}

constexpr Capabilities kCapabilities{
    .contact_impulses = true, .torsional_friction = false, .anisotropic_friction = true, .restitution = true};
constexpr SpatialEngine kNsn{"siconos_nsn", kCapabilities, kDoublePrecision, &load<Solver::nsn>};
constexpr SpatialEngine kNsgs{"siconos_nsgs", kCapabilities, kDoublePrecision, &load<Solver::nsgs>};
constexpr const char* kNsnText =
    "Siconos: Moreau-Jean, frozen geometry, friction cone by Alart-Curnier's Newton";
constexpr const char* kNsgsText =
    "Siconos: Moreau-Jean, frozen geometry, friction cone by nonsmooth Gauss-Seidel";

constexpr MethodEntry<2> kPlanar[] = {
    {kNsgs.key, kNsgsText, &make_planar<kNsgs>, &version},
    {kNsn.key, kNsnText, &make_planar<kNsn>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kNsgs.key, kNsgsText, &make_spatial<kNsgs>, &version},
    {kNsn.key, kNsnText, &make_spatial<kNsn>, &version},
};

}  // namespace

Rows siconos_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
