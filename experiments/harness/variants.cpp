#include "experiments/harness/variants.h"

#include "experiments/harness/account_columns.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"

namespace touchstone::harness {

namespace {

using Tables = std::vector<std::vector<Row>>;

Tables tables_of(const VariantExperiment& what, const std::string& variant, const CaseRun<3>& run) {
  const std::vector<std::string> columns = with_account(what.summary);
  Record summary(columns);
  std::vector<Row> history = what.tabulate(variant, run, summary);
  set_account(summary, run);
  return {{summary.row()}, std::move(history)};
}

Case variant_case(const VariantExperiment& what, const std::string& variant, const MethodSpec& method,
                  double h, double until) {
  MethodCase<3> spec;
  spec.scenario = what.name;
  spec.scene = std::make_shared<Scene<3>>(what.scene(variant));
  spec.method = method;
  spec.sweep = {variant};
  spec.run = {.h = h, .until = until, .samples = what.samples, .states = true, .ledger = true};
  spec.tabulate = [what, variant](const CaseRun<3>& run) { return tables_of(what, variant, run); };
  return make_case(std::move(spec));
}

std::vector<Case> cases(const VariantExperiment& what, const Selection& selection) {
  std::vector<Case> all;
  for (const double h : selection.numbers("step-sizes")) {
    for (const MethodSpec& method : selection.methods) {
      for (const std::string& variant : selection.texts("variants")) {
        all.push_back(variant_case(what, variant, method, h, selection.until));
      }
    }
  }
  return all;
}

}  // namespace

int run_variant_experiment(const VariantExperiment& what, int argc, char** argv) {
  const Axis variants = {"variants", what.about_variants, AxisKind::text, what.variants, what.variants,
                         1,          what.variants};
  const Axis steps = {"step-sizes", "step sizes h [s]", AxisKind::positive, what.steps, what.quick_steps};
  const Experiment experiment = {
      .command_line = {.name = what.name,
                       .about = what.about,
                       .examples = what.examples,
                       .methods = {"implicit_ncp"},
                       .axes = {variants, steps},
                       .until = what.until,
                       .quick_until = what.quick_until},
      .sweep_columns = {"variant"},
      .tables = {{"summary", with_account(what.summary)}, {"history", what.history}},
      .seed = std::nullopt,
      .cases = [&what](const Selection& selection) { return cases(what, selection); }};
  return run_experiment(experiment, argc, argv);
}

}  // namespace touchstone::harness
