#pragma once

#include <mutex>

namespace touchstone::engines {

/// ODE counts its starts and ends in a plain number that all of a process share, the adapter of ODE and
/// DART's detectors alike. To be held by whoever starts or ends it: two threads that start it at once abort.
inline std::mutex& ode_start() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace touchstone::engines
