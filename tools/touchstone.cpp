// Runs scene files under any method, and tells which methods and scenarios there are.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "baselines/options.h"
#include "core/model/errors.h"
#include "experiments/harness/csv.h"
#include "experiments/harness/interrupt.h"
#include "tools/touchstone/listing.h"
#include "tools/touchstone/run.h"

namespace {

using namespace touchstone;

enum ExitCode { kDone = 0, kStepFailed = 1, kBadInput = 2, kInputOutput = 3, kInterrupted = 130 };

constexpr const char* kAbout =
    "Touchstone runs rigid-body scenes with contact under our formulations and under physics engines, and "
    "writes down what\nthey do in one form, judged by one judge.";

constexpr const char* kHelp = R"(
A first run, from the top of the repository:
  touchstone methods
  touchstone validate experiments/scenes/sphere_spin.toml
  touchstone run experiments/scenes/sphere_spin.toml --method implicit_ncp --step 0.07 --until 1.4 --out /tmp/spin
The same scene under another method, with options of its own:
  touchstone run experiments/scenes/disc_rolling.toml --method stewart_trinkle --option edges=20 \
      --step 0.01 --until 2 --out /tmp/polygon

A scene file is TOML: bodies with mass, shape and initial state, friction, joints. The files in experiments/scenes/
explain the format; experiments/scenes/sphere_spin.toml is the one to begin with.

Exit codes: 0 done, 1 a step failed, 2 bad usage or input, 3 a file cannot be read or written, 130 interrupted.)";

constexpr const char* kRunHelp = R"(
Writes three tables to DIR, all or none:
  trajectory.csv  pose and velocity of every moving body at its centre of mass, world frame
  contacts.csv    gap, forces, slip and spin at each contact, from the second time on: forces belong to the step before
  energy.csv      energy, and what was lost to friction, to impacts, and to the numbers (drift) since the start; what
                  gravity and the applied forces have done is what potential_J has fallen by
t = 0 and the end are always in. A planar scene lies in z = 0.

A step that fails ends the run. What was recorded before it is written, the time and the reason are told, and the exit
code is 1. An interrupted run writes nothing.

Examples:
  touchstone run experiments/scenes/sphere_spin.toml --method implicit_ncp --step 0.07 --until 1.4 --out /tmp/spin
  touchstone run experiments/scenes/disc_rolling.toml --method stewart_trinkle --option edges=20 --option candidates=all \
      --step 0.01 --until 10 --every 10 --out /tmp/polygon)";

/// The options of `run` as they stand on the command line.
struct RunWords {
  std::string scene, method, step, until, out;
  std::string every = "1";
  std::vector<std::string> options;
};

double positive(const std::string& option, const std::string& text) {
  double value = 0;
  if (!harness::parse_number(text, value) || !(value > 0) || !std::isfinite(value)) {
    throw InputError(option, "'" + text + "'", "a finite number > 0 [s]");
  }
  return value;
}

long count(const std::string& option, const std::string& text) {
  double value = 0;
  constexpr double kMost = 1e9;
  if (!harness::parse_number(text, value) || !(value >= 1 && value <= kMost) || value != std::floor(value)) {
    throw InputError(option, "'" + text + "'", "an integer >= 1");
  }
  return static_cast<long>(value);
}

program::RunRequest check(const RunWords& words) {
  program::RunRequest request;
  request.scene = words.scene;
  request.method = words.method;
  for (const std::string& option : words.options) add_option(request.options, option);
  request.h = positive("--step", words.step);
  request.until = positive("--until", words.until);
  if (words.out.empty()) throw InputError("--out", "''", "the path of a folder");
  request.out = words.out;
  request.every = count("--every", words.every);
  return request;
}

void declare_run(CLI::App& run, RunWords& words) {
  run.footer(kRunHelp);
  run.add_option("SCENE", words.scene, "scene file")->required()->type_name("");
  run.add_option("--method", words.method, "key of a method, as `touchstone methods` lists them")
      ->required()
      ->type_name("KEY");
  run.add_option("--step", words.step, "step size [s]")->required()->type_name("H");
  run.add_option("--until", words.until, "horizon [s], a multiple of the step size")
      ->required()
      ->type_name("T");
  run.add_option("--out", words.out, "folder for the tables, made if need be")->required()->type_name("DIR");
  run.add_option("--every", words.every, "write every Nth step only [1]")->type_name("N");
  run.add_option("--option", words.options, "an option of the method; may be given again")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->take_all();
}

/// CLI11 would say no more than that a subcommand is required.
void require_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string first = argc > 1 ? argv[1] : "";
  const bool known = first.starts_with("-") || std::find(names.begin(), names.end(), first) != names.end();
  if (known) return;
  throw InputError("command", first.empty() ? "nothing" : "'" + first + "'",
                   fmt::format("{} (see touchstone --help)", fmt::join(names, ", ")));
}

int run_command(int argc, char** argv) {
  CLI::App app(kAbout, "touchstone");
  app.footer(kHelp);
  app.require_subcommand(1);
  RunWords words;
  CLI::App& run = *app.add_subcommand("run", "Run a scene under a method and write what happens.");
  declare_run(run, words);
  CLI::App& validate = *app.add_subcommand("validate", "Check a scene file, and run nothing.");
  validate.add_option("SCENE", words.scene, "scene file")->required()->type_name("");
  const CLI::App& methods = *app.add_subcommand("methods", "List the methods of this build.");
  const CLI::App& scenarios = *app.add_subcommand("scenarios", "List the scenarios that have a truth.");
  require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "touchstone: {} (see touchstone --help)\n", error.what());
    return kBadInput;
  }
  if (methods) fmt::print("{}", program::list_methods());
  if (scenarios) fmt::print("{}", program::list_scenarios());
  if (validate) fmt::print("{}", program::describe_scene(words.scene));
  if (run && !program::run(check(words))) return kStepFailed;
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const harness::InterruptScope interrupts;
  try {
    return run_command(argc, argv);
  } catch (const harness::Interrupted&) {
    fmt::print(stderr, "touchstone: interrupted, nothing written\n");
    return kInterrupted;
  } catch (const InputError& error) {
    fmt::print(stderr, "touchstone: {}\n", error.what());
    return kBadInput;
  } catch (const IoError& error) {
    fmt::print(stderr, "touchstone: {}\n", error.what());
    return kInputOutput;
  }
}
