#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/experiment.h"
#include "experiments/harness/run_case.h"

/// Experiments that run a few variants of one spatial scene with every method and step size, and keep the
/// motion.
namespace touchstone::harness {

struct VariantExperiment {
  std::string scenario;
  std::vector<std::string> variants;  ///< values of the axis --variants and of the column `variant`
  std::string about_variants;         ///< what they are, for --help
  int samples = 400;                  ///< about how many of the motion to keep
  std::function<Scene<3>(const std::string& variant)> scene;
  /// Rows of each table. Runs keep states and the ledger. Also called for a run that failed.
  std::function<std::vector<std::vector<Row>>(const std::string& variant, const CaseRun<3>& run)> tabulate;
};

/// The experiment: `spec` with --variants and --step-sizes added to its axes.
/// @param steps  default step sizes [s]
/// @param quick  for --quick
Experiment variant_experiment(const VariantExperiment& what, CommandLineSpec spec,
                              std::vector<TableSpec> tables, const std::vector<std::string>& steps,
                              const std::vector<std::string>& quick);

}  // namespace touchstone::harness
