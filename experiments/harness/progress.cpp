#include "experiments/harness/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

namespace touchstone::harness {

using namespace std::chrono_literals;

std::string format_duration(double seconds) {
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::string name, int total_cases, double total_cost, std::FILE* out)
    : name_(std::move(name)),
      total_cases_(total_cases),
      total_cost_(total_cost),
      out_(out),
      terminal_(::isatty(::fileno(out)) != 0),
      next_(start_ + 1s) {}

Progress::~Progress() {
  if (line_open_) fmt::print(out_, "\n");
}

void Progress::show(int done_cases, double done_cost) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? 500ms : 5000ms);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string left =
      done_cost > 0 ? format_duration(elapsed * (total_cost_ - done_cost) / done_cost) : "unknown";
  const std::string line = fmt::format("{}: {}/{} cases, {} gone, about {} left", name_, done_cases,
                                       total_cases_, format_duration(elapsed), left);
  // The escape clears what a longer line before it left on the terminal.
  fmt::print(out_, "{}{}{}", terminal_ ? "\r\x1b[K" : "", line, terminal_ ? "" : "\n");
  std::fflush(out_);
  line_open_ = terminal_;
}

}  // namespace touchstone::harness
