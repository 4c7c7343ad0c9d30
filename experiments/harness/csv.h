#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Tidy CSV: one header line, the unit in the column's name, `.` decimals, an empty cell for "none".
namespace touchstone::harness {

using Row = std::vector<std::string>;

struct Table {
  Row header;
  std::vector<Row> rows;  ///< each as long as the header

  /// Index of a column. @throws InputError naming `file` and the columns there are, if it is not among them
  [[nodiscard]] std::size_t column(std::string_view name, const std::string& file) const;
};

/// Shortest decimal that reads back as the same double; empty if it is not finite (a missing value, in a
/// CSV); a negative zero is written as 0.
std::string number_cell(double value);
std::string number_cell(long value);

/// Reads all of `text` as a double, `.` decimals whatever the locale. @returns false if it is anything else
bool parse_number(std::string_view text, double& value);

/// RFC 4180 with '\n' line ends; cells are quoted only where they must be.
std::string format_csv(const Table& table);

/// Sorts by the columns from left to right: empty cells first, then numbers by value, then text with its
/// digit runs by value ("edges=20" before "edges=100"). The order does not depend on the order in which rows
/// were made.
void sort_rows(Table& table);

/// Reads RFC 4180 text, '\n' or "\r\n" line ends. `file` is for messages.
/// @throws InputError naming file and line: no header, a row of another length than the header, a stray or
/// open quote
Table parse_csv(std::string_view text, const std::string& file);

/// @throws IoError if the file cannot be read, InputError as parse_csv
Table read_csv(const std::filesystem::path& file);

}  // namespace touchstone::harness
