#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/method.h"
#include "experiments/harness/case.h"
#include "experiments/harness/judge.h"
#include "experiments/harness/ledger.h"

/// One method over one horizon, judged at every step by the shared judge.
namespace touchstone::harness {

/// How many steps of `h` make up `until`, both in [s].
/// A horizon is hit exactly or refused: a last step of another size would be another method than the one
/// judged.
/// @throws InputError naming --until if it is not a multiple of h within 1e-9
long step_count(double until, double h);

struct RunOptions {
  double h = 0.01;                  ///< step, > 0 [s]
  double until = 1.0;               ///< horizon, a multiple of h [s]
  int samples = 200;                ///< about how many samples of the whole motion to keep
  std::vector<double> report = {};  ///< times whose energy is wanted [s]
  bool states = false;              ///< keep the bodies' states at the samples
  bool ledger = false;              ///< book where the energy goes, at every step
  bool keep_steps = false;          ///< keep every step; books as well
};

/// The time of step k is k h, not a sum of h.
struct Sample {
  double t_s = 0.0;
  Energy energy;
};

/// How far a method takes its state to be off, as lengths of the errors of position, turn, velocity and
/// angular velocity.
struct EstimatedError {
  double position_m = 0.0;
  double turn_rad = 0.0;
  double velocity_m_s = 0.0;
  double angular_velocity_rad_s = 0.0;
};

template <int Dim>
EstimatedError estimated_error(const StateError<Dim>& error);

/// What a method told after one step.
template <int Dim>
struct KeptStep {
  double t_s = 0.0;                           ///< end of the step
  std::vector<BodyState<Dim>> state;          ///< of all bodies of the method's scene
  std::vector<ContactImpulse<Dim>> contacts;  ///< that acted in it; none at t = 0
};

template <int Dim>
struct CaseRun {
  CaseStatus status = CaseStatus::ok;
  std::string reason;
  std::vector<Sample> samples;  ///< t = 0, every so many steps, and the last; up to a failure
  /// Of all bodies at the times of the samples; none unless RunOptions::states.
  std::vector<std::vector<BodyState<Dim>>> states;
  /// Since the start, at the times of the samples; none unless energy is booked.
  std::vector<EnergyAccount> accounts;
  /// At RunOptions::report; none if that is no multiple of h, beyond the horizon or after a failure.
  std::vector<std::optional<Energy>> reported;
  std::vector<BodyState<Dim>> end;  ///< state at the horizon, or before the failed step
  Energy initial;
  Energy final;
  double largest_drift_J = 0.0;      ///< of |E(t_k) - E(0)| over all steps
  double largest_penetration = 0.0;  ///< over all steps, t = 0 included [m]
  /// Each part's largest over all steps; NaN if the method's states are not steps of one run
  /// (Capabilities::one_run), for which no residual of a step is defined.
  StepResidual residual;
  /// The method's own estimate, the largest of any body: after the last step, and over all steps. None from a
  /// method without one.
  std::optional<EstimatedError> estimated_end;
  std::optional<EstimatedError> estimated_largest;
  std::vector<KeptStep<Dim>> kept;  ///< t = 0 and every solved step, if they are to be kept
  bool impulses = false;   ///< whether the method tells its contact impulses; if not, `account` says little
  EnergyAccount account;   ///< up to the last solved step; zero unless energy is booked
  long steps = 0;          ///< that were solved
  long planned_steps = 0;  ///< that make up the horizon
  long iterations = 0;     ///< as the method tells, over all steps
  int failed_steps = 0;    ///< 0 or 1: a failed step ends the case
};

/// Called with the time [s] and the state of all bodies at t = 0 and after every solved step.
template <int Dim>
using Observer = std::function<void(double t_s, std::span<const BodyState<Dim>> state)>;

/// Steps `method` from its initial state. A step that is not solved ends the case: the state is as it was
/// before it, and another step of the same size from the same state would fail in the same way. So does a
/// state that is not finite, whatever the method's status says. Everything is computed from method.scene(),
/// which is what the method simulates.
/// @throws Interrupted between two steps
template <int Dim>
CaseRun<Dim> run_case(Method<Dim>& method, const RunOptions& options, const Observer<Dim>& observer = {});

}  // namespace touchstone::harness
