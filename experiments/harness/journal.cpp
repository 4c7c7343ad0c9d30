#include "experiments/harness/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string_view>

#include "core/model/errors.h"
#include "experiments/harness/case_text.h"

namespace touchstone::harness {

namespace {

std::string header_line(const std::string& stamp) { return "touchstone journal 1 " + stamp + "\n"; }

/// Cuts the next line, without its end, off `text`; none if it was not written to its end.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

struct Content {
  FinishedCases finished;
  std::size_t bytes = 0;  ///< how many of the file hold the header and whole cases
};

Content parse_journal(std::string_view text, const std::string& stamp) {
  Content content;
  const std::string header = header_line(stamp);
  if (!text.starts_with(header)) return content;
  content.bytes = header.size();
  std::string_view rest = text.substr(header.size());
  while (const auto line = take_line(rest)) {
    try {
      KeyedCase one = parse_case_text(*line);
      content.finished[std::move(one.key)] = std::move(one.finished);
    } catch (const std::exception&) {
      break;  // damaged: this case and those after it are run again
    }
    content.bytes += line->size() + 1;
  }
  return content;
}

void lock(const FileDescriptor& file, int kind) {
  if (::flock(file.get(), kind | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) throw_io_error("cannot lock", file.path());
  throw IoError(fmt::format("cannot use {}: another run is writing it", file.path().string()));
}

}  // namespace

std::string case_key(const CaseId& id) {
  std::string line = format_csv({id.cells(), {}});
  line.pop_back();
  return line;
}

FinishedCases read_journal(const std::filesystem::path& file, const std::string& stamp) {
  const FileDescriptor locked(file, O_RDONLY | O_CLOEXEC);
  lock(locked, LOCK_SH);
  return parse_journal(read_file(file), stamp).finished;
}

Journal::Journal(const std::filesystem::path& file, const std::string& stamp)
    : file_(file, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC) {
  lock(file_, LOCK_EX);
  const std::string text = read_file(file);
  Content content = parse_journal(text, stamp);
  finished_ = std::move(content.finished);
  was_stale_ = content.bytes == 0 && !text.empty();
  if (::ftruncate(file_.get(), static_cast<off_t>(content.bytes)) != 0) throw_io_error("cannot write", file);
  if (content.bytes == 0) file_.write(header_line(stamp));
}

void Journal::append(const std::string& key, const FinishedCase& result) {
  const std::string line = case_text(key, result) + "\n";
  const std::scoped_lock lock(mutex_);
  file_.write(line);
  file_.sync();
}

void Journal::remove() {
  if (::unlink(file_.path().c_str()) != 0 && errno != ENOENT) throw_io_error("cannot remove", file_.path());
}

}  // namespace touchstone::harness
