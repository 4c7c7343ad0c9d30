#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/harness/scratch.h"

extern char** environ;

namespace touchstone::test {

struct Finished {
  int code = 0;  ///< exit code, or -signal
  std::string out;
  std::string err;
};

/// A program that runs beside the test, its output kept.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    const std::string out = scratch_ / "out";
    const std::string err = scratch_ / "err";
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), flags, 0600);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), flags, 0600);
    const int error = ::posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " + command[0]);
  }

  void signal(int number) const { ::kill(pid_, number); }
  [[nodiscard]] std::string err() const { return slurp(scratch_ / "err"); }

  Finished wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), slurp(scratch_ / "out"),
            slurp(scratch_ / "err")};
  }

 private:
  Scratch scratch_;
  pid_t pid_ = 0;
};

inline Finished run(const std::vector<std::string>& command) { return Process(command).wait(); }

}  // namespace touchstone::test
