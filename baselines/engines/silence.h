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

}  // namespace touchstone::engines
