#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "baselines/options.h"
#include "baselines/registry.h"
#include "core/model/errors.h"
#include "experiments/harness/case.h"
#include "experiments/harness/command_line.h"
#include "experiments/harness/run_case.h"

/// Cases of methods from the registry.
namespace touchstone::harness {

/// A method to be run on a scene, and what is to be written about it.
template <int Dim>
struct MethodCase {
  std::string scenario;
  std::shared_ptr<const Scene<Dim>> scene;
  MethodSpec method;
  Row sweep;  ///< cells of the experiment's sweep columns
  RunOptions run;
  double cost_of_step = 1.0;                                 ///< beside other methods', for the order of work
  std::span<const MethodEntry<Dim>> table = methods<Dim>();  ///< where the method is looked up
  /// The rows of each table of the experiment. Also called for a run that failed, with what it has.
  std::function<std::vector<std::vector<Row>>(const CaseRun<Dim>&)> tabulate;
};

/// The key of every method of this build, sorted: what --methods is by default where all are to be compared.
template <int Dim>
std::vector<std::string> method_keys() {
  std::vector<std::string> keys;
  for (const MethodEntry<Dim>& entry : methods<Dim>()) keys.emplace_back(entry.key);
  return keys;
}

/// The options that `make` makes a method with, or none if it could not: it threw Unsupported, or ended in a
/// crash or a hang. Runs `make` in a process of its own if it is an engine's.
/// @throws InputError as `make` does
std::optional<Options> options_made_with(const std::function<Options()>& make, bool is_engine);

/// The options in force of `method` on `scene`; those that were given if it cannot be made: its row will say
/// why.
/// @throws InputError on an unknown method, or an unknown or bad option
template <int Dim>
Options options_in_force(const Scene<Dim>& scene, const MethodSpec& method,
                         std::span<const MethodEntry<Dim>> table = methods<Dim>()) {
  const MethodEntry<Dim>& entry = find_method<Dim>(method.key, table);
  const bool is_engine = entry.version != nullptr && !entry.version().empty();
  const auto make = [&] { return entry.make(scene, method.options)->effective_options(); };
  return options_made_with(make, is_engine).value_or(method.options);
}

/// A run of the same method on the same scene with another step, or of another method with the same one, for
/// a row that compares the two. Rows of a table are made one by one, so that a sweep can stop and go on and
/// its cases can run anywhere; hence it is run again rather than looked up.
/// @throws Unsupported if the method cannot represent the scene
template <int Dim>
CaseRun<Dim> run_beside(const Scene<Dim>& scene, const MethodSpec& method, double h, double until) {
  const auto beside = find_method<Dim>(method.key).make(scene, method.options);
  return run_case(*beside, {.h = h, .until = until, .report = {}, .keep_steps = true});
}

/// The case, with the method, its options and the horizon already checked, so that what is wrong with them is
/// found before anything runs.
/// @throws InputError on an unknown method, an unknown or bad option, a horizon that is no multiple of the
/// step
template <int Dim>
Case make_case(MethodCase<Dim> spec) {
  const MethodEntry<Dim>& entry = find_method<Dim>(spec.method.key, spec.table);
  Case one;
  one.id = {spec.scenario,
            spec.method.key,
            format_options(options_in_force<Dim>(*spec.scene, spec.method, spec.table)),
            spec.sweep,
            spec.run.h,
            spec.run.until};
  one.cost = static_cast<double>(step_count(spec.run.until, spec.run.h)) * spec.cost_of_step;
  if (entry.version != nullptr) one.engine_version = entry.version();
  one.run = [spec = std::move(spec), make = entry.make] {
    const auto method = make(*spec.scene, spec.method.options);
    const CaseRun<Dim> run = run_case(*method, spec.run);
    return CaseResult{run.status, run.reason, spec.tabulate(run)};
  };
  return one;
}

}  // namespace touchstone::harness
