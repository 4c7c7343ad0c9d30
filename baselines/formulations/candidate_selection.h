#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "baselines/formulations/candidate_policy.h"
#include "baselines/formulations/contact_candidates.h"
#include "baselines/formulations/polygon_arc.h"
#include "baselines/formulations/reach_bound.h"

namespace touchstone {

/// Chooses the contact candidates of a step by policy. Of a regular polygon only the vertices of an arc are
/// looked at, so a step costs the number of candidates, not of edges.
///
/// The closest points of two smooth bodies are one candidate: `epsilon` may leave it out, the other policies
/// never do.
template <int Dim>
class CandidateSelection {
 public:
  /// @param geometry  must outlive this
  /// @param friction  by pair: largest |p_f| / p_n
  CandidateSelection(const ContactGeometry<Dim>& geometry, const CandidatePolicy& policy,
                     std::vector<double> friction);

  /// Replaces `candidates` by those of a step h [s] from `state`, in ascending order of pair and vertex.
  /// @param free  by body: velocity at the end of the step without contact
  void select(std::span<const BodyState<Dim>> state, std::span<const Twist<Dim>> free, double h,
              std::vector<ContactCandidate<Dim>>& candidates);

 private:
  using State = std::span<const BodyState<Dim>>;
  using Candidates = std::vector<ContactCandidate<Dim>>;
  using Bound = std::optional<ReachBound<Dim>>;  ///< none: any vertex may be reached

  void add_closest_points(int pair, State state, Candidates& candidates) const;
  void add_vertices(int pair, State state, const Bound& bound, double h, Candidates& candidates);
  void keep_nearest(std::size_t first, Candidates& candidates) const;
  [[nodiscard]] Bound bound_of(int body, State state, const Twist<Dim>& free, double h);
  [[nodiscard]] double least_gap(int body, State state, const VerticesAbove<Dim>& vertices) const;
  [[nodiscard]] VertexArc range(int body, State state, const VerticesAbove<Dim>& vertices, const Bound& bound,
                                double h) const;
  [[nodiscard]] bool admits(const ContactPoints<Dim>& points, const Vector<Dim>& center_of_mass,
                            const Bound& bound, double h) const;

  const ContactGeometry<Dim>* geometry_;
  CandidatePolicy policy_;
  std::vector<double> friction_;
  std::vector<PlaneBelow<Dim>> planes_;  // of one body
};

}  // namespace touchstone
