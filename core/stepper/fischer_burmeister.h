#pragma once

#include <cmath>

namespace touchstone {

/// a + b - sqrt(a^2 + b^2 + 2 tau^2), zero exactly where 0 <= a _|_ b >= 0 if tau is 0 (Fischer 1992), and
/// where a, b > 0 and a b = tau^2 otherwise (Kanzow 1996).
struct FischerBurmeisterTerm {
  FischerBurmeisterTerm(double a, double b, double tau) {
    const double length = tau > 0 ? std::hypot(a, b, std::sqrt(2.0) * tau) : std::hypot(a, b);
    value = a + b - length;
    const double kink = 1 - std::sqrt(0.5);  // a generalised derivative where there is none
    by_unknown = length > 0 ? 1 - a / length : kink;
    by_row = length > 0 ? 1 - b / length : kink;
  }
  double value, by_unknown, by_row;
};

}  // namespace touchstone
