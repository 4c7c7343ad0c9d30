#include "baselines/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/model/errors.h"

namespace touchstone {

namespace {

template <typename Number>
bool parse(const std::string& text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

}  // namespace

std::string OptionReader::text(const std::string& name, const std::string& fallback) {
  const auto it = given_.find(name);
  const std::string value = it == given_.end() ? fallback : it->second;
  effective_[name] = value;
  return value;
}

double OptionReader::number(const std::string& name, double fallback, double least, double most) {
  const std::string value = text(name, fmt::format("{}", fallback));
  double number = 0;
  if (!parse(value, number) || !(number >= least && number <= most)) {
    fail(name, value, fmt::format("a number from {} to {}", least, most));
  }
  return number;
}

int OptionReader::integer(const std::string& name, int fallback, int least, int most) {
  const std::string value = text(name, fmt::format("{}", fallback));
  int number = 0;
  if (!parse(value, number) || number < least || number > most) {
    fail(name, value, fmt::format("an integer from {} to {}", least, most));
  }
  return number;
}

bool OptionReader::flag(const std::string& name, bool fallback) {
  return choice(name, fallback ? "true" : "false", {"true", "false"}) == "true";
}

std::string OptionReader::choice(const std::string& name, const std::string& fallback,
                                 const std::vector<std::string>& allowed) {
  std::string value = text(name, fallback);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    fail(name, value, fmt::format("one of {}", fmt::join(allowed, ", ")));
  }
  return value;
}

void OptionReader::fail(const std::string& name, const std::string& value, const std::string& allowed) const {
  throw InputError(fmt::format("method {} option '{}'", method_, name), "'" + value + "'", allowed);
}

void OptionReader::finish() const {
  for (const auto& [name, value] : given_) {
    if (effective_.contains(name)) continue;
    std::vector<std::string> known;
    for (const auto& entry : effective_) known.push_back(entry.first);
    fail(name, value, known.empty() ? "no options" : fmt::format("the options {}", fmt::join(known, ", ")));
  }
}

std::string format_options(const Options& options) {
  std::string text;
  for (const auto& [name, value] : options) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
  }
  return text;
}

void add_option(Options& options, const std::string& name_equals_value) {
  const auto equals = name_equals_value.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--option", "'" + name_equals_value + "'", "name=value");
  }
  const std::string name = name_equals_value.substr(0, equals);
  if (!options.emplace(name, name_equals_value.substr(equals + 1)).second) {
    throw InputError("--option", "'" + name + "' twice", "each option once");
  }
}

}  // namespace touchstone
