#include "experiments/harness/variants.h"

#include "experiments/harness/method_case.h"

namespace touchstone::harness {

namespace {

Case variant_case(const VariantExperiment& what, const std::string& variant, const MethodSpec& method,
                  double h, double until) {
  MethodCase<3> spec;
  spec.scenario = what.scenario;
  spec.scene = std::make_shared<Scene<3>>(what.scene(variant));
  spec.method = method;
  spec.sweep = {variant};
  spec.run = {.h = h, .until = until, .samples = what.samples, .states = true, .ledger = true};
  spec.tabulate = [variant, tabulate = what.tabulate](const CaseRun<3>& run) {
    return tabulate(variant, run);
  };
  return make_case(std::move(spec));
}

}  // namespace

Experiment variant_experiment(const VariantExperiment& what, CommandLineSpec spec,
                              std::vector<TableSpec> tables, const std::vector<std::string>& steps,
                              const std::vector<std::string>& quick) {
  spec.axes.push_back(
      {"variants", what.about_variants, AxisKind::text, what.variants, what.variants, 1, what.variants});
  spec.axes.push_back({"step-sizes", "step sizes h [s]", AxisKind::positive, steps, quick});
  const auto cases = [what](const Selection& selection) {
    std::vector<Case> all;
    for (const double h : selection.numbers("step-sizes")) {
      for (const MethodSpec& method : selection.methods) {
        for (const std::string& variant : selection.texts("variants")) {
          all.push_back(variant_case(what, variant, method, h, selection.until));
        }
      }
    }
    return all;
  };
  return {.command_line = std::move(spec),
          .sweep_columns = {"variant"},
          .tables = std::move(tables),
          .seed = std::nullopt,
          .cases = cases};
}

}  // namespace touchstone::harness
