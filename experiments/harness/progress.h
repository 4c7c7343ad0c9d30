#pragma once

#include <chrono>
#include <cstdio>
#include <string>

/// A line on stderr for whoever waits: cases done, time gone, time left.
namespace touchstone::harness {

/// "12.3 s", "4 min 05 s", "2 h 07 min".
std::string format_duration(double seconds);

class Progress {
 public:
  /// @param total_cost  of all the cases to be run, in the unit of Case::cost
  Progress(std::string name, int total_cases, double total_cost, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the state of things if it is time to: not within the first second, so that a short run says
  /// nothing; then often on a terminal (one line, rewritten), seldom elsewhere (a plain line each time).
  void show(int done_cases, double done_cost);

 private:
  using Clock = std::chrono::steady_clock;

  std::string name_;
  int total_cases_;
  double total_cost_;
  std::FILE* out_;
  bool terminal_;
  bool line_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace touchstone::harness
