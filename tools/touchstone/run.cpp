#include "tools/touchstone/run.h"

#include <fmt/format.h>

#include <algorithm>

#include "baselines/options.h"
#include "baselines/registry.h"
#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"
#include "experiments/harness/progress.h"
#include "experiments/harness/run_case.h"
#include "experiments/scene_file/scene_file.h"
#include "tools/touchstone/recorder.h"

namespace touchstone::program {

namespace {

template <int Dim>
std::unique_ptr<Method<Dim>> load(const Scene<Dim>& scene, const RunRequest& request) {
  try {
    auto method = find_method<Dim>(request.method).make(scene, request.options);
    // Whatever a method refuses by itself: without its joints this would be another scene.
    if (!scene.joints.empty() && !method->capabilities().joints) throw Unsupported("it has no joints");
    return method;
  } catch (const Unsupported& reason) {
    throw InputError(fmt::format("method {}", request.method), request.scene.string(),
                     fmt::format("a scene that it can represent ({})", reason.what()));
  }
}

template <int Dim>
bool is_finite(std::span<const BodyState<Dim>> state) {
  return std::all_of(state.begin(), state.end(),
                     [](const auto& body) { return body.pose.is_finite() && body.velocity.allFinite(); });
}

/// One step. @returns why it failed, empty if it did not
template <int Dim>
std::string step(Method<Dim>& method, double h) {
  try {
    const StepReport report = method.step(h);
    if (report.status != StepStatus::solved) {
      return fmt::format("{}{}{}", to_string(report.status), report.reason.empty() ? "" : ": ",
                         report.reason);
    }
    if (!is_finite<Dim>(method.state())) {
      return fmt::format("{}: the state after the step", to_string(StepStatus::non_finite));
    }
    return {};
  } catch (const std::exception& error) {
    return fmt::format("threw: {}", error.what());
  }
}

/// A run in progress.
template <int Dim>
class Simulation {
 public:
  Simulation(Method<Dim>& method, const RunRequest& request)
      : method_(method),
        request_(request),
        steps_(harness::step_count(request.until, request.h)),
        judge_(method.scene()),
        ledger_(method.scene(), judge_, method.state()),
        recorder_(method) {}

  /// @returns why it ended early, empty if it did not
  std::string simulate() {
    harness::Progress progress("touchstone run", 1, static_cast<double>(steps_));
    recorder_.record(0, 0, ledger_);
    for (long k = 1; k <= steps_; ++k) {
      harness::throw_if_interrupted();
      progress.show(0, static_cast<double>(k - 1));
      before_.assign(method_.state().begin(), method_.state().end());
      const std::string failure = step(method_, request_.h);
      if (!failure.empty()) return fmt::format("step {} from t = {} s: {}", k, time_of(k - 1), failure);
      ledger_.book(request_.h, before_, method_.state(), method_.contacts(), method_.joints());
      if (k % request_.every == 0 || k == steps_) recorder_.record(time_of(k), request_.h, ledger_);
    }
    return {};
  }

  [[nodiscard]] const Recorder<Dim>& recorder() const { return recorder_; }
  [[nodiscard]] const EnergyLedger<Dim>& ledger() const { return ledger_; }

 private:
  /// k h as the decimal that it is meant to be: 15 digits take the rounding off.
  [[nodiscard]] double time_of(long k) const {
    const double t = request_.until * static_cast<double>(k) / static_cast<double>(steps_);
    return std::stod(fmt::format("{:.15g}", t));
  }

  Method<Dim>& method_;
  const RunRequest& request_;
  long steps_;
  Judge<Dim> judge_;
  EnergyLedger<Dim> ledger_;
  Recorder<Dim> recorder_;
  std::vector<BodyState<Dim>> before_;
};

template <int Dim>
void print_summary(const RunRequest& request, const Method<Dim>& method, const EnergyLedger<Dim>& ledger) {
  const EnergyAccount& account = ledger.account();
  fmt::print("method {} [{}]\n", request.method, format_options(method.effective_options()));
  fmt::print("energy {:.6g} J", ledger.energy().total());
  if (method.capabilities().contact_impulses) {
    fmt::print("; lost to friction {:.6g} J, to impacts {:.6g} J; numerical drift {:.3g} J",
               account.friction_loss, account.impact_loss, account.drift);
  }
  fmt::print("\nwrote trajectory.csv, contacts.csv{} and energy.csv in {}\n",
             method.error_estimate().empty() ? "" : fmt::format(", {}", kErrorEstimateFile),
             request.out.string());
}

template <int Dim>
bool run_scene(const Scene<Dim>& scene, const RunRequest& request) {
  const auto method = load(scene, request);
  Simulation<Dim> simulation(*method, request);
  harness::prepare_folder(request.out);
  // Of another method's run: not to be taken for this one's.
  std::error_code ignored;
  if (method->error_estimate().empty()) std::filesystem::remove(request.out / kErrorEstimateFile, ignored);
  const std::string failure = simulation.simulate();
  write_files(simulation.recorder().files(request.out));
  print_summary(request, *method, simulation.ledger());
  if (!failure.empty()) fmt::print(stderr, "touchstone run: {}\n", failure);
  return failure.empty();
}

}  // namespace

bool run(const RunRequest& request) {
  const scene_file::AnyScene scene = scene_file::read_scene(request.scene);
  return std::visit([&](const auto& any) { return run_scene(any, request); }, scene);
}

}  // namespace touchstone::program
