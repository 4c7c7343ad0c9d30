#include "experiments/harness/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"
#include "experiments/harness/journal.h"
#include "experiments/harness/progress.h"
#include "experiments/harness/provenance.h"
#include "experiments/harness/sweep.h"
#include "experiments/harness/tables.h"

namespace touchstone::harness {

namespace {

namespace fs = std::filesystem;

enum ExitCode { kDone = 0, kCaseFailed = 1, kBadInput = 2, kInputOutput = 3, kInterrupted = 130 };

std::vector<Case> distinct_cases(const Experiment& experiment, const Selection& selection) {
  std::vector<Case> cases = experiment.cases(selection);
  std::set<std::string> keys;
  for (const Case& one : cases) {
    const std::string key = case_key(one.id);
    if (!keys.insert(key).second) {
      throw InputError("case", "'" + key + "' twice", "methods and sweep values that do not repeat a case");
    }
  }
  return cases;
}

std::vector<Case> cases_of(std::span<const Case> cases, const Shard& shard) {
  std::vector<Case> mine;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (shard.contains(i)) mine.push_back(cases[i]);
  }
  return mine;
}

std::map<std::string, std::string> engines_of(std::span<const Case> cases) {
  std::map<std::string, std::string> engines;
  for (const Case& one : cases) {
    if (!one.engine_version.empty()) engines[one.id.method] = one.engine_version;
  }
  return engines;
}

fs::path journal_file(const Selection& selection, const std::string& name) {
  const Shard& shard = selection.shard;
  const std::string part = shard.whole() ? "" : fmt::format(".shard-{}-of-{}", shard.index, shard.count);
  return selection.out / (name + part + ".journal");
}

/// The journals of parts of this sweep in the folder, sorted.
std::vector<fs::path> shard_journals(const fs::path& folder, const std::string& name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with(name + ".shard-") && file.ends_with(".journal")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string describe(const Results& results) {
  std::map<std::string_view, int> counts;
  for (const auto& result : results) {
    if (result) ++counts[to_string(result->result.status)];
  }
  std::vector<std::string> parts;
  for (const auto& [status, count] : counts) parts.push_back(fmt::format("{} {}", count, status));
  return fmt::format("{} cases: {}", results.size(), fmt::join(parts, ", "));
}

void name_failures(const std::string& name, std::span<const Case> cases, const Results& results) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseResult& result = results[i]->result;
    if (result.status != CaseStatus::failed) continue;
    fmt::print(stderr, "{}: failed: {}: {}\n", name, case_key(cases[i].id), result.reason);
  }
}

/// Every table with its .meta.json, timing.csv and environment.json, all at once. @returns a line on what was
/// written
std::string write_tables(const Experiment& experiment, const fs::path& folder, std::span<const Case> cases,
                         const Results& results, const Provenance& provenance, const RunFacts& facts) {
  std::vector<FileContent> files;
  std::vector<std::string> written;
  for (std::size_t i = 0; i < experiment.tables.size(); ++i) {
    const std::string& name = experiment.tables[i].name;
    const Table table = result_table(experiment, i, cases, results);
    files.push_back({folder / (name + ".csv"), format_csv(table)});
    files.push_back({folder / (name + ".meta.json"), meta_json(provenance, name)});
    written.push_back(fmt::format("{} ({} rows)", files[files.size() - 2].path.string(), table.rows.size()));
  }
  files.push_back({folder / "timing.csv", format_csv(timing_table(experiment, cases, results))});
  files.push_back({folder / "environment.json", environment_json(facts)});
  write_files(files);
  return fmt::format("{}", fmt::join(written, ", "));
}

/// Runs this selection's part of the cases and writes what is to be written.
int run_cases(const Experiment& experiment, const Selection& selection, std::span<const Case> all,
              const std::string& typed) {
  const std::string& name = experiment.command_line.name;
  RunFacts facts{typed, selection.jobs, utc_now(), 0.0};
  const Provenance provenance{name, selection.command, engines_of(all), experiment.seed};
  const std::vector<Case> mine = cases_of(all, selection.shard);

  prepare_folder(selection.out);
  const std::string stamp = build_stamp(provenance);
  Journal journal(journal_file(selection, name), stamp);
  FinishedCases done = journal.finished();
  const auto shards = selection.shard.whole() ? shard_journals(selection.out, name) : std::vector<fs::path>{};
  for (const fs::path& file : shards) done.merge(read_journal(file, stamp));
  if (journal.was_stale()) fmt::print(stderr, "{}: a journal of other sources is not used\n", name);
  if (!done.empty()) fmt::print(stderr, "{}: {} finished cases found in journals\n", name, done.size());

  const auto start = std::chrono::steady_clock::now();
  const Results results = run_sweep(mine, done, selection.jobs, name, journal, selection.isolation);
  facts.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  if (std::find(results.begin(), results.end(), std::nullopt) != results.end()) {
    fmt::print(stderr, "{}: interrupted, nothing written; the same command goes on where this one stopped\n",
               name);
    return kInterrupted;
  }
  if (!selection.shard.whole()) {
    fmt::print("{}: part {}/{} done, {}\n", name, selection.shard.index, selection.shard.count,
               describe(results));
  } else {
    const std::string written = write_tables(experiment, selection.out, mine, results, provenance, facts);
    journal.remove();
    for (const fs::path& file : shards) fs::remove(file);
    fmt::print("{}: {} in {}\nwrote {}\n", name, describe(results), format_duration(facts.wall_s), written);
  }
  name_failures(name, mine, results);
  const bool failed = std::any_of(results.begin(), results.end(),
                                  [](const auto& r) { return r->result.status == CaseStatus::failed; });
  return failed ? kCaseFailed : kDone;
}

}  // namespace

int run_experiment(const Experiment& experiment, int argc, const char* const* argv) {
  const std::string& name = experiment.command_line.name;
  const InterruptScope interrupts;
  try {
    const std::optional<Selection> selection = parse_command_line(experiment.command_line, argc, argv);
    if (!selection) return kDone;
    const std::vector<Case> cases = distinct_cases(experiment, *selection);
    if (selection->list) {
      fmt::print("{}", format_csv(case_table(experiment, cases_of(cases, selection->shard))));
      return kDone;
    }
    return run_cases(experiment, *selection, cases, fmt::format("{}", fmt::join(argv, argv + argc, " ")));
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return kBadInput;
  } catch (const IoError& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return kInputOutput;
  } catch (const fs::filesystem_error& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return kInputOutput;
  }
}

}  // namespace touchstone::harness
