#include "experiments/harness/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <thread>

#include "baselines/options.h"
#include "core/model/errors.h"
#include "experiments/harness/csv.h"

namespace touchstone::harness {

namespace {

using Texts = std::vector<std::string>;

/// The option as it stands on the command line, before its values are checked.
struct RawCommandLine {
  std::optional<Texts> methods;
  std::map<std::string, std::optional<Texts>> axes;
  std::optional<std::string> until;
  std::string jobs;
  std::string shard = "1/1";
  std::string isolate = "auto";
  std::string time_limit = number_cell(IsolationPolicy{}.time_limit.count());
  std::string out;
  bool list = false;
  bool quick = false;
};

std::string quoted(const std::string& text) { return "'" + text + "'"; }

long parse_integer(const std::string& option, const std::string& text, long least, long most) {
  long value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < least || value > most) {
    throw InputError(option, quoted(text),
                     most == std::numeric_limits<int>::max()
                         ? fmt::format("an integer >= {}", least)
                         : fmt::format("an integer from {} to {}", least, most));
  }
  return value;
}

double parse_positive(const std::string& option, const std::string& text) {
  double value = 0;
  if (!parse_number(text, value) || !(value > 0) || !std::isfinite(value)) {
    throw InputError(option, quoted(text), "a finite number > 0");
  }
  return value;
}

/// The value in the one form that it has in keys, columns and the command.
std::string canonical_value(const Axis& axis, const std::string& text) {
  const std::string option = "--" + axis.name;
  switch (axis.kind) {
    case AxisKind::integer:
      return number_cell(parse_integer(option, text, axis.least, std::numeric_limits<int>::max()));
    case AxisKind::positive:
      return number_cell(parse_positive(option, text));
    case AxisKind::text:
      break;
  }
  const bool any = axis.allowed.empty();
  if (!any && std::find(axis.allowed.begin(), axis.allowed.end(), text) == axis.allowed.end()) {
    throw InputError(option, quoted(text), fmt::format("{}", fmt::join(axis.allowed, ", ")));
  }
  return text;
}

void require_distinct(const std::string& option, const Texts& values) {
  std::set<std::string> seen;
  for (const std::string& value : values) {
    if (!seen.insert(value).second) throw InputError(option, quoted(value) + " twice", "each value once");
  }
}

Texts axis_values(const Axis& axis, const std::optional<Texts>& given, bool quick) {
  Texts values = given ? *given : (quick ? axis.quick : axis.values);
  for (std::string& value : values) value = canonical_value(axis, value);
  require_distinct("--" + axis.name, values);
  return values;
}

Shard parse_shard(const std::string& text) {
  const auto slash = text.find('/');
  const std::string allowed = "i/n with 1 <= i <= n, both integers";
  if (slash == std::string::npos) throw InputError("--shard", quoted(text), allowed);
  constexpr long kMost = 1'000'000;
  try {
    const long count = parse_integer("n", text.substr(slash + 1), 1, kMost);
    return {static_cast<int>(parse_integer("i", text.substr(0, slash), 1, count)), static_cast<int>(count)};
  } catch (const InputError&) {
    throw InputError("--shard", quoted(text), allowed);
  }
}

Isolate parse_isolate(const std::string& text) {
  if (text == "auto") return Isolate::automatic;
  if (text == "always") return Isolate::always;
  if (text == "never") return Isolate::never;
  throw InputError("--isolate", quoted(text), "auto, always, never");
}

int default_jobs() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

std::string help_footer(const CommandLineSpec& spec) {
  return fmt::format(
      "\nA method is KEY or KEY:name=value;name=value, quoted for the shell. A number that is not finite, "
      "not in range "
      "or twice is refused.\nAn interrupted run goes on where it stopped when the same command is given "
      "again. Parts of "
      "a sweep (--shard) may run\nat once, on several machines that share --out; when all are done the same "
      "command "
      "without --shard writes the tables.\n\nExamples:\n{}\nExit codes: 0 done, 1 a case failed, 2 bad usage "
      "or input, "
      "3 I/O, 130 interrupted.",
      spec.examples);
}

/// Declares the options on `app`, to be read into `raw`.
void declare(CLI::App& app, const CommandLineSpec& spec, RawCommandLine& raw) {
  app.footer(help_footer(spec));
  app.add_option("--methods", raw.methods, fmt::format("methods to run [{}]", fmt::join(spec.methods, ",")))
      ->delimiter(',')
      ->type_name("METHOD,...");
  for (const Axis& axis : spec.axes) {
    app.add_option("--" + axis.name, raw.axes[axis.name],
                   fmt::format("{} [{}]", axis.help, fmt::join(axis.values, ",")))
        ->delimiter(',')
        ->type_name("VALUE,...");
  }
  app.add_option("--until", raw.until,
                 fmt::format("horizon [s], a multiple of every step size [{}]", spec.until))
      ->type_name("SECONDS");
  raw.jobs = std::to_string(default_jobs());
  app.add_option("--jobs", raw.jobs, "threads; the results do not depend on it [number of processors]")
      ->type_name("N");
  app.add_option("--shard", raw.shard, "run part i of n parts only, and keep it in a journal in --out")
      ->type_name("i/n");
  app.add_option("--isolate", raw.isolate,
                 "cases that run in processes of their own: auto (those of engines), always, never [auto]")
      ->type_name("WHICH");
  app.add_option("--time-limit", raw.time_limit,
                 fmt::format("wall time after which an isolated case has failed [{}]", raw.time_limit))
      ->type_name("SECONDS");
  raw.out = "results/" + spec.name;
  app.add_option("--out", raw.out, fmt::format("folder for the tables [{}]", raw.out))->type_name("DIR");
  app.add_flag("--list", raw.list, "print the cases and stop");
  app.add_flag("--quick", raw.quick, "a small sweep of a few seconds, for a first look and for tests");
}

/// With CLI11's complaints turned into ours. @returns false if help was printed
bool parse_raw(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    app.exit(help);
    return false;
  } catch (const CLI::ParseError& error) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
    throw InputError("command line", error.what(), fmt::format("{} (see --help)", fmt::join(names, " ")));
  }
  return true;
}

/// In single quotes if a shell would read it in another way.
std::string for_shell(const std::string& text) {
  return text.find_first_of(";|&<>()$`\\\"' *?[]#~!{}") == std::string::npos ? text : quoted(text);
}

std::string normal_command(const CommandLineSpec& spec, const Selection& selection) {
  Texts methods;
  for (const MethodSpec& method : selection.methods) methods.push_back(format_method(method));
  std::string command =
      fmt::format("{} --methods {}", spec.name, for_shell(fmt::format("{}", fmt::join(methods, ","))));
  for (const Axis& axis : spec.axes) {
    const std::string values = fmt::format("{}", fmt::join(selection.texts(axis.name), ","));
    command += fmt::format(" --{} {}", axis.name, for_shell(values));
  }
  return command + " --until " + number_cell(selection.until);
}

Selection check(const CommandLineSpec& spec, const RawCommandLine& raw) {
  Selection selection;
  const Texts methods = raw.methods.value_or(spec.methods);
  require_distinct("--methods", methods);
  for (const std::string& text : methods) selection.methods.push_back(parse_method(text));
  for (const Axis& axis : spec.axes) {
    selection.axes[axis.name] = axis_values(axis, raw.axes.at(axis.name), raw.quick);
  }
  const double until = raw.quick ? spec.quick_until : spec.until;
  selection.until = raw.until ? parse_positive("--until", *raw.until) : until;
  constexpr long kMostJobs = 4096;
  selection.jobs = static_cast<int>(parse_integer("--jobs", raw.jobs, 1, kMostJobs));
  selection.shard = parse_shard(raw.shard);
  selection.isolation.isolate = parse_isolate(raw.isolate);
  selection.isolation.time_limit =
      std::chrono::duration<double>(parse_positive("--time-limit", raw.time_limit));
  if (raw.out.empty()) throw InputError("--out", "''", "the path of a folder");
  selection.out = raw.out;
  selection.list = raw.list;
  selection.command = normal_command(spec, selection);
  return selection;
}

}  // namespace

MethodSpec parse_method(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  MethodSpec method{text.substr(0, colon), {}};
  try {
    if (method.key.empty()) throw InputError("key", "''", "a name");
    for (std::size_t at = colon; at < text.size();) {
      const std::size_t end = std::min(text.find(';', at + 1), text.size());
      add_option(method.options, text.substr(at + 1, end - at - 1));
      at = end;
    }
  } catch (const InputError&) {
    throw InputError("--methods", quoted(text), "KEY or KEY:name=value;name=value, each name once");
  }
  return method;
}

std::string format_method(const MethodSpec& method) {
  return method.options.empty() ? method.key : method.key + ":" + format_options(method.options);
}

std::vector<double> Selection::numbers(const std::string& axis) const {
  std::vector<double> values;
  for (const std::string& text : texts(axis)) values.push_back(parse_positive("--" + axis, text));
  return values;
}

std::vector<int> Selection::integers(const std::string& axis) const {
  std::vector<int> values;
  constexpr long kLeast = std::numeric_limits<int>::min();
  constexpr long kMost = std::numeric_limits<int>::max();
  for (const std::string& text : texts(axis)) {
    values.push_back(static_cast<int>(parse_integer("--" + axis, text, kLeast, kMost)));
  }
  return values;
}

std::optional<Selection> parse_command_line(const CommandLineSpec& spec, int argc, const char* const* argv) {
  CLI::App app(spec.about, spec.name);
  RawCommandLine raw;
  declare(app, spec, raw);
  if (!parse_raw(app, argc, argv)) return std::nullopt;
  return check(spec, raw);
}

}  // namespace touchstone::harness
