#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace touchstone {

/// Bad input: which field, which value, and what is allowed. Programs print it and exit with code 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& field, const std::string& value, const std::string& allowed)
      : std::runtime_error(fmt::format("{}: got {}, allowed: {}", field, value, allowed)) {}
  InputError(const std::string& field, double value, const std::string& allowed)
      : InputError(field, fmt::format("{}", value), allowed) {}
};

/// A method cannot represent or do what is asked; the reason becomes a row of the results, not a crash.
class Unsupported : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written. Programs print it and exit with code 3.
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace touchstone
