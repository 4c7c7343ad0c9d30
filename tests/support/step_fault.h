#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/stepper/implicit_stepper.h"

namespace touchstone {

struct StepFault {
  std::string description;
  bool is_rounding =
      false;  ///< of the numbers that tell the answer, and nothing beyond (certificate::Missed)
};

/// What the checker says against the last step of `stepper`, multipliers included; nothing if it is
/// certified.
/// @param before     states at the start of the step
/// @param tolerance  without unit, see certificate::Report
template <int Dim>
std::optional<StepFault> step_fault(const ImplicitStepper<Dim>& stepper,
                                    const std::vector<BodyState<Dim>>& before, double h, double tolerance) {
  std::vector<std::array<std::vector<double>, 2>> multipliers;
  for (std::size_t i = 0; i < stepper.contacts().size(); ++i) {
    const std::vector<double>& both = stepper.contact_solution(i).multipliers;
    const auto body = static_cast<std::size_t>(stepper.contacts()[i].body_a);
    const auto surface = make_surface(stepper.scene().bodies[body].shape);
    const auto first = make_side(*surface).multipliers();
    multipliers.push_back({std::vector<double>(both.begin(), both.begin() + first),
                           std::vector<double>(both.begin() + first, both.end())});
  }
  const certificate::Checker<Dim> checker(stepper.scene());
  const certificate::Step<Dim> answer{before, stepper.state(), stepper.contacts(), stepper.joints(),
                                      h,      multipliers};
  const certificate::Report report = checker.certify(answer);
  if (report.holds(tolerance)) return std::nullopt;
  return StepFault{checker.describe(report, answer), report.holds_but_for_rounding(tolerance)};
}

}  // namespace touchstone
