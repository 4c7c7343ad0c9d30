#pragma once

#include "core/stepper/contact_rows.h"

/// What contact_rows.cpp and contact_load_rows.cpp have in common.
namespace touchstone {

/// The arguments that every row function needs.
template <int Dim, typename Derivative>
struct RowContext {
  const ContactPair<Dim>& pair;
  const PreparedContact<Dim>& prepared;
  const ContactLayout& at;
  const ContactRowOptions& options;
  const ContactState<Dim>& state;
  Eigen::VectorXd& f;
  Derivative* derivative;  ///< null if only rows are wanted

  [[nodiscard]] const Side<Dim>& side(std::size_t k) const { return k == 0 ? pair.side_1 : pair.side_2; }
};

/// The rows that hold impulses or that impulses are paired with: gap, friction (and sigma), and the wrench in
/// the bodies' momentum rows.
/// @tparam Derivative  ContactJacobian or MotionJacobian
template <int Dim, typename Derivative>
void load_rows(const RowContext<Dim, Derivative>& context);

}  // namespace touchstone
