#pragma once

#include <string>
#include <vector>

#include "experiments/harness/record.h"
#include "experiments/harness/run_case.h"

/// What the shared judge says of a run, in columns that are the same in every experiment which books energy.
namespace touchstone::harness {

/// initial_energy_J, energy_change_J; applied_work_J, friction_loss_J, impact_loss_J, energy_drift_J of the
/// energy ledger; largest_penetration_m; the residual of Eqs. 10-11 and its parts; steps, unsolved_steps,
/// iterations, failed_steps.
std::vector<std::string> account_columns();

/// `columns` and then account_columns().
std::vector<std::string> with_account(std::vector<std::string> columns);

/// The ledger's columns stay empty for a method that does not tell its impulses: all would be drift.
/// @param run  whose energy was booked
template <int Dim>
void set_account(Record& record, const CaseRun<Dim>& run);

}  // namespace touchstone::harness
