#pragma once

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
};

/// The time of step k is k h, not a sum of h.
struct Sample {
  double t_s = 0.0;
  Energy energy;
};

template <int Dim>
struct CaseRun {
  CaseStatus status = CaseStatus::ok;
  std::string reason;
  std::vector<Sample> samples;  ///< t = 0, every so many steps, and the last; up to a failure
  /// Of all bodies at the times of the samples; none unless RunOptions::states.
  std::vector<std::vector<BodyState<Dim>>> states;
  /// Since the start, at the times of the samples; none unless RunOptions::ledger.
  std::vector<EnergyAccount> accounts;
  /// At RunOptions::report; none if that is no multiple of h, beyond the horizon or after a failure.
  std::vector<std::optional<Energy>> reported;
  std::vector<BodyState<Dim>> end;  ///< state at the horizon, or before the failed step
  Energy initial;
  Energy final;
  double largest_drift_J = 0.0;      ///< of |E(t_k) - E(0)| over all steps
  double largest_penetration = 0.0;  ///< over all steps, t = 0 included [m]
  StepResidual residual;             ///< each part's largest over all steps
  bool impulses =
      false;  ///< whether the method tells its contact impulses, without which `account` says little
  EnergyAccount account;   ///< up to the last step that was solved; zero unless RunOptions::ledger
  long steps = 0;          ///< that were solved
  long planned_steps = 0;  ///< that make up the horizon
  long iterations = 0;     ///< as the method tells, over all steps
  int failed_steps = 0;    ///< 0 or 1: a failed step ends the case
};

/// Steps `method` from its initial state. A step that is not solved ends the case: the state is as it was
/// before it, and another step of the same size from the same state would fail in the same way. So does a
/// state that is not finite, whatever the method's status says. Everything is computed from method.scene(),
/// which is what the method simulates.
/// @throws Interrupted between two steps
template <int Dim>
CaseRun<Dim> run_case(Method<Dim>& method, const RunOptions& options);

}  // namespace touchstone::harness
