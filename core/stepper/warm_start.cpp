#include "core/stepper/warm_start.h"

#include <algorithm>

namespace touchstone {

namespace {

/// Relative change of a velocity that is rounding: extrapolation would only amplify it.
constexpr double kSteady = 1e-11;

template <int Dim>
std::array<int, 2> key(const ContactPair<Dim>& contact) {
  return {std::min(contact.body_1, contact.body_2), std::max(contact.body_1, contact.body_2)};
}

/// Value at the next of equidistant places of the polynomial through the last `depth` values, latest first.
template <typename Value>
Value extrapolate(const Value& a, const Value& b, const Value& c, int depth) {
  if (depth == 1) return a;
  if (depth == 2) return Value(2 * a - b);
  return Value(3 * a - 3 * b + c);
}

}  // namespace

template <int Dim>
WarmStart<Dim>::WarmStart(const Scene<Dim>& scene) : velocities_(scene.bodies.size()) {}

template <int Dim>
void WarmStart<Dim>::match(std::span<const ContactPair<Dim>> contacts) {
  if (next_.size() < contacts.size()) {
    next_.resize(contacts.size());
    traces_.resize(contacts.size());
    new_traces_.resize(contacts.size());
  }
  known_.assign(contacts.size(), nullptr);
  std::size_t at = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    while (at < trace_count_ && traces_[at].bodies < key(contacts[i])) ++at;
    if (at < trace_count_ && traces_[at].bodies == key(contacts[i])) known_[i] = &traces_[at];
  }
}

template <int Dim>
int WarmStart<Dim>::depth(std::span<const int> bodies, std::span<const std::size_t> contacts) const {
  int depth = kDepth;
  for (const std::size_t i : contacts) depth = std::min(depth, known_[i] == nullptr ? 0 : known_[i]->count);
  bool steady = true;
  for (const int body : bodies) {
    const VelocityTrace& trace = velocities_[static_cast<std::size_t>(body)];
    depth = std::min(depth, trace.count);
    steady = steady && trace.steady;
  }
  return steady ? std::min(depth, 1) : depth;
}

template <int Dim>
Twist<Dim> WarmStart<Dim>::velocity(int body, int depth) const {
  const auto& last = velocities_[static_cast<std::size_t>(body)].last;
  return extrapolate(last[0], last[1], last[2], depth);
}

template <int Dim>
const ContactSolution<Dim>& WarmStart<Dim>::contact(std::size_t contact, int depth) {
  const auto& [a, b, c] = known_[contact]->last;
  if (depth <= 1) return a;
  extrapolated_.a_1 = extrapolate(a.a_1, b.a_1, c.a_1, depth);
  extrapolated_.a_2 = extrapolate(a.a_2, b.a_2, c.a_2, depth);
  extrapolated_.normal = a.normal;
  extrapolated_.s = a.s;
  extrapolated_.multipliers = a.multipliers;
  extrapolated_.p = extrapolate(a.p, b.p, c.p, depth);
  extrapolated_.y = extrapolate(a.y, b.y, c.y, depth);
  if (!(extrapolated_.p > 0)) {  // about to open: the last impulse leaves that to the search
    extrapolated_.p = a.p;
    extrapolated_.y = a.y;
  }
  return extrapolated_;
}

template <int Dim>
void WarmStart<Dim>::accept(std::span<const ContactPair<Dim>> contacts,
                            std::span<const BodyState<Dim>> state) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Trace& trace = new_traces_[i];
    if (known_[i] != nullptr) {
      std::swap(trace, *known_[i]);
    } else {
      trace.count = 0;
    }
    trace.bodies = key(contacts[i]);
    const bool closed = next_[i].p > 0;
    if (trace.count > 0 && (trace.last[0].p > 0) != closed) trace.count = 0;
    std::rotate(trace.last.begin(), trace.last.end() - 1, trace.last.end());
    std::swap(trace.last[0], next_[i]);
    trace.count = std::min(trace.count + 1, kDepth);
  }
  std::swap(traces_, new_traces_);
  trace_count_ = contacts.size();
  known_.clear();
  for (std::size_t body = 0; body < state.size(); ++body) {
    VelocityTrace& trace = velocities_[body];
    const Twist<Dim>& velocity = state[body].velocity;
    trace.steady = (velocity - trace.last[0]).norm() <= kSteady * velocity.norm();
    std::rotate(trace.last.begin(), trace.last.end() - 1, trace.last.end());
    trace.last[0] = velocity;
    trace.count = std::min(trace.count + 1, kDepth);
  }
}

template class WarmStart<2>;
template class WarmStart<3>;

}  // namespace touchstone
