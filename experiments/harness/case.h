#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/harness/csv.h"

/// A case is scenario x method x parameters; a sweep is a list of cases, and each gives a row whatever became
/// of it.
namespace touchstone::harness {

enum class CaseStatus {
  ok,           ///< ran to its horizon
  failed,       ///< a step failed, the state was not finite, or something threw; the reason says which
  unsupported,  ///< the method cannot represent the scene
  skipped,      ///< not run on purpose; the reason says why
};
std::string_view to_string(CaseStatus status);
/// @throws InputError if `text` names none
CaseStatus parse_case_status(std::string_view text);

/// What tells a case from every other of its experiment.
struct CaseId {
  std::string scenario;
  std::string method;
  std::string options;  ///< "a=1;b=2", every option in force
  Row sweep;            ///< one cell a sweep column of the experiment
  double h = 0.0;       ///< step [s]; NaN for a truth that has none
  double until = 0.0;   ///< horizon [s]

  /// The cells scenario, method, options, <sweep columns>, h_s, until_s.
  [[nodiscard]] Row cells() const;
};

/// What a case gives: for each table of the experiment its rows, without the columns that every table begins
/// with.
struct CaseResult {
  CaseStatus status = CaseStatus::ok;
  std::string reason;  ///< empty if ok
  std::vector<std::vector<Row>> tables;
};

struct Case {
  CaseId id;
  double cost =
      1.0;  ///< guess of the work, in any unit; costly cases start first, and the time left is told by it
  std::string engine_version;  ///< of the library behind the method; empty if there is none. A case with a
                               ///< library runs in a process of its own (IsolationPolicy)
  std::function<CaseResult()> run;  ///< may throw; called from any thread, at most once
};

/// One CSV of an experiment: `name`.csv, whose columns follow those that every table begins with.
struct TableSpec {
  std::string name;
  std::vector<std::string> columns;
};

/// A finished case as it is kept: its result and what it took.
struct FinishedCase {
  CaseResult result;
  double wall_s = 0.0;
  bool timed_out = false;  ///< stopped by the time limit
};

}  // namespace touchstone::harness
