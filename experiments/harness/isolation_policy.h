#pragma once

#include <chrono>

#include "experiments/harness/case.h"

/// Which cases of a sweep run in processes of their own, where a crash or a hang costs that case alone.
namespace touchstone::harness {

enum class Isolate {
  automatic,  ///< those with a library behind their method
  always,
  never,  ///< for a debugger
};

struct IsolationPolicy {
  Isolate isolate = Isolate::automatic;
  std::chrono::duration<double> time_limit{600};  ///< wall time of an isolated case [s]

  [[nodiscard]] bool applies_to(const Case& one) const {
    return isolate == Isolate::always || (isolate == Isolate::automatic && !one.engine_version.empty());
  }
};

}  // namespace touchstone::harness
