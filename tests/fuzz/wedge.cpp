#include "tests/fuzz/wedge.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/stepper/central_path.h"

namespace touchstone {

namespace {

constexpr std::array kStarts = {0.1, 0.03, 0.01, 0.3, 1.0};  ///< epsilon
constexpr double kEnd = 1e-10;
constexpr double kCarries = 1e-3;  ///< of the largest normal impulse: more is part of the self-stress

template <int Dim>
using Impulse = Eigen::Matrix<double, Dimension<Dim>::friction + 1, 1>;

/// (y, p) of contact i.
template <int Dim>
Impulse<Dim> impulse_of(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z) {
  const ContactLayout& at = problem.layout().contact(i);
  Impulse<Dim> impulse;
  impulse << z.template segment<Dimension<Dim>::friction>(at.friction), z[at.normal];
  return impulse;
}

/// Where the impulses of contact i stand in z, and its rows of friction and gap.
template <int Dim>
std::array<Eigen::Index, Dimension<Dim>::friction + 1> impulse_rows(const StepProblem<Dim>& problem,
                                                                    std::size_t i) {
  const ContactLayout& at = problem.layout().contact(i);
  std::array<Eigen::Index, Dimension<Dim>::friction + 1> rows{};
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) rows[k] = at.friction + static_cast<Eigen::Index>(k);
  rows.back() = at.normal;
  return rows;
}

/// A wrench as forces: moments over L.
template <int Dim>
Twist<Dim> as_force(Twist<Dim> wrench, double length) {
  wrench.template tail<Dimension<Dim>::angular>() /= length;
  return wrench;
}

/// The step's problem with the rows of the contacts that wedge relaxed along the self-stress.
template <int Dim>
class RelaxedStep {
 public:
  RelaxedStep(StepProblem<Dim>& problem, const std::vector<std::size_t>& contacts, const Eigen::VectorXd& end)
      : problem_(problem), contacts_(contacts), n_(problem.size()), self_stress_(Eigen::VectorXd::Zero(n_)) {
    for (const std::size_t i : contacts) {
      for (const Eigen::Index r : impulse_rows(problem, i)) self_stress_[r] = end[r];
    }
    self_stress_ /= self_stress_.cwiseAbs().maxCoeff();
    gap_per_velocity_ = problem.step_size() * problem.scale().velocity / problem.scale().length;
  }

  /// Newton's method with the active set of the minimum function, with impulses that hold `multiple` times
  /// the self-stress. @return the residual
  double solve(double multiple, Eigen::VectorXd& z) {
    constexpr int kSteps = 40;
    const double load = multiple * self_stress_.squaredNorm();
    z += (multiple - self_stress_.dot(z) / self_stress_.squaredNorm()) * self_stress_;
    drift_ = 0;
    double best = std::numeric_limits<double>::infinity();
    Eigen::VectorXd best_z = z;
    double best_drift = 0;
    for (int k = 0; k < kSteps; ++k) {
      evaluate(z, load);
      const double residual = f_.cwiseAbs().maxCoeff();
      if (residual < best) {
        best = residual;
        best_z = z;
        best_drift = drift_;
      }
      const Eigen::VectorXd step = j_.completeOrthogonalDecomposition().solve(-f_);
      if (!step.allFinite()) break;
      z += step.head(n_);
      drift_ += step[n_];
    }
    z = best_z;
    drift_ = best_drift;
    return best;
  }

 private:
  [[nodiscard]] bool is_wedged(std::size_t i) const {
    return std::find(contacts_.begin(), contacts_.end(), i) != contacts_.end();
  }

  void evaluate(const Eigen::VectorXd& z, double load) {
    Eigen::VectorXd rows(n_);
    Eigen::MatrixXd by_z(n_, n_);
    problem_.evaluate(z, rows, &by_z);
    f_ = Eigen::VectorXd::Zero(n_ + 1);
    j_ = Eigen::MatrixXd::Zero(n_ + 1, n_ + 1);
    f_.head(n_) = rows;
    j_.topLeftCorner(n_, n_) = by_z;
    for (std::size_t i = 0; i < problem_.contacts().size(); ++i) {
      const ContactLayout& at = problem_.layout().contact(i);
      const auto& contact = problem_.contacts()[i];
      for (int l = 0; l < contact.side_1.multipliers() + contact.side_2.multipliers(); ++l)
        choose(at.multipliers_1 + l, 1.0, z);
      if (is_wedged(i)) {
        relax(at.normal, gap_per_velocity_ * self_stress_[at.normal]);
        const double rho = problem_.prepared(i).rho;
        for (int k = 0; k < Dimension<Dim>::friction; ++k)
          relax(at.friction + k, rho * self_stress_[at.friction + k]);
      } else {
        choose(at.normal, 1 / gap_per_velocity_, z);
      }
    }
    f_[n_] = self_stress_.dot(z) - load;
    j_.row(n_).head(n_) = self_stress_.transpose();
  }

  void relax(Eigen::Index row, double by) {
    f_[row] += by * drift_;
    j_(row, n_) = by;
  }
  /// The smaller one of an unknown and its row times `weight` is to be 0.
  void choose(Eigen::Index row, double weight, const Eigen::VectorXd& z) {
    if (z[row] > weight * f_[row]) return;
    f_[row] = z[row];
    j_.row(row).setZero();
    j_(row, row) = 1;
  }

  StepProblem<Dim>& problem_;
  const std::vector<std::size_t>& contacts_;
  Eigen::Index n_;
  Eigen::VectorXd self_stress_;  ///< (y, p) of the contacts that wedge, where they stand in z
  double gap_per_velocity_ = 1.0;
  double drift_ = 0.0;
  Eigen::VectorXd f_;
  Eigen::MatrixXd j_;
};

/// lambda . (psi / h, v_t) over the sum of lambda_n, over V. @param self_stress  (y, p) in the entries of z
template <int Dim>
double drift_at(const StepProblem<Dim>& problem, const std::vector<std::size_t>& contacts,
                const Eigen::VectorXd& self_stress, const Eigen::VectorXd& z) {
  const Scale& scale = problem.scale();
  double drift = 0;
  double weight = 0;
  Eigen::VectorXd rows(problem.size());
  problem.evaluate(z, rows, nullptr);
  for (const std::size_t i : contacts) {
    const ContactLayout& at = problem.layout().contact(i);
    const double mass = problem.prepared(i).mass;
    weight += mass * self_stress[at.normal];
    drift += mass * self_stress[at.normal] * problem.separation(i) / (problem.step_size() * scale.velocity);
    // In the interior of the cone the rows of friction are rho w.
    for (Eigen::Index r = at.friction; r < at.friction + Dimension<Dim>::friction; ++r)
      drift += mass * self_stress[r] * rows[r] / problem.prepared(i).rho;
  }
  return drift / weight;
}

/// Fills what the self-stress says. @param self_stress  (y, p) in the entries of z
template <int Dim>
void balance(const StepProblem<Dim>& problem, const Eigen::VectorXd& self_stress, Wedge& wedge) {
  std::vector<Twist<Dim>> sum(static_cast<std::size_t>(problem.moving_bodies()), Twist<Dim>::Zero());
  StepBlock<Dim> rows;
  double magnitude = 0;
  for (const std::size_t i : wedge.contacts) {
    const Impulse<Dim> impulse = impulse_of(problem, i, self_stress);
    problem.contact_block(i, true, rows);
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const int place = problem.places(i)[k];
      if (place < 0) continue;
      const Twist<Dim> momentum =
          rows.j.template block<Dimension<Dim>::velocity, Dimension<Dim>::friction + 1>(rows.column[k],
                                                                                        rows.at.friction) *
          impulse;
      const Twist<Dim> wrench =
          as_force<Dim>(-momentum.cwiseQuotient(problem.momentum_scale(place)), problem.scale().length);
      sum[static_cast<std::size_t>(place)] += wrench;
      magnitude += wrench.norm();
    }
    const double limit = problem.contacts()[i].law.mu * impulse[Dimension<Dim>::friction];
    wedge.use_of_cone =
        std::max(wedge.use_of_cone, impulse.template head<Dimension<Dim>::friction>().norm() / limit);
  }
  for (const Twist<Dim>& total : sum) wedge.imbalance = std::max(wedge.imbalance, total.norm() / magnitude);
}

/// Contacts that carry the self-stress where a path has run off, and how large it is there.
template <int Dim>
Wedge loads_at(const StepProblem<Dim>& problem, const Eigen::VectorXd& end) {
  Wedge wedge;
  std::vector<double> normal;  // [N s]
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    problem.evaluate_state(i, end);
    normal.push_back(problem.impulse(i).normal_impulse);
    wedge.impulse = std::max(wedge.impulse, end[problem.layout().contact(i).normal]);
  }
  const double largest = *std::max_element(normal.begin(), normal.end());
  for (std::size_t i = 0; i < normal.size(); ++i) {
    if (normal[i] > kCarries * largest) wedge.contacts.push_back(i);
  }
  return wedge;
}

/// Solves the relaxed step, with heavier loads until they are in their cones, and with ten times as heavy
/// ones.
template <int Dim>
void relax(StepProblem<Dim>& problem, const Eigen::VectorXd& end, Wedge& wedge) {
  constexpr double kLoad = 100;  // in m V
  constexpr double kMore = 10;
  RelaxedStep<Dim> relaxed(problem, wedge.contacts, end);
  Eigen::VectorXd z = end;
  wedge.residual = relaxed.solve(kLoad, z);
  Eigen::VectorXd more = z;
  wedge.residual = std::max(wedge.residual, relaxed.solve(kMore * kLoad, more));
  const Eigen::VectorXd self_stress = more - z;
  const double drift_of_more = drift_at(problem, wedge.contacts, self_stress, more);
  wedge.drift = drift_at(problem, wedge.contacts, self_stress, z);
  wedge.drift_change = std::abs(drift_of_more - wedge.drift);
  balance(problem, self_stress, wedge);
}

}  // namespace

template <int Dim>
std::optional<Wedge> find_wedge(StepProblem<Dim>& problem, Eigen::VectorXd& end) {
  CentralPath<Dim> path;
  for (const double start : kStarts) {
    path.begin(problem, start);
    if (path.follow_to(kEnd) != CentralPath<Dim>::State::unbounded) continue;
    end.resize(problem.size());
    path.estimate(end, false);
    Wedge wedge = loads_at(problem, end);
    wedge.epsilon = path.epsilon();
    relax(problem, end, wedge);
    return wedge;
  }
  return std::nullopt;
}

template std::optional<Wedge> find_wedge(StepProblem<2>&, Eigen::VectorXd&);
template std::optional<Wedge> find_wedge(StepProblem<3>&, Eigen::VectorXd&);

}  // namespace touchstone
