#include "experiments/harness/run_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"

namespace touchstone::harness {

namespace {

/// Number of steps to `t`, if it is a multiple of `h`. Both are decimals rounded to doubles, hence the
/// tolerance.
std::optional<long> multiple_of(double t, double h) {
  constexpr double kTolerance = 1e-9;
  const double count = t / h;
  const double nearest = std::round(count);
  if (!(std::abs(count - nearest) <= kTolerance * std::max(1.0, nearest))) return std::nullopt;
  return static_cast<long>(nearest);
}

template <int Dim>
bool is_finite(std::span<const BodyState<Dim>> state) {
  return std::all_of(state.begin(), state.end(),
                     [](const auto& body) { return body.pose.is_finite() && body.velocity.allFinite(); });
}

void raise(double& largest, double value) {
  // Not std::max, which would drop a NaN; and once there it stays.
  if (!std::isnan(largest) && !(value <= largest)) largest = value;
}

void raise(EstimatedError& largest, const EstimatedError& error) {
  raise(largest.position_m, error.position_m);
  raise(largest.turn_rad, error.turn_rad);
  raise(largest.velocity_m_s, error.velocity_m_s);
  raise(largest.angular_velocity_rad_s, error.angular_velocity_rad_s);
}

/// Runs a case and keeps its account.
template <int Dim>
class Runner {
 public:
  Runner(Method<Dim>& method, const RunOptions& options, const Observer<Dim>& observer)
      : method_(method),
        options_(options),
        observer_(observer),
        judge_(method.scene()),
        steps_(step_count(options.until, options.h)) {
    every_ = std::max(1L, (steps_ + options.samples - 1) / options.samples);
    run_.samples.reserve(static_cast<std::size_t>(steps_ / every_ + 2));
    for (const double t : options.report) report_steps_.push_back(multiple_of(t, options.h));
    run_.reported.resize(options.report.size());
    run_.planned_steps = steps_;
    run_.impulses = method.capabilities().contact_impulses;
    if (options.ledger || options.keep_steps) ledger_.emplace(method.scene(), judge_, method.state());
    if (!method.capabilities().one_run) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      run_.residual = {none, none, none, none, none};
    }
  }

  CaseRun<Dim> run() {
    observe(0);
    for (long k = 1; k <= steps_; ++k) {
      throw_if_interrupted();
      remember();
      const StepReport report = method_.step(options_.h);
      run_.iterations += report.iterations;
      if (!accept(report, k)) break;
      if (method_.capabilities().one_run) {
        judge_step();
        book_step();
      }
      note_estimate();
      observe(k);
    }
    run_.end.assign(method_.state().begin(), method_.state().end());
    return std::move(run_);
  }

 private:
  /// k h, formed so that a decimal time comes out as that decimal: runs with different steps then share their
  /// times.
  [[nodiscard]] double time_of(long k) const {
    return options_.until * static_cast<double>(k) / static_cast<double>(steps_);
  }

  void remember() { before_.assign(method_.state().begin(), method_.state().end()); }

  bool accept(const StepReport& report, long k) {
    if (report.status != StepStatus::solved) return fail(k, to_string(report.status), report.reason);
    if (!is_finite<Dim>(method_.state()))
      return fail(k, to_string(StepStatus::non_finite), "state after the step");
    run_.steps = k;
    return true;
  }

  bool fail(long k, std::string_view status, std::string_view why) {
    run_.status = CaseStatus::failed;
    run_.reason =
        fmt::format("step {} from t = {} s: {}{}{}", k, time_of(k - 1), status, why.empty() ? "" : ": ", why);
    run_.failed_steps = 1;
    return false;
  }

  void judge_step() {
    const StepResidual r =
        judge_.step_residual(before_, method_.state(), method_.contacts(), options_.h, method_.joints());
    raise(run_.residual.dynamics, r.dynamics);
    raise(run_.residual.kinematics, r.kinematics);
    raise(run_.residual.contact, r.contact);
    raise(run_.residual.friction, r.friction);
    raise(run_.residual.joints, r.joints);
  }

  void book_step() {
    if (!ledger_) return;
    ledger_->book(options_.h, before_, method_.state(), method_.contacts(), method_.joints());
    run_.account = ledger_->account();
  }

  void keep_sample(long k, const Energy& now) {
    run_.samples.push_back({time_of(k), now});
    if (options_.states) run_.states.emplace_back(method_.state().begin(), method_.state().end());
    if (ledger_) run_.accounts.push_back(run_.account);
  }

  void keep(long k) {
    const auto state = method_.state();
    const auto contacts = method_.contacts();
    run_.kept.push_back({time_of(k), {state.begin(), state.end()}, {}});
    if (k > 0) run_.kept.back().contacts.assign(contacts.begin(), contacts.end());
  }

  void note_estimate() {
    const auto errors = method_.error_estimate();
    if (errors.empty()) return;
    run_.estimated_end.emplace();
    for (const auto& error : errors) raise(*run_.estimated_end, estimated_error(error));
    if (!run_.estimated_largest) run_.estimated_largest.emplace();
    raise(*run_.estimated_largest, *run_.estimated_end);
  }

  /// Energy and penetration after step k, and what is to be kept of them.
  void observe(long k) {
    if (observer_) observer_(time_of(k), method_.state());
    const Energy now = judge_.energy(method_.state());
    if (k == 0) run_.initial = now;
    run_.final = now;
    raise(run_.largest_drift_J, std::abs(now.total() - run_.initial.total()));
    raise(run_.largest_penetration, judge_.largest_penetration(method_.state()));
    if (k % every_ == 0 || k == steps_) keep_sample(k, now);
    for (std::size_t i = 0; i < report_steps_.size(); ++i) {
      if (report_steps_[i] == k) run_.reported[i] = now;
    }
    if (options_.keep_steps) keep(k);
  }

  Method<Dim>& method_;
  const RunOptions& options_;
  const Observer<Dim>& observer_;
  Judge<Dim> judge_;
  std::optional<EnergyLedger<Dim>> ledger_;
  long steps_;
  long every_ = 1;
  std::vector<std::optional<long>> report_steps_;
  std::vector<BodyState<Dim>> before_;
  CaseRun<Dim> run_;
};

}  // namespace

long step_count(double until, double h) {
  if (!(h > 0) || !std::isfinite(h)) throw InputError("step size", h, "a finite number > 0 [s]");
  const std::optional<long> count = multiple_of(until, h);
  if (!count || *count < 1) {
    throw InputError("--until", until, fmt::format("a multiple of the step size {} s, at least one step", h));
  }
  return *count;
}

template <int Dim>
EstimatedError estimated_error(const StateError<Dim>& error) {
  return {error.position.norm(), error.turn.norm(), error.velocity.template head<Dim>().norm(),
          error.velocity.template tail<Dimension<Dim>::angular>().norm()};
}

template <int Dim>
CaseRun<Dim> run_case(Method<Dim>& method, const RunOptions& options, const Observer<Dim>& observer) {
  return Runner<Dim>(method, options, observer).run();
}

template EstimatedError estimated_error(const StateError<2>&);
template EstimatedError estimated_error(const StateError<3>&);
template CaseRun<2> run_case(Method<2>&, const RunOptions&, const Observer<2>&);
template CaseRun<3> run_case(Method<3>&, const RunOptions&, const Observer<3>&);

}  // namespace touchstone::harness
