#include "experiments/solver_comparison/timing.h"

#include <algorithm>
#include <ctime>
#include <limits>

namespace touchstone::solver_comparison {

double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double clock_seconds() {
  constexpr int kReadings = 5;
  thread_local double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kReadings; ++i) {
    const double start = thread_seconds();
    least = std::min(least, thread_seconds() - start);
  }
  return least;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace touchstone::solver_comparison
