#pragma once

#include <algorithm>
#include <vector>

namespace touchstone::solver_comparison {

/// Processor time of the calling thread [s]: what others do on the machine at the same time does not count.
[[nodiscard]] double thread_seconds();

/// What reading the clock twice adds to a measurement [s]: the least seen so far, a few readings of now among
/// it. A machine's pace changes; a value from slower times would take more than there is from a short one.
[[nodiscard]] double clock_seconds();

/// The least step of thread_seconds() [s].
constexpr double kClockResolution = 1e-9;

/// Processor time that `work` takes [s], a step of the clock at least: times are divided by.
template <typename Work>
double time_of(const Work& work) {
  const double start = thread_seconds();
  work();
  const double seconds = thread_seconds() - start;
  return std::max(seconds - clock_seconds(), kClockResolution);
}

/// Time of one solve [s]: `first`, if that was longer than `enough`; else the least of so many repetitions by
/// `solve`, which returns what it took, as make `enough` together, 3 to 101 of them. What else goes on in the
/// machine can only add to a time.
template <typename Solve>
double least_time(double first, double enough, const Solve& solve) {
  constexpr int kFewest = 3, kMost = 101;
  if (first > enough) return first;
  double least = first;
  double total = 0;
  for (int i = 0; i < kMost && (total < enough || i < kFewest); ++i) {
    const double time = solve();
    least = std::min(least, time);
    total += time;
  }
  return least;
}

/// @param values  one at least; of an even number of them the upper one of the two in the middle
[[nodiscard]] double median(std::vector<double> values);

}  // namespace touchstone::solver_comparison
