#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>

#include "experiments/harness/case.h"

namespace touchstone::harness {

/// Runs cases each in a process of its own, so that a crash, a hang or a leak inside an engine costs that
/// case alone.
///
/// The server itself is a process that is forked while the program has one thread, and that forks a child for
/// each case: a child of a process with several threads would hang for ever on a lock that another thread
/// held at the fork. It and its child hear no signal but SIGKILL, are killed by the destructor, and do not
/// outlive the program, however that ends.
class CaseServer {
 public:
  /// Call it before other threads start, from a thread that lives as long as the server.
  /// @param cases       to run, as they are now; must outlive the server
  /// @param time_limit  wall time of one case [s]
  /// @throws std::system_error if the system gives no process or socket
  CaseServer(std::span<const Case> cases, std::chrono::duration<double> time_limit);
  ~CaseServer();
  CaseServer(const CaseServer&) = delete;
  CaseServer& operator=(const CaseServer&) = delete;

  /// Runs case `index`; from one thread at a time. A crash, an exit and the time limit are `failed`, with the
  /// reason.
  /// @throws Interrupted, with the case killed, if interrupt_requested()
  /// @throws std::runtime_error if the server is gone
  FinishedCase run(std::size_t index);

 private:
  void end();

  std::span<const Case> cases_;
  pid_t pid_ = 0;
  int socket_ = -1;
};

}  // namespace touchstone::harness
