#include "experiments/harness/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <compare>

#include "core/model/errors.h"
#include "experiments/harness/files.h"

namespace touchstone::harness {

namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The run of digits at the start of `text`, without leading zeros; cut from `text`.
std::string_view take_digits(std::string_view& text) {
  const auto end =
      static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
  std::string_view run = text.substr(0, end);
  text.remove_prefix(end);
  run.remove_prefix(std::min(run.find_first_not_of('0'), run.size()));
  return run;
}

/// Text order with runs of digits compared by value; texts that differ in leading zeros only are told apart
/// at last.
std::strong_ordering compare_natural(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view run_a = take_digits(a);
      const std::string_view run_b = take_digits(b);
      if (const auto by_length = run_a.size() <=> run_b.size(); std::is_neq(by_length)) return by_length;
      if (const auto by_digits = run_a <=> run_b; std::is_neq(by_digits)) return by_digits;
    } else {
      if (const auto by_char = a.front() <=> b.front(); std::is_neq(by_char)) return by_char;
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (const auto by_rest = a.size() <=> b.size(); std::is_neq(by_rest)) return by_rest;
  return whole_a <=> whole_b;
}

/// A cell with what it is compared by, so that sorting parses each number once.
struct SortKey {
  int kind = 0;  // 0 empty, 1 number, 2 text
  double number = 0.0;
  std::string_view text;

  explicit SortKey(std::string_view cell) : text(cell) {
    if (cell.empty()) return;
    kind = parse_number(cell, number) && std::isfinite(number) ? 1 : 2;
  }
  [[nodiscard]] bool operator<(const SortKey& other) const {
    if (kind != other.kind) return kind < other.kind;
    if (kind == 1 && number != other.number) return number < other.number;
    return std::is_lt(compare_natural(text, other.text));
  }
};

bool must_quote(std::string_view cell) { return cell.find_first_of(",\"\r\n") != std::string_view::npos; }

void append_row(std::string& out, const Row& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) out += ',';
    if (!must_quote(row[i])) {
      out += row[i];
      continue;
    }
    out += '"';
    for (const char c : row[i]) {
      if (c == '"') out += '"';
      out += c;
    }
    out += '"';
  }
  out += '\n';
}

/// Reads one row after another; keeps count of lines, since a quoted cell may span several.
class CsvParser {
 public:
  CsvParser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  [[nodiscard]] int line() const { return line_; }

  Row row() {
    Row cells;
    do {
      cells.push_back(next_is('"') ? quoted_cell() : plain_cell());
    } while (take(','));
    if (!at_end()) end_line();
    return cells;
  }

 private:
  [[nodiscard]] bool next_is(char c) const { return !at_end() && text_[at_] == c; }
  bool take(char c) {
    if (!next_is(c)) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& got, const std::string& allowed) const {
    throw InputError(fmt::format("{}:{}", file_, line_), got, allowed);
  }
  std::string plain_cell() {
    const std::size_t end = std::min(text_.find_first_of(",\"\r\n", at_), text_.size());
    std::string cell(text_.substr(at_, end - at_));
    at_ = end;
    if (next_is('"'))
      fail("a quote inside a cell", "quotes around the whole cell, doubled inside it (RFC 4180)");
    return cell;
  }
  std::string quoted_cell() {
    std::string cell;
    const int opened = line_;
    take('"');
    while (!at_end()) {
      if (take('"')) {
        if (!take('"')) return cell;
        cell += '"';
        continue;
      }
      const char c = text_[at_++];
      if (c == '\n') ++line_;
      cell += c;
    }
    line_ = opened;
    fail("a quote that is never closed", "quotes in pairs (RFC 4180)");
  }
  void end_line() {
    take('\r');
    if (!take('\n')) fail("text after a closing quote", "a comma or the end of the line");
    ++line_;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::size_t Table::column(std::string_view name, const std::string& file) const {
  const auto it = std::find(header.begin(), header.end(), name);
  if (it == header.end()) {
    throw InputError(file + " column", fmt::format("'{}'", name),
                     fmt::format("one of {}", fmt::join(header, ", ")));
  }
  return static_cast<std::size_t>(it - header.begin());
}

std::string number_cell(double value) {
  if (!std::isfinite(value)) return "";
  return value == 0 ? "0" : fmt::format("{}", value);
}

std::string number_cell(long value) { return fmt::format("{}", value); }

bool parse_number(std::string_view text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

std::string format_csv(const Table& table) {
  std::string out;
  append_row(out, table.header);
  for (const Row& row : table.rows) append_row(out, row);
  return out;
}

void sort_rows(Table& table) {
  using KeyedRow = std::pair<std::vector<SortKey>, std::size_t>;
  std::vector<KeyedRow> order;
  for (const Row& row : table.rows) {
    order.emplace_back(std::vector<SortKey>(row.begin(), row.end()), order.size());
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const KeyedRow& a, const KeyedRow& b) { return a.first < b.first; });
  std::vector<Row> sorted;
  sorted.reserve(order.size());
  for (const auto& [key, index] : order) sorted.push_back(table.rows[index]);
  table.rows = std::move(sorted);
}

Table parse_csv(std::string_view text, const std::string& file) {
  CsvParser parser(text, file);
  if (parser.at_end()) throw InputError(file + ":1", "an empty file", "a header line");
  Table table{parser.row(), {}};
  while (!parser.at_end()) {
    const int line = parser.line();
    Row row = parser.row();
    if (row.size() != table.header.size()) {
      throw InputError(fmt::format("{}:{}", file, line), fmt::format("{} cells", row.size()),
                       fmt::format("{} cells, as in the header", table.header.size()));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table read_csv(const std::filesystem::path& file) { return parse_csv(read_file(file), file.string()); }

}  // namespace touchstone::harness
