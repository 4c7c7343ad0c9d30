#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/method.h"
#include "experiments/harness/isolation_policy.h"

/// The command line that all experiments share.
namespace touchstone::harness {

/// What the values of an axis may be.
enum class AxisKind {
  integer,   ///< at least Axis::least
  positive,  ///< a finite number > 0
  text,      ///< one of Axis::allowed, or anything if there are none
};

/// A list of sweep values that the option --`name` replaces: "edges", "step-sizes".
struct Axis {
  std::string name;
  std::string help;  ///< what it is, with the unit
  AxisKind kind = AxisKind::positive;
  std::vector<std::string> values;  ///< as the committed results have them
  std::vector<std::string> quick;   ///< for --quick
  long least = 1;
  std::vector<std::string> allowed = {};
};

/// A method as --methods names it: its key, and options as in "stewart_trinkle:candidates=all;edges=20".
struct MethodSpec {
  std::string key;
  Options options;
};
/// @throws InputError on a malformed option
MethodSpec parse_method(const std::string& text);
std::string format_method(const MethodSpec& method);

/// Part `index` (from 1) of `count` parts of a sweep.
struct Shard {
  int index = 1;
  int count = 1;
  [[nodiscard]] bool whole() const { return count == 1; }
  /// Cases are dealt out in turn, so that each part gets some of the costly ones.
  [[nodiscard]] bool contains(std::size_t case_index) const {
    return case_index % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }
};

struct CommandLineSpec {
  std::string name;                  ///< of the binary and of its folder of results
  std::string about;                 ///< the question that it answers, for --help
  std::string examples;              ///< command lines with a word on each, for --help
  std::vector<std::string> methods;  ///< defaults of --methods
  std::vector<Axis> axes;
  double until = 10.0;  ///< default horizon [s]
  double quick_until = 1.0;
};

/// What a command line asks for, every value checked.
struct Selection {
  std::vector<MethodSpec> methods;
  std::map<std::string, std::vector<std::string>> axes;  ///< by Axis::name, numbers in canonical form
  double until = 0.0;                                    ///< [s]
  int jobs = 1;
  Shard shard;
  IsolationPolicy isolation;
  std::filesystem::path out;
  bool list = false;
  /// The command with every option that matters to the result.
  std::string command;

  [[nodiscard]] const std::vector<std::string>& texts(const std::string& axis) const { return axes.at(axis); }
  [[nodiscard]] std::vector<double> numbers(const std::string& axis) const;
  [[nodiscard]] std::vector<int> integers(const std::string& axis) const;
};

/// @returns none if --help was asked for and has been printed
/// @throws InputError naming the option, its value and what is allowed
std::optional<Selection> parse_command_line(const CommandLineSpec& spec, int argc, const char* const* argv);

}  // namespace touchstone::harness
