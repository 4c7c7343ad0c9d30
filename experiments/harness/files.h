#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Files that appear whole or not at all. Every failure is an IoError with the path and the system's reason.
namespace touchstone::harness {

std::string read_file(const std::filesystem::path& file);

struct FileContent {
  std::filesystem::path path;
  std::string bytes;
};

/// Replaces the files: each is written to a temporary file beside it and synced; when that has worked for all
/// they are renamed over the old ones and the folders synced. At every moment a path holds the old bytes or
/// the new ones, and a full disc leaves all the old ones. Signals wait meanwhile, so none leaves a temporary
/// file behind.
void write_files(const std::vector<FileContent>& files);

/// Makes the folder if need be and finds out whether files can be made in it, before hours of work go into
/// them.
void prepare_folder(const std::filesystem::path& folder);

/// An open file descriptor, closed at the end of its scope.
class FileDescriptor {
 public:
  FileDescriptor(const std::filesystem::path& file, int flags);
  ~FileDescriptor();
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes all of `bytes`.
  void write(std::string_view bytes) const;
  /// Returns when what was written is on the disc.
  void sync() const;

 private:
  std::filesystem::path path_;
  int fd_;
};

/// IoError with `what` was tried, the path and the reason of `errno`.
[[noreturn]] void throw_io_error(std::string_view what, const std::filesystem::path& file);

}  // namespace touchstone::harness
