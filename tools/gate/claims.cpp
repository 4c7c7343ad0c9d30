#include "tools/gate/claims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/model/errors.h"
#include "experiments/harness/files.h"

namespace touchstone::gate {

namespace {

const std::map<std::string, Aggregate> kAggregates = {{"each", Aggregate::each},
                                                      {"max", Aggregate::max},
                                                      {"min", Aggregate::min},
                                                      {"count", Aggregate::count},
                                                      {"spread", Aggregate::spread},
                                                      {"largest_rise", Aggregate::largest_rise},
                                                      {"largest_fall", Aggregate::largest_fall}};

/// Reads one [[claim]] and remembers which keys were asked for, so that a misspelt one is found.
class ClaimReader {
 public:
  ClaimReader(const toml::table& table, const std::string& file) : table_(table), file_(file) {}

  Claim read() {
    Claim claim;
    claim.name = required_text("name");
    claim.file = required_text("file");
    claim.filter = filter();
    claim.aggregate = aggregate();
    claim.along = text("along").value_or("");
    claim.relative_to = text("relative_to").value_or("");
    claim.column =
        claim.aggregate == Aggregate::count ? text("column").value_or("") : required_text("column");
    claim.bound = bound();
    claim.reason = required_text("reason");
    check_keys();
    check_sense(claim);
    return claim;
  }

 private:
  [[noreturn]] void fail(const toml::node& where, const std::string& key, const std::string& got,
                         const std::string& allowed) const {
    throw InputError(fmt::format("{}:{}: {}", file_, where.source().begin.line, key), got, allowed);
  }

  const toml::node* find(const std::string& key) {
    known_.insert(key);
    return table_.get(key);
  }

  std::optional<std::string> text(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value_exact<std::string>();
    if (!value || value->empty()) fail(*node, key, value ? "''" : "another type", "a text");
    return value;
  }

  std::string required_text(const std::string& key) {
    const auto value = text(key);
    if (!value) fail(table_, key, "nothing", "a text (every claim has one)");
    return *value;
  }

  double to_number(const toml::node& node, const std::string& key) const {
    const auto value = node.value<double>();
    if (!node.is_number() || !value || std::isnan(*value)) fail(node, key, "no number", "a number");
    return *value;
  }

  std::optional<double> number(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return to_number(*node, key);
  }

  Aggregate aggregate() {
    const std::string name = required_text("aggregate");
    const auto it = kAggregates.find(name);
    if (it == kAggregates.end()) {
      std::vector<std::string> names;
      for (const auto& entry : kAggregates) names.push_back(entry.first);
      fail(*table_.get("aggregate"), "aggregate", "'" + name + "'",
           fmt::format("{}", fmt::join(names, ", ")));
    }
    return it->second;
  }

  void add_value(Condition& condition, const toml::node& node) const {
    const std::string key = "filter." + condition.column;
    if (const auto value = node.value_exact<std::string>()) {
      condition.values.emplace_back(*value);
    } else {
      condition.values.emplace_back(to_number(node, key));
    }
  }

  std::vector<Condition> filter() {
    const toml::node* node = find("filter");
    if (node == nullptr) return {};
    if (!node->is_table()) fail(*node, "filter", "another type", "a table: { column = value, ... }");
    std::vector<Condition> filter;
    for (const auto& [column, value] : *node->as_table()) {
      Condition condition{std::string(column.str()), {}};
      if (const toml::array* values = value.as_array()) {
        for (const toml::node& one : *values) add_value(condition, one);
      } else {
        add_value(condition, value);
      }
      filter.push_back(std::move(condition));
    }
    return filter;
  }

  Bound bound() {
    Bound bound;
    const auto at_most = number("at_most");
    const auto at_least = number("at_least");
    const auto equals = text("equals");
    const toml::node* between = find("between");
    const int given =
        (at_most ? 1 : 0) + (at_least ? 1 : 0) + (equals ? 1 : 0) + (between != nullptr ? 1 : 0);
    if (given != 1) {
      fail(table_, "bound", fmt::format("{} of them", given),
           "exactly one of at_most, at_least, between, equals");
    }
    if (at_most) bound.at_most = *at_most;
    if (at_least) bound.at_least = *at_least;
    if (equals) bound.equals = *equals;
    if (between != nullptr) read_between(*between, bound);
    return bound;
  }

  void read_between(const toml::node& node, Bound& bound) const {
    const toml::array* pair = node.as_array();
    const std::string allowed = "[least, most] with least <= most";
    if (pair == nullptr || pair->size() != 2) fail(node, "between", "another form", allowed);
    bound.at_least = to_number(*pair->get(0), "between");
    bound.at_most = to_number(*pair->get(1), "between");
    if (bound.at_least > bound.at_most) {
      fail(node, "between", fmt::format("[{}, {}]", bound.at_least, bound.at_most), allowed);
    }
  }

  void check_keys() const {
    for (const auto& [key, node] : table_) {
      if (known_.contains(std::string(key.str()))) continue;
      fail(node, std::string(key.str()), "an unknown key", fmt::format("{}", fmt::join(known_, ", ")));
    }
  }

  void check_sense(const Claim& claim) const {
    const bool ordered =
        claim.aggregate == Aggregate::largest_rise || claim.aggregate == Aggregate::largest_fall;
    if (ordered == claim.along.empty()) {
      fail(table_, "along", claim.along.empty() ? "nothing" : "'" + claim.along + "'",
           "a column with largest_rise and largest_fall, and only with them");
    }
    if (!claim.bound.equals.empty() && (claim.aggregate != Aggregate::each || !claim.relative_to.empty())) {
      fail(table_, "equals", "'" + claim.bound.equals + "'",
           "only aggregate = \"each\", without relative_to");
    }
  }

  const toml::table& table_;
  const std::string& file_;
  std::set<std::string> known_;
};

toml::table parse(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", file, error.source().begin.line), std::string(error.description()),
                     "TOML 1.0");
  }
}

}  // namespace

std::vector<Claim> read_claims(const std::filesystem::path& file) {
  const std::string name = file.string();
  const toml::table root = parse(harness::read_file(file), name);
  for (const auto& [key, node] : root) {
    if (key.str() != "claim") {
      throw InputError(fmt::format("{}:{}: {}", name, node.source().begin.line, key.str()), "an unknown key",
                       "[[claim]] tables");
    }
  }
  const toml::array* list = root["claim"].as_array();
  if (list == nullptr || list->empty() || !list->is_homogeneous<toml::table>()) {
    throw InputError(name + ":1: claim", "nothing", "at least one [[claim]]");
  }
  std::vector<Claim> claims;
  for (const toml::node& node : *list) claims.push_back(ClaimReader(*node.as_table(), name).read());
  return claims;
}

}  // namespace touchstone::gate
