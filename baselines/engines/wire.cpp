#include "baselines/engines/wire.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstdint>

namespace touchstone::engines {

namespace {

[[noreturn]] void gone() { throw std::runtime_error("the engine's process has gone"); }

void send_all(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = send(fd, data, size, MSG_NOSIGNAL);  // a dead reader is an exception, not a signal
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) gone();
    data += count;
    size -= static_cast<std::size_t>(count);
  }
}

void receive_all(int fd, char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = recv(fd, data, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) gone();
    data += count;
    size -= static_cast<std::size_t>(count);
  }
}

}  // namespace

void send_message(int fd, const std::string& bytes) {
  const std::uint64_t size = bytes.size();
  send_all(fd, reinterpret_cast<const char*>(&size), sizeof size);
  send_all(fd, bytes.data(), bytes.size());
}

std::string receive_message(int fd) {
  std::uint64_t size = 0;
  receive_all(fd, reinterpret_cast<char*>(&size), sizeof size);
  std::string bytes(size, '\0');
  receive_all(fd, bytes.data(), bytes.size());
  return bytes;
}

}  // namespace touchstone::engines
