#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/method.h"

namespace touchstone {

/// Reads a method's options by name, with defaults and ranges, and remembers what is in force.
///
///   OptionReader read("ode_step", options);
///   erp_ = read.number("erp", 0.2, 0.0, 1.0);
///   read.finish();                       // throws if an option was given that nobody asked for
///   effective_ = read.effective();
class OptionReader {
 public:
  OptionReader(std::string method, Options given) : method_(std::move(method)), given_(std::move(given)) {}

  /// A number in [least, most]. @throws InputError with the field, the value and the range
  double number(const std::string& name, double fallback, double least, double most);
  int integer(const std::string& name, int fallback, int least, int most);
  bool flag(const std::string& name, bool fallback);
  /// One of `allowed`.
  std::string choice(const std::string& name, const std::string& fallback,
                     const std::vector<std::string>& allowed);
  /// Free text, for options with a syntax of their own; the caller validates and may use fail().
  std::string text(const std::string& name, const std::string& fallback);

  [[noreturn]] void fail(const std::string& name, const std::string& value, const std::string& allowed) const;
  /// @throws InputError if an option was given that was not read, with the list of those that are
  void finish() const;
  [[nodiscard]] const Options& effective() const { return effective_; }

 private:
  std::string method_;
  Options given_;
  Options effective_;
};

/// "a=1;b=2", sorted by name: the form of the `options` column. Empty for no options.
std::string format_options(const Options& options);
/// Reads "name=value" into `options`. @throws InputError if there is no '=' or the name is empty or given
/// twice
void add_option(Options& options, const std::string& name_equals_value);

}  // namespace touchstone
