#pragma once

#include <optional>
#include <stdexcept>

#include "experiments/scenarios/truths/collocation.h"
#include "experiments/scenarios/truths/events.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {

/// How an integration is to be done. Deterministic: the same call gives the same bits.
struct OdeOptions {
  /// Bound of a step's error estimate in units of max(|y_i|, floor); in [1e-15, 1e-2].
  double tolerance = 1e-14;
  /// > 0: below this size of a component its error counts absolutely, in the component's own unit.
  double floor = 1.0;
  double first_step = 0.0;                                    ///< >= 0 [time]; 0: chosen from |y'|
  double max_step = std::numeric_limits<double>::infinity();  ///< > 0 [time]
  int max_steps = 1'000'000;                                  ///< > 0, tried or accepted

  /// @throws std::invalid_argument naming the field and the bound
  void validate() const {
    require(tolerance >= 1e-15 && tolerance <= 1e-2, "tolerance", tolerance, "in [1e-15, 1e-2]");
    require(floor > 0.0, "floor", floor, "> 0");
    require(first_step >= 0.0, "first_step", first_step, ">= 0");
    require(max_step > 0.0, "max_step", max_step, "> 0");
    require(max_steps >= 1, "max_steps", max_steps, ">= 1");
  }
};

enum class OdeStatus { reached_end, event, step_underflow, too_many_steps };

template <int N>
struct OdeResult {
  OdeStatus status = OdeStatus::reached_end;
  double t = 0.0;         ///< where the integration stopped
  OdeVector<N> y;         ///< y(t)
  std::size_t event = 0;  ///< which event, if status == event
  int steps = 0;          ///< accepted steps
};

/// A step over which y changes by about a third of its size.
template <int N>
double first_step(const OdeVector<N>& rate, const OdeVector<N>& y, double span, const OdeOptions& options) {
  const double relative = rate.cwiseQuotient(y.cwiseAbs().cwiseMax(options.floor)).cwiseAbs().maxCoeff();
  return relative > 0.0 ? 0.3 / relative : span;
}

/// By how much the next step may differ, from an error ~ h^order.
inline double step_factor(double error, double tolerance, std::size_t order) {
  const double ratio = tolerance / std::max(error, 1e-30);
  return std::clamp(0.9 * std::pow(ratio, 1.0 / static_cast<double>(order)), 0.2, 2.5);
}

/// Integrates y' = f(t, y) from t0 to t1 > t0, adaptively,
/// by Gauss collocation of order 20, to the first event.
///
/// @param field     (t, y) -> y'; analytic along the solution, and defined a little beyond an event
/// @param events    (t, y) -> std::array<double, M>; an event is where one FALLS through zero (EventWatch)
/// @param armed     which of the events may fire at once; the others only after they have been > 0
/// @param observer  called with (dense step, end): the trajectory is the dense step's on [begin, end]
template <int N, std::size_t M, class Field, class Events, class Observer>
[[nodiscard]] OdeResult<N> integrate(const Field& field, double t0, const OdeVector<N>& y0, double t1,
                                     const Events& events, const std::array<bool, M>& armed,
                                     Observer&& observer, const OdeOptions& options = {}) {
  options.validate();
  Collocation<N, Field> step(field);
  EventWatch<N, M> watch(armed, events(t0, y0));
  OdeVector<N> carry = OdeVector<N>::Zero();  // what rounding has lost from y so far (Kahan)
  OdeResult<N> at{.t = t0, .y = y0};
  double h = options.first_step > 0.0 ? options.first_step : first_step(field(t0, y0), y0, t1 - t0, options);
  for (int attempt = 0; at.t < t1; ++attempt) {
    h = std::min(h, options.max_step);
    if (attempt >= options.max_steps) at.status = OdeStatus::too_many_steps;
    if (!(at.t + h > at.t)) at.status = OdeStatus::step_underflow;
    if (at.status != OdeStatus::reached_end) return at;

    const bool last = at.t + h >= t1;
    const double taken = last ? t1 - at.t : h;
    if (!step.solve(at.t, at.y, taken, at.y.cwiseAbs().cwiseMax(options.floor))) {
      h = 0.3 * taken;
      continue;
    }
    const double factor = step_factor(step.error(), options.tolerance, DenseStep<N>::stages);
    if (step.error() > options.tolerance) {
      h = taken * std::min(factor, 0.9);
      continue;
    }
    const DenseStep<N> dense = step.dense();
    const double end = last ? t1 : dense.end();
    const std::optional<FiredEvent> fired = watch.first(dense, end, events);
    if (fired) {
      observer(dense, fired->t);
      at.status = OdeStatus::event, at.event = fired->index, at.t = fired->t, at.y = dense(fired->t);
      return at;
    }
    observer(dense, end);
    const OdeVector<N> increment = step.increment() - carry;
    const OdeVector<N> next = at.y + increment;
    carry = (next - at.y) - increment;
    at.y = next, at.t = end, ++at.steps;
    // A slowly converging iteration costs more than a second step would.
    h = taken * (step.iterations() > 14 ? std::min(factor, 0.8) : factor);
  }
  return at;
}

/// The same without events: y(t1).
/// @throws std::runtime_error if the step size underflows or max_steps is spent
template <int N, class Field>
[[nodiscard]] OdeVector<N> integrate(const Field& field, double t0, const OdeVector<N>& y0, double t1,
                                     const OdeOptions& options = {}) {
  const auto none = [](double, const OdeVector<N>&) { return std::array<double, 0>{}; };
  const auto result = integrate<N, 0>(
      field, t0, y0, t1, none, {}, [](const DenseStep<N>&, double) {}, options);
  if (result.status != OdeStatus::reached_end) throw std::runtime_error("integrate: did not reach the end");
  return result.y;
}

}  // namespace touchstone::truth
