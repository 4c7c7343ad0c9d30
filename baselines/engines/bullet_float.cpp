#include "baselines/engines/bullet_float.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "baselines/engines/bullet_float_messages.h"
#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

[[noreturn]] void throw_error(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// The server with a socket to its standard input. It ends when the socket is closed.
class Server {
 public:
  Server() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw_error(errno, "socketpair");
    socket_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    char path[] = TOUCHSTONE_BULLET_FLOAT_SERVER;
    char* const arguments[] = {path, nullptr};
    const int error = posix_spawn(&pid_, path, &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) {
      close(socket_);
      throw_error(error, path);
    }
  }
  ~Server() {
    close(socket_);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Sends a request and waits for the reply to it.
  [[nodiscard]] std::string ask(const std::string& request) const {
    send_message(socket_, request);
    return receive_message(socket_);
  }

 private:
  int socket_ = -1;
  pid_t pid_ = 0;
};

class BulletFloatProcess final : public Engine<3> {
 public:
  BulletFloatProcess(const Scene<3>& scene, const BulletSettings& settings, Motion motion) {
    BulletFloatLoad load{scene, settings, motion};
    WireWriter request;
    transfer(request, load);
    const std::string bytes = server_.ask(request.bytes());
    WireReader reply(bytes);
    BulletFloatLoaded loaded;
    transfer(reply, loaded);
    if (!loaded.refusal.empty()) throw Unsupported(loaded.refusal);
    mass_properties_ = std::move(loaded.mass_properties);
    result_.state = std::move(loaded.state);
  }

  StepReport advance(double h) override {
    WireWriter request;
    transfer(request, h);
    const std::string bytes = server_.ask(request.bytes());
    WireReader reply(bytes);
    transfer(reply, result_);
    return {};
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    return result_.state[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    return mass_properties_[static_cast<std::size_t>(index)];
  }
  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override { contacts = result_.contacts; }

 private:
  Server server_;
  std::vector<MassProperties<3>> mass_properties_;
  BulletFloatStepped result_;
};

/// The line that the server prints.
std::string asked_version() {
  const std::unique_ptr<FILE, int (*)(FILE*)> server(
      popen("'" TOUCHSTONE_BULLET_FLOAT_SERVER "' version", "r"), &pclose);
  char line[64] = {};
  if (server == nullptr || std::fgets(line, sizeof line, server.get()) == nullptr) return "unknown";
  const std::string text = line;
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::string bullet_float_version() {
  static const std::string version = asked_version();
  return version;
}

std::unique_ptr<Engine<3>> make_bullet_float_process(const Scene<3>& scene, const BulletSettings& settings,
                                                     Motion motion) {
  return std::make_unique<BulletFloatProcess>(scene, settings, motion);
}

}  // namespace touchstone::engines
