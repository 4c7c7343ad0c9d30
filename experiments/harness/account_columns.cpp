#include "experiments/harness/account_columns.h"

namespace touchstone::harness {

std::vector<std::string> account_columns() {
  return {"initial_energy_J",
          "energy_change_J",
          "applied_work_J",
          "friction_loss_J",
          "impact_loss_J",
          "energy_drift_J",
          "largest_penetration_m",
          "largest_residual",
          "dynamics_residual",
          "kinematics_residual",
          "contact_residual",
          "friction_residual",
          "steps",
          "unsolved_steps",
          "iterations",
          "failed_steps"};
}

std::vector<std::string> with_account(std::vector<std::string> columns) {
  const std::vector<std::string> account = account_columns();
  columns.insert(columns.end(), account.begin(), account.end());
  return columns;
}

template <int Dim>
void set_account(Record& record, const CaseRun<Dim>& run) {
  record.set("initial_energy_J", run.initial.total())
      .set("energy_change_J", run.final.total() - run.initial.total());
  if (run.impulses) {
    record.set("applied_work_J", run.account.applied_work)
        .set("friction_loss_J", run.account.friction_loss)
        .set("impact_loss_J", run.account.impact_loss)
        .set("energy_drift_J", run.account.drift);
  }
  record.set("largest_penetration_m", run.largest_penetration)
      .set("largest_residual", run.residual.largest())
      .set("dynamics_residual", run.residual.dynamics)
      .set("kinematics_residual", run.residual.kinematics)
      .set("contact_residual", run.residual.contact)
      .set("friction_residual", run.residual.friction);
  record.set("steps", run.steps)
      .set("unsolved_steps", run.planned_steps - run.steps)
      .set("iterations", run.iterations)
      .set("failed_steps", run.failed_steps);
}

template void set_account(Record&, const CaseRun<2>&);
template void set_account(Record&, const CaseRun<3>&);

}  // namespace touchstone::harness
