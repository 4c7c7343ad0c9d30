#pragma once

#include <map>
#include <optional>
#include <string>

/// Where a result comes from. What is committed beside it is the same from every run of the same sources;
/// what belongs to one run goes to a file of its own that git ignores.
namespace touchstone::harness {

struct Provenance {
  std::string experiment;
  std::string
      command;  ///< with every option that matters to the result, defaults included; no --jobs, no --out
  std::map<std::string, std::string> engines;  ///< method key -> version of the library behind it
  std::optional<long> seed;                    ///< none where nothing is random
};

/// What belongs to one run.
struct RunFacts {
  std::string command_line;  ///< as it was typed
  int jobs = 1;
  std::string started;  ///< UTC, ISO 8601
  double wall_s = 0.0;
};

/// The text of `table`.meta.json: experiment, table, command, seed, versions of Eigen, fmt and engines, and
/// git's tree ids of core, baselines and experiments as the program was built from them ("unknown" without
/// git).
std::string meta_json(const Provenance& provenance, const std::string& table);

/// The text of environment.json: host, processor count, compiler, build type, flags, commit, whether the
/// sources had changes that were not committed, and the facts of the run.
std::string environment_json(const RunFacts& facts);

/// Stands for everything that may change a result but is no parameter of a case: the sources, the compiler
/// and its flags, the versions of libraries. Equal stamps mean that finished cases may be used again.
std::string build_stamp(const Provenance& provenance);

/// Now, UTC, as 2026-01-31T23:59:59Z.
std::string utc_now();

}  // namespace touchstone::harness
