#pragma once

#include <signal.h>

#include <array>

/// Ctrl-C and its kin, so that a sweep can stop between two steps with nothing half done.
namespace touchstone::harness {

/// Thrown by work that stopped because interrupt_requested().
struct Interrupted {};

inline constexpr std::array kInterruptSignals = {SIGINT, SIGTERM, SIGHUP};

/// While in scope a first SIGINT, SIGTERM or SIGHUP only sets a flag; a second one ends the program at once.
/// A SIGHUP that was ignored before (nohup) stays ignored.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  std::array<struct sigaction, kInterruptSignals.size()> before_;
};

/// Holds those signals back from this thread, and from the threads that it starts, while in scope.
class InterruptBlock {
 public:
  InterruptBlock();
  ~InterruptBlock();
  InterruptBlock(const InterruptBlock&) = delete;
  InterruptBlock& operator=(const InterruptBlock&) = delete;

 private:
  sigset_t before_;
};

/// Whether such a signal came since the scope began. Cheap enough for every step.
[[nodiscard]] bool interrupt_requested();

/// @throws Interrupted if interrupt_requested()
inline void throw_if_interrupted() {
  if (interrupt_requested()) throw Interrupted{};
}

}  // namespace touchstone::harness
