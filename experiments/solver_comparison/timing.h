#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace touchstone::solver_comparison {

/// Processor time of the calling thread [s]: what others do on the machine at the same time does not count.
[[nodiscard]] double thread_seconds();

/// What reading the clock twice adds to a measurement [s].
[[nodiscard]] double clock_seconds();

/// Processor time that `work` takes [s], >= 0.
template <typename Work>
double time_of(const Work& work) {
  const double start = thread_seconds();
  work();
  return std::max(thread_seconds() - start - clock_seconds(), 0.0);
}

/// Time of one solve [s]: `first`, if that was long; else the median of so many repetitions by `solve`, which
/// returns what it took, as make 5 ms together, 3 to 101 of them.
template <typename Solve>
double typical_time(double first, const Solve& solve) {
  constexpr double kEnough = 5e-3;
  constexpr std::size_t kFewest = 3, kMost = 101;
  if (first > kEnough) return first;
  std::vector<double> times;
  for (double total = 0; times.size() < kMost && (total < kEnough || times.size() < kFewest);) {
    times.push_back(solve());
    total += times.back();
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace touchstone::solver_comparison
