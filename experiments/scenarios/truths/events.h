#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "experiments/scenarios/truths/dense_step.h"

namespace touchstone::truth {

struct FiredEvent {
  std::size_t index = 0;
  double t = 0.0;
};

/// Watches M functions g_i(t, y(t)) along a trajectory for the first that FALLS through zero.
///
/// An armed event fires as soon as it is negative, a start value of rounding size included. One that
/// is not armed waits until it has been seen positive: so "slip back to zero" can be watched from an
/// instant at which slip is zero. Each function is looked at in every collocation node of a step;
/// where three neighbouring values show a minimum that may lie below zero, the minimum itself is
/// sought, so that a short excursion between two nodes is not missed (except within the last 1.3 %
/// of a step, where it would have to be shorter than that).
template <int N, std::size_t M>
class EventWatch {
 public:
  using Values = std::array<double, M>;

  EventWatch(const std::array<bool, M>& armed, const Values& initial) : armed_(armed), initial_(initial) {
    for (std::size_t i = 0; i < M; ++i) {
      if (initial_[i] > 0.0) armed_[i] = true;
      if (armed_[i]) initial_[i] = std::max(initial_[i], 0.0);
    }
  }

  /// The earliest event on [step.begin(), end], to rounding in t, or none. Arms and remembers as it goes.
  template <class Events>
  [[nodiscard]] std::optional<FiredEvent> first(const DenseStep<N>& step, double end, const Events& events) {
    if constexpr (M == 0) return std::nullopt;
    const auto& node = GaussRule<DenseStep<N>::stages>::instance().node;
    std::array<double, samples> t{};
    std::array<Values, samples> g{};
    t[0] = step.begin();
    g[0] = initial_;
    for (std::size_t k = 1; k < samples; ++k) {
      t[k] = k + 1 < samples ? step.begin() + (step.end() - step.begin()) * node[k - 1] : end;
      if (t[k] > end) t[k] = end;
      g[k] = events(t[k], step(t[k]));
    }
    std::optional<FiredEvent> earliest;
    for (std::size_t i = 0; i < M; ++i) {
      std::array<double, samples> values{};
      for (std::size_t k = 0; k < samples; ++k) values[k] = g[k][i];
      const auto value = [&](double time) { return events(time, step(time))[i]; };
      const std::optional<double> root = first_fall(t, values, armed_[i], value);
      if (root && (!earliest || *root < earliest->t)) earliest = FiredEvent{i, *root};
    }
    initial_ = g[samples - 1];
    return earliest;
  }

 private:
  static constexpr std::size_t samples = DenseStep<N>::stages + 2;  // both ends and the nodes
  using Samples = std::array<double, samples>;

  template <class Value>
  static std::optional<double> first_fall(const Samples& t, const Samples& g, bool& armed,
                                          const Value& value) {
    for (std::size_t k = 1; k < samples; ++k) {
      if (armed && g[k] < 0.0) return bisected(t[k - 1], t[k], value);
      if (armed && k + 1 < samples && may_dip(t, g, k)) {
        const double lowest = minimiser(t[k - 1], t[k + 1], value);
        if (value(lowest) < 0.0) return bisected(t[k - 1], lowest, value);
      }
      if (g[k] > 0.0) armed = true;
    }
    return std::nullopt;
  }

  /// Does the parabola through three samples have its minimum
  /// between them, and less than half the middle one?
  static bool may_dip(const Samples& t, const Samples& g, std::size_t k) {
    if (!(g[k] < g[k - 1] && g[k] <= g[k + 1])) return false;
    const double left = (g[k] - g[k - 1]) / (t[k] - t[k - 1]);
    const double right = (g[k + 1] - g[k]) / (t[k + 1] - t[k]);
    const double curvature = (right - left) / (t[k + 1] - t[k - 1]);
    const double slope = left + curvature * (t[k] - t[k - 1]);
    return g[k] - slope * slope / (4.0 * curvature) < 0.5 * g[k];
  }

  /// Golden-section search; a minimum is flat, so sqrt(rounding) is as near as it can be placed.
  template <class Value>
  static double minimiser(double a, double b, const Value& value) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double left = b - golden * (b - a);
    double right = a + golden * (b - a);
    double at_left = value(left);
    double at_right = value(right);
    for (int iteration = 0; iteration < 45; ++iteration) {
      if (at_left < at_right) {
        b = right, right = left, at_right = at_left;
        left = b - golden * (b - a), at_left = value(left);
      } else {
        a = left, left = right, at_left = at_right;
        right = a + golden * (b - a), at_right = value(right);
      }
    }
    return 0.5 * (a + b);
  }

  /// The last time at which the function is not negative, by bisection to the
  /// last bit: value(a) >= 0 > value(b). The polynomial is a few dozen
  /// operations, so a faster root finder would save nothing that shows.
  template <class Value>
  static double bisected(double a, double b, const Value& value) {
    for (int iteration = 0; iteration < 80; ++iteration) {
      const double middle = 0.5 * (a + b);
      if (!(middle > a && middle < b)) break;
      (value(middle) < 0.0 ? b : a) = middle;
    }
    return b;
  }

  std::array<bool, M> armed_;
  Values initial_;
};

}  // namespace touchstone::truth
