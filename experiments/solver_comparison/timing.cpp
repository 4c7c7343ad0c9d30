#include "experiments/solver_comparison/timing.h"

#include <algorithm>
#include <array>
#include <ctime>

namespace touchstone::solver_comparison {

double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double clock_seconds() {
  static const double seconds = [] {
    std::array<double, 101> times{};
    for (double& time : times) {
      const double start = thread_seconds();
      time = thread_seconds() - start;
    }
    std::ranges::nth_element(times, times.begin() + times.size() / 2);
    return times[times.size() / 2];
  }();
  return seconds;
}

}  // namespace touchstone::solver_comparison
