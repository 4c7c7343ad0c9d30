#include "experiments/harness/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <set>
#include <utility>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"

namespace touchstone::harness {

namespace fs = std::filesystem;

namespace {

/// A file that is gone at the end of the scope unless it was renamed to its place. `*.tmp` is ignored by git.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : path_(fmt::format("{}.{}.tmp", target.string(), ::getpid())),
        file_(path_, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC) {}
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const FileDescriptor& file() const { return file_; }
  void rename_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) throw_io_error("cannot replace", target);
    path_.clear();
  }

 private:
  fs::path path_;
  FileDescriptor file_;
};

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void throw_io_error(std::string_view what, const fs::path& file) {
  throw IoError(fmt::format("{} {}: {}", what, file.string(), std::strerror(errno)));
}

FileDescriptor::FileDescriptor(const fs::path& file, int flags)
    : path_(file), fd_(::open(file.c_str(), flags, 0666)) {
  if (fd_ < 0) throw_io_error("cannot open", file);
}

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

void FileDescriptor::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_io_error("cannot write", path_);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void FileDescriptor::sync() const {
  if (::fsync(fd_) != 0) throw_io_error("cannot sync", path_);
}

std::string read_file(const fs::path& file) {
  const FileDescriptor input(file, O_RDONLY | O_CLOEXEC);
  std::string bytes;
  char buffer[1 << 16];
  while (true) {
    const ssize_t count = ::read(input.get(), buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_io_error("cannot read", file);
    if (count == 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(count));
  }
}

void write_files(const std::vector<FileContent>& files) {
  const InterruptBlock block;
  std::vector<std::unique_ptr<TemporaryFile>> temporaries;
  for (const auto& [path, bytes] : files) {
    const auto& temporary = temporaries.emplace_back(std::make_unique<TemporaryFile>(path));
    temporary->file().write(bytes);
    temporary->file().sync();
  }
  std::set<fs::path> folders;
  for (std::size_t i = 0; i < files.size(); ++i) {
    temporaries[i]->rename_to(files[i].path);
    folders.insert(folder_of(files[i].path));
  }
  for (const fs::path& folder : folders) FileDescriptor(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC).sync();
}

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  const InterruptBlock block;
  const TemporaryFile probe(folder / ".writable");
}

}  // namespace touchstone::harness
