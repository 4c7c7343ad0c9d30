#include "experiments/harness/interrupt.h"

#include <atomic>
#include <cstddef>

namespace touchstone::harness {

namespace {

// A signal handler can reach nothing but a global; this is the only one.
std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only use lock-free atomics");

void request(int) { requested.store(true, std::memory_order_relaxed); }

}  // namespace

InterruptScope::InterruptScope() {
  requested = false;
  struct sigaction action = {};
  action.sa_handler = request;
  // The second signal finds the default action: for whoever does not want to wait.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kInterruptSignals.size(); ++i) {
    const int signal = kInterruptSignals[i];
    ::sigaction(signal, nullptr, &before_[i]);
    const bool keep_ignored = signal == SIGHUP && before_[i].sa_handler == SIG_IGN;
    if (!keep_ignored) ::sigaction(signal, &action, nullptr);
  }
}

InterruptScope::~InterruptScope() {
  for (std::size_t i = 0; i < kInterruptSignals.size(); ++i) {
    ::sigaction(kInterruptSignals[i], &before_[i], nullptr);
  }
  requested = false;
}

InterruptBlock::InterruptBlock() {
  sigset_t blocked;
  ::sigemptyset(&blocked);
  for (const int signal : kInterruptSignals) ::sigaddset(&blocked, signal);
  ::pthread_sigmask(SIG_BLOCK, &blocked, &before_);
}

InterruptBlock::~InterruptBlock() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

bool interrupt_requested() { return requested.load(std::memory_order_relaxed); }

}  // namespace touchstone::harness
