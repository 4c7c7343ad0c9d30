#pragma once

namespace touchstone::engines {

/// While it lives, what the process writes to standard output is dropped: for libraries that print from
/// inside. It acts on the whole process, so an adapter holds it for as short as it can, and one thread at a
/// time does.
class SilencedStdout {
 public:
  SilencedStdout();
  ~SilencedStdout();
  SilencedStdout(const SilencedStdout&) = delete;
  SilencedStdout& operator=(const SilencedStdout&) = delete;

 private:
  int saved_ = -1;  ///< the real standard output, or -1 if it could not be redirected
};

/// While it lives, what this thread writes to C's `stderr` is dropped; other threads, and std::cerr, print
/// on. Costs next to nothing. The first one of a process replaces `stderr` by a stream that asks, for good.
class SilencedStderr {
 public:
  SilencedStderr();
  ~SilencedStderr();
  SilencedStderr(const SilencedStderr&) = delete;
  SilencedStderr& operator=(const SilencedStderr&) = delete;

 private:
  bool before_;  ///< whether the thread was silenced already
};

}  // namespace touchstone::engines
