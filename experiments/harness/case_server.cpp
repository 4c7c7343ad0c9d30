#include "experiments/harness/case_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>

#include "baselines/isolation.h"
#include "experiments/harness/case_text.h"
#include "experiments/harness/interrupt.h"
#include "experiments/harness/journal.h"
#include "experiments/harness/sweep.h"

namespace touchstone::harness {

namespace {

using Clock = std::chrono::steady_clock;

/// What goes before the text of an answer.
struct Header {
  Outcome outcome = Outcome::finished;
  std::uint64_t length = 0;
};

[[noreturn]] void throw_errno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// @returns false if the other end is gone
bool send_all(int socket, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t count = ::send(socket, at, size, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

/// Waits for all of it. @returns false if the other end is gone
bool receive_all(int socket, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t count = ::recv(socket, at, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

// --- in the server

/// Keeps the standard streams and `socket`, which it moves: a journal's lock, say, is to end with the
/// program.
int close_what_was_inherited(int socket) {
  constexpr int kKept = STDERR_FILENO + 1;
  if (socket != kKept) ::dup2(socket, kKept);
  ::close_range(kKept + 1, ~0U, 0);
  return kKept;
}

[[noreturn]] void serve(std::span<const Case> cases, std::chrono::duration<double> limit, int socket,
                        pid_t program) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != program) ::_exit(EXIT_FAILURE);  // it ended before the line above
  for (const int signal : kInterruptSignals) ::signal(signal, SIG_IGN);
  socket = close_what_was_inherited(socket);
  std::size_t index = 0;
  while (receive_all(socket, &index, sizeof index)) {
    const Case& one = cases[index];
    const IsolatedResult result =
        run_isolated([&] { return case_text(case_key(one.id), run_one(one)); }, limit);
    const Header header{result.outcome, result.text.size()};
    if (!send_all(socket, &header, sizeof header)) break;
    if (!send_all(socket, result.text.data(), result.text.size())) break;
  }
  ::_exit(EXIT_SUCCESS);
}

// --- in the program

/// Waits until there is something to read. @throws Interrupted
void wait_for_answer(int socket) {
  constexpr int kLookForInterrupts = 50;  // [ms]
  pollfd answer = {socket, POLLIN, 0};
  while (::poll(&answer, 1, kLookForInterrupts) <= 0) throw_if_interrupted();
}

FinishedCase finished_case(const Header& header, const std::string& text, double wall_s) {
  if (header.outcome == Outcome::finished) return parse_case_text(text).finished;
  return {{CaseStatus::failed, text, {}}, wall_s, header.outcome == Outcome::timed_out};
}

}  // namespace

CaseServer::CaseServer(std::span<const Case> cases, std::chrono::duration<double> time_limit)
    : cases_(cases) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw_errno("socketpair");
  const pid_t program = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) serve(cases, time_limit, ends[1], program);
  ::close(ends[1]);
  socket_ = ends[0];
  if (pid_ < 0) {
    const int error = errno;
    ::close(socket_);
    throw std::system_error(error, std::generic_category(), "fork");
  }
}

CaseServer::~CaseServer() { end(); }

void CaseServer::end() {
  if (pid_ == 0) return;
  ::kill(pid_, SIGKILL);  // its child, if it has one, is killed by the system then
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  ::close(socket_);
  pid_ = 0;
}

FinishedCase CaseServer::run(std::size_t index) {
  const auto start = Clock::now();
  const char* const kGone = "the process that runs isolated cases has ended";
  if (pid_ == 0 || !send_all(socket_, &index, sizeof index)) throw std::runtime_error(kGone);
  try {
    wait_for_answer(socket_);
  } catch (const Interrupted&) {
    end();
    throw;
  }
  Header header;
  if (!receive_all(socket_, &header, sizeof header)) throw std::runtime_error(kGone);
  std::string text(header.length, '\0');
  if (!receive_all(socket_, text.data(), text.size())) throw std::runtime_error(kGone);
  return finished_case(header, text, std::chrono::duration<double>(Clock::now() - start).count());
}

}  // namespace touchstone::harness
