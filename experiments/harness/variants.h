#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/record.h"
#include "experiments/harness/run_case.h"

/// Experiments that run a few variants of one spatial scene with every method and step size, and keep the
/// motion.
namespace touchstone::harness {

struct VariantExperiment {
  std::string name;  ///< of the program and of the scenario
  std::string about;
  std::string examples;
  std::vector<std::string> variants;  ///< values of the axis --variants and of the column `variant`
  std::string about_variants;         ///< what they are, for --help
  std::vector<std::string> steps;     ///< default step sizes [s]
  std::vector<std::string> quick_steps;
  double until = 1.0;  ///< [s]
  double quick_until = 1.0;
  int samples = 400;                 ///< about how many of the motion to keep
  std::vector<std::string> summary;  ///< its columns; those of the shared judge follow
  std::vector<std::string> history;
  std::function<Scene<3>(const std::string& variant)> scene;
  /// Fills the row of `summary`, but for the shared judge's cells, and returns the rows of `history`. Runs
  /// keep states and the ledger. Also called for a run that failed.
  std::function<std::vector<Row>(const std::string& variant, const CaseRun<3>& run, Record& summary)>
      tabulate;
};

/// The whole program: runs with implicit_ncp unless the command line says otherwise.
/// @returns the exit code
int run_variant_experiment(const VariantExperiment& what, int argc, char** argv);

}  // namespace touchstone::harness
