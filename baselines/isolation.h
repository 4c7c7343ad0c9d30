#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

/// Runs a case in a process of its own, so that a crash, a hang or a leak inside an engine costs that case
/// alone.
namespace touchstone {

enum class Outcome {
  finished,     ///< it returned; `text` is what it returned
  unsupported,  ///< it threw Unsupported; `text` is the reason
  failed,       ///< it threw something else; `text` is what() of it
  crashed,      ///< its process ended without an answer; `text` says by which signal or exit code
  timed_out,    ///< it gave no answer in time and was killed; `text` says how long that was
};
std::string_view to_string(Outcome outcome);

struct IsolatedResult {
  Outcome outcome = Outcome::finished;
  std::string text;
};

/// Calls `work` in a forked child and hands back what it returns, typically rows in the form of a CSV.
///
/// The child is this process as it is now: it sees all of its memory, and nothing that it changes comes back.
/// It ends without running destructors of statics or flushing streams. It is killed if the calling thread
/// ends first. May be called from several threads at once, if no other thread holds a lock that `work` takes:
/// a lock that is held at the fork stays so in the child, which then times out.
/// @param limit  wall time [s] after which the child is killed
/// @throws std::system_error if the system gives no process or pipe
IsolatedResult run_isolated(const std::function<std::string()>& work, std::chrono::duration<double> limit);

}  // namespace touchstone
