#include "tools/gate/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace touchstone::gate {

using harness::parse_number;
using harness::Row;
using harness::Table;

namespace {

/// Why a claim cannot hold whatever its bound; ends the test of that claim only.
struct Problem {
  std::string text;
};

bool matches(const std::string& cell, const std::variant<std::string, double>& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return cell == *text;
  double number = 0;
  return parse_number(cell, number) && number == std::get<double>(value);
}

/// One claim on one table.
class Test {
 public:
  Test(const Claim& claim, const Table& table, const std::string& file)
      : claim_(claim), table_(table), file_(file) {
    select();
  }

  Verdict verdict() {
    try {
      if (rows_.empty()) throw Problem{"no row passes the filter"};
      return claim_.bound.equals.empty() ? verdict_on_numbers() : verdict_on_texts();
    } catch (const Problem& problem) {
      return {false, shown_bound(), "", "", problem.text};
    }
  }

 private:
  void select() {
    std::vector<std::size_t> columns;
    for (const Condition& condition : claim_.filter)
      columns.push_back(table_.column(condition.column, file_));
    for (const Row& row : table_.rows) {
      bool meant = true;
      for (std::size_t i = 0; i < columns.size() && meant; ++i) {
        const auto& values = claim_.filter[i].values;
        meant = std::any_of(values.begin(), values.end(),
                            [&](const auto& value) { return matches(row[columns[i]], value); });
      }
      if (meant) rows_.push_back(&row);
    }
  }

  /// The cell as a number; anything else fails the claim, an empty cell and "nan" included.
  double number(const Row& row, const std::string& column) const {
    const std::string& cell = row[table_.column(column, file_)];
    double value = 0;
    if (!parse_number(cell, value) || !std::isfinite(value)) {
      throw Problem{fmt::format("'{}' holds '{}', not a finite number", column, cell)};
    }
    return value;
  }

  double value(const Row& row) const {
    const double own = number(row, claim_.column);
    if (claim_.relative_to.empty()) return own;
    const double other = number(row, claim_.relative_to);
    if (other == 0) throw Problem{fmt::format("'{}' is 0, so nothing is relative to it", claim_.relative_to)};
    return std::abs(own - other) / std::abs(other);
  }

  std::vector<double> row_values() const {
    std::vector<double> values;
    for (const Row* row : rows_) values.push_back(value(*row));
    return values;
  }

  /// Largest of next - previous in the order of `along`.
  double largest_rise(double sign) const {
    std::map<double, double> ordered;
    for (const Row* row : rows_) {
      const double at = number(*row, claim_.along);
      if (!ordered.emplace(at, sign * value(*row)).second) {
        throw Problem{fmt::format("two rows with {} = {}", claim_.along, at)};
      }
    }
    if (ordered.size() < 2) throw Problem{"one row only: nothing to rise or fall"};
    double largest = -std::numeric_limits<double>::infinity();
    for (auto it = std::next(ordered.begin()); it != ordered.end(); ++it) {
      largest = std::max(largest, it->second - std::prev(it)->second);
    }
    return largest;
  }

  std::vector<double> aggregated() const {
    switch (claim_.aggregate) {
      case Aggregate::count:
        return {static_cast<double>(rows_.size())};
      case Aggregate::largest_rise:
        return {largest_rise(1.0)};
      case Aggregate::largest_fall:
        return {largest_rise(-1.0)};
      default:
        break;
    }
    const std::vector<double> values = row_values();
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (claim_.aggregate == Aggregate::max) return {*most};
    if (claim_.aggregate == Aggregate::min) return {*least};
    if (claim_.aggregate == Aggregate::spread) return {*most - *least};
    return values;
  }

  [[nodiscard]] double margin(double value) const {
    return std::min(value - claim_.bound.at_least, claim_.bound.at_most - value);
  }

  Verdict verdict_on_numbers() const {
    const std::vector<double> values = aggregated();
    const double worst = *std::min_element(values.begin(), values.end(),
                                           [&](double a, double b) { return margin(a) < margin(b); });
    const double left = margin(worst);
    return {left >= 0, shown_bound(), fmt::format("{:.6g}", worst), fmt::format("{:.3g}", left),
            left >= 0 ? "" : fmt::format("{} is beyond the bound", worst)};
  }

  Verdict verdict_on_texts() const {
    const std::size_t column = table_.column(claim_.column, file_);
    const auto odd = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Row* row) { return (*row)[column] != claim_.bound.equals; });
    if (odd == rows_.end()) return {true, shown_bound(), claim_.bound.equals, "", ""};
    return {false, shown_bound(), (**odd)[column], "",
            fmt::format("'{}' is not what it is to be", (**odd)[column])};
  }

  [[nodiscard]] std::string shown_bound() const {
    const Bound& bound = claim_.bound;
    if (!bound.equals.empty()) return "= " + bound.equals;
    if (std::isinf(bound.at_least)) return fmt::format("<= {}", bound.at_most);
    if (std::isinf(bound.at_most)) return fmt::format(">= {}", bound.at_least);
    return fmt::format("{} .. {}", bound.at_least, bound.at_most);
  }

  const Claim& claim_;
  const Table& table_;
  const std::string& file_;
  std::vector<const Row*> rows_;
};

}  // namespace

Verdict check(const Claim& claim, const Table& table, const std::string& file) {
  for (const std::string* column : {&claim.column, &claim.relative_to, &claim.along}) {
    if (!column->empty()) static_cast<void>(table.column(*column, file));
  }
  return Test(claim, table, file).verdict();
}

std::vector<Verdict> check_all(const std::vector<Claim>& claims, const std::filesystem::path& results) {
  std::map<std::string, Table> tables;
  std::vector<Verdict> verdicts;
  for (const Claim& claim : claims) {
    const std::filesystem::path file = results / claim.file;
    auto it = tables.find(claim.file);
    if (it == tables.end()) it = tables.emplace(claim.file, harness::read_csv(file)).first;
    verdicts.push_back(check(claim, it->second, file.string()));
  }
  return verdicts;
}

}  // namespace touchstone::gate
