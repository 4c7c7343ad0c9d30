#pragma once

#include <optional>
#include <span>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/harness/experiment.h"

/// From cases and their results to the tables that are written.
namespace touchstone::harness {

/// A case that was not run has none.
using Results = std::vector<std::optional<FinishedCase>>;

/// `experiment,scenario,method,options,<sweep columns>,h_s,until_s`: what a case is known by.
Row identity_columns(const Experiment& experiment);

/// Table `index` of the experiment: identity, status, reason and its own columns, sorted; the first table has
/// a row for every case, with empty cells where a case has nothing to say.
/// @param results  one a case, in the order of `cases`, none missing
Table result_table(const Experiment& experiment, std::size_t index, std::span<const Case> cases,
                   const Results& results);

/// Identity, status and wall time of every case.
Table timing_table(const Experiment& experiment, std::span<const Case> cases, const Results& results);

/// The identities alone, for --list, in the order of `cases`.
Table case_table(const Experiment& experiment, std::span<const Case> cases);

}  // namespace touchstone::harness
