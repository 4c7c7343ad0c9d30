#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/harness/files.h"

/// The cases of a sweep that are finished, on disc, so that a killed sweep goes on where it stopped.
///
/// One line a case, in the order in which they finished, after a first line with the stamp of the program and
/// the sources that made them. A journal of another stamp is stale: nothing in it is used. A last line that
/// was cut short by a crash is dropped. `*.journal` is ignored by git.
namespace touchstone::harness {

using FinishedCases = std::map<std::string, FinishedCase>;  ///< by case_key()

/// What a case is found by: the cells of its id as a line of CSV.
std::string case_key(const CaseId& id);

/// The cases in another's journal; none if it is of another stamp.
/// @throws IoError if it cannot be read, or a running program holds it
FinishedCases read_journal(const std::filesystem::path& file, const std::string& stamp);

class Journal {
 public:
  /// Opens or makes `file` and keeps it locked. What it holds is kept if it is of `stamp`, else discarded.
  /// @throws IoError if it cannot be written, or a running program holds it
  Journal(const std::filesystem::path& file, const std::string& stamp);

  [[nodiscard]] const FinishedCases& finished() const { return finished_; }
  /// Whether there was a journal of another stamp.
  [[nodiscard]] bool was_stale() const { return was_stale_; }
  /// Adds a case and returns when it is on the disc. May be called from any thread.
  void append(const std::string& key, const FinishedCase& result);
  /// Removes the file: its cases are in the tables now.
  void remove();

 private:
  FileDescriptor file_;
  FinishedCases finished_;
  bool was_stale_ = false;
  std::mutex mutex_;
};

}  // namespace touchstone::harness
