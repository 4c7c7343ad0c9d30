#include "baselines/engines/silence.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <mutex>

namespace touchstone::engines {

namespace {

std::mutex& redirection() {
  static std::mutex mutex;
  return mutex;
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

}  // namespace touchstone::engines
