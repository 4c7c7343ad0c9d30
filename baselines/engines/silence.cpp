#include "baselines/engines/silence.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <mutex>

namespace touchstone::engines {

namespace {

std::mutex& redirection() {
  static std::mutex mutex;
  return mutex;
}

thread_local bool stderr_dropped = false;

/// Of the stream that takes the place of `stderr`: writes to where that writes, or nowhere.
ssize_t write_or_drop(void*, const char* data, std::size_t size) {
  if (stderr_dropped) return static_cast<ssize_t>(size);
  ssize_t count = 0;
  do {
    count = write(STDERR_FILENO, data, size);
  } while (count < 0 && errno == EINTR);
  return count < 0 ? 0 : count;  // 0 is an error to the stream
}

/// @returns whether it could be done; chatter is better than no run
bool replace_stderr() {
  FILE* asking = fopencookie(nullptr, "w", {nullptr, &write_or_drop, nullptr, nullptr});
  if (asking == nullptr) return false;
  setvbuf(asking, nullptr, _IONBF, 0);  // so that the thread that prints is the one that is asked
  std::fflush(stderr);
  stderr = asking;
  return true;
}

void flush_all() {
  std::cout.flush();
  std::fflush(stdout);
}

}  // namespace

SilencedStdout::SilencedStdout() {
  redirection().lock();
  flush_all();
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;  // chatter is better than no run
  saved_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (saved_ >= 0) dup2(nowhere, STDOUT_FILENO);
  close(nowhere);
}

SilencedStdout::~SilencedStdout() {
  flush_all();
  if (saved_ >= 0) {
    dup2(saved_, STDOUT_FILENO);
    close(saved_);
  }
  redirection().unlock();
}

SilencedStderr::SilencedStderr() : before_(stderr_dropped) {
  static const bool replaced = replace_stderr();
  static_cast<void>(replaced);
  stderr_dropped = true;
}

SilencedStderr::~SilencedStderr() { stderr_dropped = before_; }

}  // namespace touchstone::engines
