#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "core/complementarity/problem.h"

namespace touchstone {

/// Why a complementarity solver stopped. Only `solved` means that the residual is within the tolerance.
enum class SolveStatus : std::uint8_t {
  not_run,            ///< no solve was made
  solved,             ///< the shared residual is within the tolerance
  iteration_limit,    ///< the allowed Newton iterations were used up
  stalled,            ///< no direction gave a decrease of the merit worth the name
  local_minimum,      ///< the merit is stationary at a point that is no solution
  singular_jacobian,  ///< the Jacobian is singular, its rows contradict, and regularised steps failed
  ray_termination,    ///< the linearised problem has no solution on its path, and regularised steps failed
  pivot_limit,        ///< the linearised problem used up its pivots, and regularised steps failed
  non_finite          ///< F or its Jacobian is not finite at the start
};

[[nodiscard]] std::string_view to_string(SolveStatus status);

/// A list of fixed capacity that never refuses: what comes after overwrites the last entry, so that the way
/// in and the end are always there.
template <typename Record, int Capacity>
class RecordList {
 public:
  static constexpr int capacity = Capacity;

  void clear() { count_ = 0; }

  void push(const Record& record) {
    records_[static_cast<std::size_t>(count_ < capacity ? count_ : capacity - 1)] = record;
    ++count_;
  }

  /// How many were pushed; more than values().size() once the capacity was exceeded.
  [[nodiscard]] int count() const { return count_; }

  [[nodiscard]] std::span<const Record> values() const {
    return {records_.data(), static_cast<std::size_t>(count_ < capacity ? count_ : capacity)};
  }

 private:
  std::array<Record, static_cast<std::size_t>(capacity)> records_;  // the first count_ entries are meaningful
  int count_ = 0;
};

/// Residuals of the iterates of one solve, the start's first.
using ResidualHistory = RecordList<double, 32>;

enum class SolverKind : std::uint8_t { path_newton, semismooth_newton };
[[nodiscard]] std::string_view to_string(SolverKind kind);

/// Where a stage of a solver chain started.
enum class StageStart : std::uint8_t {
  given,     ///< the caller's start
  crash,     ///< the caller's start, after projected Newton steps (CrashStart)
  proximal,  ///< where the last proximal step led, the first of which is from the caller's start
  perturbed  ///< a pseudorandom point around the caller's start
};
[[nodiscard]] std::string_view to_string(StageStart start);

/// One attempt of a solver chain.
struct SolveStage {
  SolverKind solver;
  StageStart start;
  SolveStatus status;
  int iterations;
  double residual;      ///< natural residual where the attempt ended, of what it was to solve
  double weight = 0.0;  ///< of the proximal term in what it was to solve; 0: the problem itself
};

/// What a complementarity solver did, complete on every exit.
struct SolveReport {
  SolveStatus status = SolveStatus::not_run;
  int iterations = 0;            ///< Newton steps taken
  int pivots = 0;                ///< basis changes in all linearised problems; 0 of a solver without pivoting
  int evaluations = 0;           ///< calls of the problem's evaluate()
  int jacobian_evaluations = 0;  ///< those of them that asked for the Jacobian
  /// Natural residual at the returned z, by natural_residual().
  double residual = std::numeric_limits<double>::infinity();
  Eigen::Index worst_row = -1;  ///< row of that residual
  ResidualHistory history;
  RecordList<SolveStage, 24> stages;  ///< attempts of a solver chain; empty of a single solver

  [[nodiscard]] bool solved() const { return status == SolveStatus::solved; }
};

/// One line for a person: status, effort, residual and the worst row by its name.
[[nodiscard]] std::string describe(const SolveReport& report, const MixedComplementarityProblem& problem);

}  // namespace touchstone
