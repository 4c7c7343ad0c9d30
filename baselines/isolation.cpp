#include "baselines/isolation.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "core/model/errors.h"

namespace touchstone {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void throw_errno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  ~FileDescriptor() { reset(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  void reset(int fd = -1) {
    if (fd_ >= 0) close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

/// A child that cannot outlive its owner.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid), ended_(static_cast<int>(syscall(SYS_pidfd_open, pid, 0))) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Readable once the child has ended; -1 if the system cannot tell.
  [[nodiscard]] int ended() const { return ended_.get(); }
  /// Kills it, which does nothing to one that has ended. @returns its status as waitpid tells it
  int end() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) continue;
      pid_ = 0;
    }
    return status_;
  }

 private:
  pid_t pid_;
  FileDescriptor ended_;
  int status_ = 0;
};

/// What the child sends: this, then `length` bytes. Without it an answer that was cut off would pass for a
/// whole one.
struct Header {
  Outcome outcome;
  std::uint64_t length;
};

void write_all(int fd, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t count = write(fd, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(EXIT_FAILURE);
    at += count;
    size -= static_cast<std::size_t>(count);
  }
}

IsolatedResult call(const std::function<std::string()>& work) {
  try {
    return {Outcome::finished, work()};
  } catch (const Unsupported& reason) {
    return {Outcome::unsupported, reason.what()};
  } catch (const std::exception& error) {
    return {Outcome::failed, error.what()};
  } catch (...) {
    return {Outcome::failed, "an exception of unknown type"};
  }
}

[[noreturn]] void be_child(const std::function<std::string()>& work, int answer, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(EXIT_FAILURE);  // it ended before the line above
  constexpr rlimit kNoCoreFile{0, 0};
  setrlimit(RLIMIT_CORE, &kNoCoreFile);
  const IsolatedResult result = call(work);
  const Header header{result.outcome, result.text.size()};
  write_all(answer, &header, sizeof header);
  write_all(answer, result.text.data(), result.text.size());
  _exit(EXIT_SUCCESS);
}

/// Appends what can be read without waiting.
void drain(int fd, std::string& bytes) {
  char buffer[65536];
  while (true) {
    const ssize_t count = read(fd, buffer, sizeof buffer);
    if (count > 0) {
      bytes.append(buffer, static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      return;
    }
  }
}

bool is_whole(const std::string& bytes) {
  if (bytes.size() < sizeof(Header)) return false;
  Header header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  return bytes.size() == sizeof header + header.length;
}

/// Reads until the answer is whole, the child has ended or the time is over. The child's end is told by its
/// pid and not by the pipe, whose other end may live on in a child that another thread forked meanwhile.
std::string collect(int answer, int child, Clock::time_point deadline) {
  std::string bytes;
  bool ended = false;
  while (!is_whole(bytes) && !ended) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) break;
    pollfd fds[] = {{answer, POLLIN, 0}, {child, POLLIN, 0}};
    constexpr long kLongestWait = 1000;  // [ms]; within int, whatever the limit
    if (poll(fds, 2, static_cast<int>(std::min(static_cast<long>(left), kLongestWait))) < 0 && errno != EINTR)
      throw_errno("poll");
    ended = (fds[1].revents & POLLIN) != 0;
    drain(answer, bytes);
  }
  return bytes;
}

std::string describe(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("its process ended with exit code {}", WEXITSTATUS(status));
  return fmt::format("its process was ended by signal {} ({})", WTERMSIG(status),
                     strsignal(WTERMSIG(status)));
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::finished:
      return "finished";
    case Outcome::unsupported:
      return "unsupported";
    case Outcome::failed:
      return "failed";
    case Outcome::crashed:
      return "crashed";
    case Outcome::timed_out:
      return "timed_out";
  }
  return "unknown";
}

IsolatedResult run_isolated(const std::function<std::string()>& work, std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + std::chrono::ceil<Clock::duration>(limit);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) throw_errno("pipe2");
  FileDescriptor answer(ends[0]);
  FileDescriptor child_answer(ends[1]);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) throw_errno("fork");
  if (pid == 0) {
    fcntl(ends[1], F_SETFL, 0);  // the child may wait for its reader
    be_child(work, ends[1], parent);
  }
  Child child(pid);
  if (child.ended() < 0) throw_errno("pidfd_open");
  child_answer.reset();
  const std::string bytes = collect(answer.get(), child.ended(), deadline);
  const bool late = !is_whole(bytes) && Clock::now() >= deadline;
  const int status = child.end();
  if (late) return {Outcome::timed_out, fmt::format("no answer within {} s", limit.count())};
  if (!is_whole(bytes)) return {Outcome::crashed, describe(status)};
  Header header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  return {header.outcome, bytes.substr(sizeof header)};
}

}  // namespace touchstone
