#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/harness/isolation_policy.h"
#include "experiments/harness/journal.h"

namespace touchstone::harness {

/// Runs a case and turns what it throws into a status and a reason: Unsupported -> unsupported, any other
/// exception
/// -> failed. @throws Interrupted
FinishedCase run_one(const Case& one);

/// Runs the cases that `done` does not hold on `jobs` threads, costly ones first, and journals each as it
/// finishes. A case that was stopped by the time limit is not journalled: with more time it may do better.
/// @param name       of the sweep, for the progress line
/// @param isolation  which cases run in processes of their own. Then no other thread may run meanwhile that
///                   holds a lock which a case takes
/// @returns the cases in the order of `cases`, whatever the number of threads; none where it was interrupted
/// @throws IoError if the journal cannot be written
std::vector<std::optional<FinishedCase>> run_sweep(std::span<const Case> cases, const FinishedCases& done,
                                                   int jobs, const std::string& name, Journal& journal,
                                                   const IsolationPolicy& isolation = {});

}  // namespace touchstone::harness
