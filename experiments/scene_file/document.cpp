#include "experiments/scene_file/document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>

#include "experiments/scene_file/nearest_name.h"

namespace touchstone::scene_file {

namespace {

std::string place(const std::string& file, const toml::source_region& at) {
  return fmt::format("{}:{}:{}", file, at.begin.line, at.begin.column);
}

/// The value as the message about it shows it.
std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("'{}'", text->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return fmt::format("{}", flag->get());
  if (const auto* list = node.as_array()) return fmt::format("a list of {}", list->size());
  return node.is_table() ? "a table" : "a date or a time";
}

std::string hint(std::string_view typed, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_name(typed, known);
  return nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest);
}

[[noreturn]] void throw_missing(const toml::node& table, const std::string& name, const std::string& file,
                                std::string_view what) {
  throw LocatedError(fmt::format("{}: {}", place(file, table.source()), name), "nothing, but it is required",
                     std::string(what));
}

/// What `path` begins with: "[3]" or a key. Empty if it begins with neither.
std::string_view first_link(std::string_view path) {
  if (path.starts_with('[')) return path.substr(0, path.find(']') + 1);
  return path.substr(0, path.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"));
}

const toml::node* follow(const toml::node& node, std::string_view link) {
  if (!link.starts_with('[')) return node.is_table() ? node.as_table()->get(link) : nullptr;
  std::size_t index = 0;
  const auto read = std::from_chars(link.data() + 1, link.data() + link.size(), index);
  if (read.ec != std::errc() || !node.is_array()) return nullptr;
  return node.as_array()->get(index);
}

/// Where `path`, as in ".parts[1].radius (its length)", leads to from `node`, as far as the file has it.
const toml::node& follow_path(const toml::node& node, std::string_view path) {
  const toml::node* at = &node;
  while (true) {
    path.remove_prefix(std::min(path.find_first_not_of(". "), path.size()));
    const std::string_view link = first_link(path);
    const toml::node* next = link.empty() ? nullptr : follow(*at, link);
    if (next == nullptr) return *at;
    at = next;
    path.remove_prefix(link.size());
  }
}

/// The three parts of an InputError's message.
struct Complaint {
  std::string_view field, got, allowed;

  explicit Complaint(std::string_view message) {
    constexpr std::string_view kGot = ": got ";
    constexpr std::string_view kAllowed = ", allowed: ";
    const std::size_t field_end = message.find(kGot);
    const std::size_t got_end = message.rfind(kAllowed);
    assert(field_end != std::string_view::npos && got_end != std::string_view::npos);
    field = message.substr(0, field_end);
    got = message.substr(field_end + kGot.size(), got_end - field_end - kGot.size());
    allowed = message.substr(got_end + kAllowed.size());
  }
};

}  // namespace

bool Value::is_text() const { return node_->is_string(); }
bool Value::is_list() const { return node_->is_array(); }

double Value::number() const {
  if (!node_->is_number()) fail_kind("a number");
  const double value = *node_->value<double>();
  if (!std::isfinite(value)) fail_kind("a finite number");
  return value;
}

int Value::integer() const {
  const auto value = node_->value_exact<std::int64_t>();
  using Limits = std::numeric_limits<int>;
  if (!value || *value < Limits::min() || *value > Limits::max()) fail_kind("an integer");
  return static_cast<int>(*value);
}

bool Value::flag() const {
  const auto value = node_->value_exact<bool>();
  if (!value) fail_kind("true or false");
  return *value;
}

std::string Value::text() const {
  const auto value = node_->value_exact<std::string>();
  if (!value || value->empty()) fail_kind("a text in quotes, not empty");
  return *value;
}

std::size_t Value::choice(std::span<const std::string_view> allowed) const {
  const std::string given = text();
  const auto it = std::find(allowed.begin(), allowed.end(), given);
  if (it == allowed.end()) {
    fail(fmt::format("'{}'{}", given, hint(given, allowed)), fmt::format("{}", fmt::join(allowed, ", ")));
  }
  return static_cast<std::size_t>(it - allowed.begin());
}

std::vector<Value> Value::list() const {
  if (!is_list()) fail_kind("a list");
  std::vector<Value> items;
  for (const toml::node& item : *node_->as_array()) {
    items.emplace_back(item, fmt::format("{}[{}]", name_, items.size()), *file_);
  }
  return items;
}

std::vector<double> Value::numbers() const {
  if (!is_list()) fail_kind("a list of numbers");
  std::vector<double> values;
  for (const Value& item : list()) values.push_back(item.number());
  return values;
}

Value Value::member(std::string_view key, std::string_view what) const {
  if (!node_->is_table()) fail_kind("a table");
  const std::string name = fmt::format("{}.{}", name_, key);
  const toml::node* node = node_->as_table()->get(key);
  if (node == nullptr) throw_missing(*node_, name, *file_, what);
  return {*node, name, *file_};
}

Table Value::table(const Keys& keys, std::string_view separator) const {
  if (!node_->is_table()) fail_kind("a table");
  return {*node_->as_table(), name_, separator, *file_, keys};
}

void Value::require_unit(std::span<const double> v) const {
  constexpr double kTolerance = 1e-9;  // as for the normals of the shapes
  const Eigen::Map<const Eigen::VectorXd> vector(v.data(), static_cast<Eigen::Index>(v.size()));
  const double length = vector.norm();
  if (std::abs(length - 1) <= kTolerance) return;
  std::string allowed = "length 1 within 1e-9";
  if (length > 0) {
    const Eigen::VectorXd unit = vector / length;
    allowed += fmt::format(", as of [{}]", fmt::join(unit.begin(), unit.end(), ", "));
  }
  fail(fmt::format("[{}] of length {}", fmt::join(v, ", "), length), allowed);
}

void Value::fail(const std::string& got, const std::string& allowed) const {
  throw LocatedError(fmt::format("{}: {}", place(*file_, node_->source()), name_), got, allowed);
}

void Value::fail_kind(const std::string& allowed) const { fail(shown(*node_), allowed); }

void Value::fail_length(std::size_t got, const std::string& allowed) const {
  fail(fmt::format("{} numbers", got), allowed);
}

void Value::fail_at(std::string_view path, const std::string& got, const std::string& allowed) const {
  throw LocatedError(fmt::format("{}: {}{}", place(*file_, follow_path(*node_, path).source()), name_, path),
                     got, allowed);
}

void Value::fail_again(std::string_view root, std::string_view message) const {
  const Complaint complaint(message);
  std::string_view path = complaint.field;
  if (path.starts_with(root)) path.remove_prefix(root.size());
  fail_at(path, std::string(complaint.got), std::string(complaint.allowed));
}

Table::Table(const toml::table& table, std::string name, std::string_view separator, const std::string& file,
             const Keys& keys)
    : table_(&table), name_(std::move(name)), prefix_(name_), file_(&file), keys_(keys) {
  if (!name_.empty()) prefix_ += separator;
  std::sort(keys_.begin(), keys_.end());
  for (const auto& [key, node] : table) {
    if (std::binary_search(keys_.begin(), keys_.end(), key.str())) continue;
    throw LocatedError(fmt::format("{}: {}{}", place(file, key.source()), prefix_, key.str()),
                       "an unknown key" + hint(key.str(), keys_), fmt::format("{}", fmt::join(keys_, ", ")));
  }
}

std::optional<Value> Table::find(std::string_view key) const {
  assert(std::binary_search(keys_.begin(), keys_.end(), key));
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  return Value(*node, prefix_ + std::string(key), *file_);
}

Value Table::require(std::string_view key, std::string_view what) const {
  std::optional<Value> value = find(key);
  if (!value) throw_missing(*table_, prefix_ + std::string(key), *file_, what);
  return *std::move(value);
}

void Table::read(std::string_view key, double& number) const {
  if (const auto value = find(key)) number = value->number();
}

void Table::fail(const std::string& got, const std::string& allowed) const {
  throw LocatedError(fmt::format("{}: {}", place(*file_, table_->source()), name_), got, allowed);
}

}  // namespace touchstone::scene_file
