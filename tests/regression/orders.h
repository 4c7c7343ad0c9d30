#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace touchstone::testing {

/// Errors at steps that halve from one to the next fall in proportion to the step: each observed order is in
/// [0.8, 1.25], from both sides.
inline void expect_first_order(const std::vector<double>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double order = std::log2(errors[i - 1] / errors[i]);
    EXPECT_GE(order, 0.8) << errors[i - 1] << " to " << errors[i];
    EXPECT_LE(order, 1.25) << errors[i - 1] << " to " << errors[i];
  }
}

}  // namespace touchstone::testing
