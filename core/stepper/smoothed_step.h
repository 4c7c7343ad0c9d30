#pragma once

#include <vector>

#include "core/stepper/step_problem.h"

namespace touchstone {

/// A step's problem with every complementarity opened by a parameter epsilon > 0, so that it is smooth:
///   p (psi + delta) = epsilon^2,   sigma (mu p - |y|^2 / (mu p)) = epsilon^2,   l_i (-f_i + delta_i) =
///   epsilon^2
/// in the place of 0 <= a _|_ b >= 0, all else as in Eqs. 10-11 in the form of Fritz John. Then
/// - bodies are apart, and each pushes off all others, the weaker the farther;
/// - friction is viscous where a contact slips slowly and dry where it slips fast: y = -mu p w / sigma;
/// - faces, edges and vertices are rounded: the closest points minimise their distance with a logarithmic
///   barrier of the faces, and are unique even where bodies lie flat on each other.
/// The solutions as epsilon goes to 0 are the problem's central path; its end is a solution of the step.
///
/// a b = epsilon^2 with a, b > 0 is written a + b - sqrt(a^2 + b^2 + 2 epsilon^2) = 0 (Kanzow, Some
/// noninterior continuation methods for linear complementarity problems, SIAM J. Matrix Anal. Appl. 17,
/// 1996).
///
/// The path starts at rest where the step starts, in a problem made for it: an impulse on each body, and the
/// delta of gaps and faces, make that start a solution. They fade with epsilon^2. What is in between is
/// again the step of some bodies under some impulses, and not just any system of equations.
template <int Dim>
class SmoothedStep {
 public:
  /// Binds the problem, which must outlive the use, at its largest epsilon, and makes the start.
  /// @param problem  in the projection form, as which it is left after each call; the reference directions of
  ///                 its contacts are chosen anew
  void begin(StepProblem<Dim>& problem, double epsilon);

  /// Number of unknowns: those of the problem, in its order.
  [[nodiscard]] Eigen::Index size() const { return problem_->size(); }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  /// Epsilon at the parameter tau = log(epsilon / largest epsilon) <= 0.
  [[nodiscard]] double epsilon(double tau) const { return epsilon_ * std::exp(tau); }
  [[nodiscard]] double parameter(double epsilon) const { return std::log(epsilon / epsilon_); }
  /// A usual size of each unknown: L, V, 1.
  [[nodiscard]] const Eigen::VectorXd& unit() const { return unit_; }
  /// Unknowns that are normal impulses.
  [[nodiscard]] bool is_impulse(Eigen::Index unknown) const {
    return is_impulse_[static_cast<std::size_t>(unknown)];
  }

  /// Rows at (z, tau). False where they are not defined: an impulse that is not positive.
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& z, double tau);
  /// The same with derivatives by z and by tau.
  [[nodiscard]] bool differentiate(const Eigen::VectorXd& z, double tau);
  [[nodiscard]] const Eigen::VectorXd& rows() const { return rows_; }
  /// Makes a point of the path a start for the problem itself: a contact that is more open than loaded is
  /// left without impulse, with the closest points of the bodies as they are.
  void close(Eigen::VectorXd& z) const;
  [[nodiscard]] const Eigen::MatrixXd& by_z() const { return by_z_; }
  [[nodiscard]] const Eigen::VectorXd& by_tau() const { return by_tau_; }

 private:
  /// A row a _|_ b with a an unknown and b a row of the problem times `weight`.
  struct Pair {
    Eigen::Index row = 0;
    double weight = 1.0;
    int slip_of = -1;    ///< contact whose slip speed a is: b is then divided by mu p
    double shift = 0.0;  ///< delta
  };

  void list_pairs();
  void find_start();
  void find_points(std::size_t contact);
  [[nodiscard]] bool compute(const Eigen::VectorXd& z, double tau, bool derivatives);

  StepProblem<Dim>* problem_ = nullptr;
  double epsilon_ = 1.0;
  double gap_weight_ = 1.0;
  std::vector<Pair> pairs_;
  std::vector<Eigen::Index> dropped_;  ///< slip speeds of contacts without friction, which nothing depends on
  std::vector<bool> is_impulse_;
  Eigen::VectorXd unit_, start_;
  Eigen::VectorXd offset_;  ///< of the rows that are equations: their values at the start
  Eigen::VectorXd rows_, by_tau_;
  Eigen::MatrixXd by_z_;
  StepBlock<Dim> block_;
};

}  // namespace touchstone
