#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <variant>
#include <vector>

/// What is claimed of the results, as results/gates.toml states it. Its form is described in
/// results/SCHEMA.md.
namespace touchstone::gate {

/// What is made of the values of the rows before they meet the bound.
enum class Aggregate {
  each,  ///< nothing: every value must be within the bound
  max,
  min,
  count,         ///< the number of rows
  spread,        ///< largest less smallest value
  largest_rise,  ///< largest step up from one row to the next, in the order of Claim::along; "it falls" is <=
                 ///< 0
  largest_fall,  ///< the same downwards; "it rises" is <= 0
};

/// A number must be in [at_least, at_most]; a text must be `equals`.
struct Bound {
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  std::string equals;  ///< empty: the bound is on numbers
};

/// A row is meant if its cell in `column` is one of `values`; numbers are compared by value, texts letter by
/// letter.
struct Condition {
  std::string column;
  std::vector<std::variant<std::string, double>> values;
};

struct Claim {
  std::string name;
  std::string file;  ///< below the folder of results
  std::vector<Condition> filter;
  std::string column;
  std::string
      relative_to;    ///< if given, a value v becomes |v - w| / |w| with w from this column of the same row
  std::string along;  ///< numeric column that orders the rows, for largest_rise and largest_fall
  Aggregate aggregate = Aggregate::each;
  Bound bound;
  std::string reason;  ///< why the bound is what it is
};

/// @throws IoError if the file cannot be read; InputError naming file, line and key if it is malformed
std::vector<Claim> read_claims(const std::filesystem::path& file);

}  // namespace touchstone::gate
