#pragma once

#include <string>
#include <vector>

#include "experiments/harness/record.h"
#include "experiments/harness/run_case.h"

/// What the summary of an experiment tells of every case: where the energy went, by how much its steps miss
/// Eqs. 10-11, and how many were solved.
namespace touchstone::harness {

/// initial_energy_J, energy_change_J, friction_loss_J, impact_loss_J, drift_J, largest_penetration_m,
/// largest_residual, dynamics_residual, kinematics_residual, contact_residual, friction_residual, steps,
/// unsolved_steps, iterations.
const std::vector<std::string>& account_columns();

/// `columns` and then account_columns().
std::vector<std::string> with_account(std::vector<std::string> columns);

/// Fills them from a run that was made with RunOptions::ledger. The losses stay empty for a method that does
/// not tell its impulses: all of them would be drift.
template <int Dim>
void set_account(Record& record, const CaseRun<Dim>& run);

}  // namespace touchstone::harness
