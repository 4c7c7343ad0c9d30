#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/harness/csv.h"

namespace touchstone::harness {

/// One row that is filled by column name; what is not set stays empty.
class Record {
 public:
  /// @param columns  of the table, which must outlive the record
  explicit Record(const std::vector<std::string>& columns) : columns_(columns), cells_(columns.size()) {}

  /// A number that is not finite is written as an empty cell. @throws std::logic_error if there is no such
  /// column
  Record& set(std::string_view column, double value) { return set(column, number_cell(value)); }
  Record& set(std::string_view column, long value) { return set(column, number_cell(value)); }
  Record& set(std::string_view column, int value) {
    return set(column, number_cell(static_cast<long>(value)));
  }
  Record& set(std::string_view column, std::string value);

  [[nodiscard]] const Row& row() const { return cells_; }

 private:
  const std::vector<std::string>& columns_;
  Row cells_;
};

}  // namespace touchstone::harness
