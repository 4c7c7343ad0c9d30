#include "core/stepper/warm_start.h"

#include <functional>
#include <type_traits>

namespace touchstone {

namespace {

/// Relative change of a velocity that is rounding: extrapolation would only amplify it.
constexpr double kSteady = 1e-11;

template <int Dim>
std::array<int, 2> key(const ContactPair<Dim>& contact) {
  return {std::min(contact.body_1, contact.body_2), std::max(contact.body_1, contact.body_2)};
}

/// Value at the next of equidistant places of the polynomial through the last `depth` values:
/// sum_j (-1)^j C(depth, j + 1) history[j].
/// @param part  picks what is extrapolated out of an entry
template <typename Entry, unsigned Depth, typename Part>
auto extrapolate(const History<Entry, Depth>& history, int depth, Part part) {
  static_assert(Depth == 4);
  constexpr double kCoefficients[Depth][Depth] = {{1}, {2, -1}, {3, -3, 1}, {4, -6, 4, -1}};
  const double* const c = kCoefficients[depth - 1];
  std::decay_t<std::invoke_result_t<Part, const Entry&>> sum = c[0] * std::invoke(part, history[0]);
  for (unsigned j = 1; j < static_cast<unsigned>(depth); ++j) sum += c[j] * std::invoke(part, history[j]);
  return sum;
}

}  // namespace

template <int Dim>
WarmStart<Dim>::WarmStart(const Scene<Dim>& scene) : velocities_(scene.bodies.size()) {}

template <int Dim>
void WarmStart<Dim>::match(std::span<const ContactPair<Dim>> contacts) {
  if (next_.size() < contacts.size()) {
    next_.resize(contacts.size());
    traces_.resize(contacts.size());
    order_.reserve(contacts.size());
  }
  known_.assign(contacts.size(), kNew);
  std::size_t at = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    while (at < order_.size() && traces_[order_[at]].bodies < key(contacts[i])) ++at;
    if (at < order_.size() && traces_[order_[at]].bodies == key(contacts[i])) known_[i] = order_[at];
  }
}

template <int Dim>
int WarmStart<Dim>::depth(std::span<const int> bodies, std::span<const std::size_t> contacts) const {
  int depth = kDepth;
  for (const std::size_t i : contacts)
    depth = std::min(depth, knows(i) ? traces_[known_[i]].solutions.count() : 0);
  bool steady = true;
  for (const int body : bodies) {
    const VelocityTrace& trace = velocities_[static_cast<std::size_t>(body)];
    depth = std::min(depth, trace.velocities.count());
    steady = steady && trace.steady;
  }
  return steady ? std::min(depth, 1) : depth;
}

template <int Dim>
Twist<Dim> WarmStart<Dim>::velocity(int body, int depth) const {
  return extrapolate(velocities_[static_cast<std::size_t>(body)].velocities, depth, std::identity{});
}

template <int Dim>
const ContactSolution<Dim>& WarmStart<Dim>::contact(std::size_t contact, int depth) {
  using Solution = ContactSolution<Dim>;
  const auto& solutions = traces_[known_[contact]].solutions;
  const Solution& latest = solutions[0];
  if (depth <= 1) return latest;
  extrapolated_.a_1 = extrapolate(solutions, depth, &Solution::a_1);
  extrapolated_.a_2 = extrapolate(solutions, depth, &Solution::a_2);
  extrapolated_.normal = latest.normal;
  extrapolated_.s = latest.s;
  extrapolated_.multipliers = latest.multipliers;
  extrapolated_.p = extrapolate(solutions, depth, &Solution::p);
  extrapolated_.y = extrapolate(solutions, depth, &Solution::y);
  if (!(extrapolated_.p > 0)) {  // about to open: the last impulse leaves that to the search
    extrapolated_.p = latest.p;
    extrapolated_.y = latest.y;
  }
  return extrapolated_;
}

template <int Dim>
void WarmStart<Dim>::accept(std::span<const ContactPair<Dim>> contacts,
                            std::span<const BodyState<Dim>> state) {
  taken_.assign(traces_.size(), false);
  for (const std::size_t trace : known_) {
    if (trace != kNew) taken_[trace] = true;
  }
  order_.clear();
  std::size_t free = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (known_[i] == kNew) {
      while (taken_[free]) ++free;
      known_[i] = free++;
      traces_[known_[i]].solutions.clear();
    }
    order_.push_back(known_[i]);
    ContactTrace& trace = traces_[known_[i]];
    trace.bodies = key(contacts[i]);
    const bool closed = next_[i].p > 0;
    if (trace.solutions.count() > 0 && (trace.solutions[0].p > 0) != closed) trace.solutions.clear();
    std::swap(trace.solutions.push(), next_[i]);
  }
  for (std::size_t body = 0; body < state.size(); ++body) {
    VelocityTrace& trace = velocities_[body];
    const Twist<Dim>& velocity = state[body].velocity;
    trace.steady =
        trace.velocities.count() > 0 && (velocity - trace.velocities[0]).norm() <= kSteady * velocity.norm();
    trace.velocities.push() = velocity;
  }
}

template class WarmStart<2>;
template class WarmStart<3>;

}  // namespace touchstone
