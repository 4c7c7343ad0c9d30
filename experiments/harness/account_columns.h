#pragma once

#include <string>
#include <vector>

#include "experiments/harness/record.h"
#include "experiments/harness/run_case.h"

/// What the shared judge says of a run, in columns that are the same in every experiment which keeps its
/// steps.
namespace touchstone::harness {

/// friction_loss_J, impact_loss_J, energy_drift_J of the energy ledger, largest_penetration_m, the residual
/// of Eqs. 10-11 and its parts, steps, iterations, failed_steps.
std::vector<std::string> account_columns();

/// @param run  with kept steps
template <int Dim>
void set_account(Record& record, const CaseRun<Dim>& run);

}  // namespace touchstone::harness
