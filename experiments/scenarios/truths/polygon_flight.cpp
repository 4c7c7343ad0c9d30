#include "experiments/scenarios/truths/polygon_flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::truth::polygon {
namespace {

constexpr double pi = std::numbers::pi;

class Flight {
 public:
  Flight(const PolygonParameters& body, const PlanarMotion& start)
      : body_(body),
        start_(start),
        pull_(body.circumradius * start.omega * start.omega),
        fastest_fall_(body.gravity + pull_) {}

  [[nodiscard]] double alpha(long long k, double t) const {
    return std::remainder(start_.theta + start_.omega * t + 2.0 * pi * static_cast<double>(k) / body_.edges,
                          2.0 * pi);
  }

  [[nodiscard]] double height(long long k, double t) const {
    return start_.y + (start_.vy - 0.5 * body_.gravity * t) * t - body_.circumradius * std::cos(alpha(k, t));
  }

  /// First time at which vertex k is down, or `limit` if that comes first.
  [[nodiscard]] double first_down(long long k, double limit) const {
    double t = height(k, 0.0) <= on_ground() ? surely_up(alpha(k, 0.0)) : 0.0;
    for (int iteration = 0; iteration < 500 && t < limit; ++iteration) {
      const double gap = height(k, t);
      const double rate =
          start_.vy - body_.gravity * t + body_.circumradius * start_.omega * std::sin(alpha(k, t));
      if (gap <= 0.0 && rate <= 0.0) return t;
      const double root = std::sqrt(rate * rate + 2.0 * fastest_fall_ * std::max(gap, 0.0));
      const double step = rate > 0.0 ? (rate + root) / fastest_fall_ : 2.0 * gap / (root - rate);
      t += step;
      if (!(step > 1e-16 * (1.0 + t))) return t;
    }
    return std::min(t, limit);
  }

  [[nodiscard]] double on_ground() const { return 1e-12 * body_.circumradius; }

 private:
  /// Until when a vertex that is just leaving the ground cannot be back: its
  /// acceleration R omega^2 cos(alpha) - g is upward while |alpha| < arccos(g / (R
  /// omega^2)). At a smooth lift-off it is at that limit, to rounding.
  [[nodiscard]] double surely_up(double alpha) const {
    if (pull_ <= body_.gravity) return 0.0;
    const double limit = std::acos(body_.gravity / pull_);
    if (std::abs(alpha) > limit + 1e-7) return 0.0;
    return std::max(0.0, (limit - std::copysign(1.0, start_.omega) * alpha) / std::abs(start_.omega));
  }

  const PolygonParameters& body_;
  const PlanarMotion& start_;
  double pull_;          ///< R omega^2
  double fastest_fall_;  ///< bound of a vertex's downward acceleration
};

}  // namespace

PlanarMotion flown(const PolygonParameters& body, PlanarMotion m, double elapsed) {
  m.x += m.vx * elapsed;
  m.y += (m.vy - 0.5 * body.gravity * elapsed) * elapsed;
  m.vy -= body.gravity * elapsed;
  m.theta += m.omega * elapsed;
  return m;
}

std::optional<TouchDown> touch_down(const PolygonParameters& body, const PlanarMotion& start,
                                    double horizon) {
  const Flight flight(body, start);
  const auto lowest_at = [&](double t) {
    return -std::llround((start.theta + start.omega * t) * body.edges / (2.0 * pi));
  };
  // From the vertex that is lowest now outwards: the first
  // ones give a bound that disposes of the others quickly.
  const long long first = lowest_at(0.0);
  double earliest = horizon;
  for (long long i = 0; i < body.edges; ++i) {
    const long long offset = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
    earliest = std::min(earliest, flight.first_down(first + offset, earliest));
  }
  if (earliest >= horizon) return std::nullopt;
  TouchDown result{.elapsed = earliest, .touching = {}};
  const long long lowest = lowest_at(earliest);
  result.touching.push_back({lowest, flight.alpha(lowest, earliest)});
  for (const long long neighbour : {lowest - 1, lowest + 1}) {
    const double lag = flight.height(neighbour, earliest) - flight.height(lowest, earliest);
    if (result.touching.size() < 2 && lag <= flight.on_ground()) {
      // An edge: its ends are at exactly +-pi/N, which tells
      // a rock that starts there from a turn that ends there.
      const double alpha = neighbour > lowest ? pi / body.edges : -pi / body.edges;
      result.touching.front().alpha = -alpha;
      result.touching.push_back({neighbour, alpha});
    }
  }
  return result;
}

}  // namespace touchstone::truth::polygon
