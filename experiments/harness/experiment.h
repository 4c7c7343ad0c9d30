#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/harness/command_line.h"

/// What an experiment binary consists of. It states its sweep values, its tables and how a selection becomes
/// cases; all else (command line, threads, journal, files, provenance, exit codes) is the same for every
/// experiment.
namespace touchstone::harness {

struct Experiment {
  CommandLineSpec command_line;
  /// Names of the columns between `options` and `h_s`, which CaseId::sweep fills.
  std::vector<std::string> sweep_columns;
  /// The first table gets a row for every case, even for one that failed before it had any.
  std::vector<TableSpec> tables;
  /// Seed of whatever is random; none if nothing is.
  std::optional<long> seed;
  /// @throws InputError if the selection makes no sense
  std::function<std::vector<Case>(const Selection&)> cases;
};

/// The program: parses, runs, writes `table`.csv and `table`.meta.json for every table, and timing.csv and
/// environment.json (which are not compared and not committed) to --out.
/// @returns the exit code: 0 done, 1 a case failed, 2 bad usage or input, 3 I/O, 130 interrupted
int run_experiment(const Experiment& experiment, int argc, const char* const* argv);

}  // namespace touchstone::harness
