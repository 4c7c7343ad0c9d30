// An experiment with nothing to simulate, for the tests of what all experiments share. Its cases take as
// long, and end as, its sweep values say.

#include <chrono>
#include <stdexcept>
#include <thread>

#include "core/model/errors.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/interrupt.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

CaseResult run_toy(const std::string& kind, int number, int milliseconds) {
  for (int i = 0; i < milliseconds; ++i) {
    throw_if_interrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (kind == "throws") throw std::runtime_error("a reason, with a comma");
  if (kind == "unsupported") throw Unsupported("no such shape");
  return {CaseStatus::ok, "", {{{std::to_string(number * number)}}, {{"0", "1"}, {"0.5", "2"}}}};
}

std::vector<Case> toy_cases(const Selection& selection) {
  std::vector<Case> cases;
  const int milliseconds = selection.integers("milliseconds").front();
  for (const MethodSpec& method : selection.methods) {
    for (const int number : selection.integers("numbers")) {
      Case one;
      one.id = {"toy", method.key, "", {std::to_string(number)}, 0.5, selection.until};
      one.engine_version = "1.2.3";
      one.run = [=] { return run_toy(method.key, number, milliseconds); };
      cases.push_back(std::move(one));
    }
  }
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = {.name = "toy",
                       .about = "What does the harness do?",
                       .examples = "  toy --quick\n",
                       .methods = {"fine"},
                       .axes = {{"numbers", "to square", AxisKind::integer, {"10", "9", "8", "7"}, {"2"}},
                                {"milliseconds", "a case", AxisKind::integer, {"1"}, {"1"}}}},
      .sweep_columns = {"number"},
      .tables = {{"summary", {"square"}}, {"curve", {"t_s", "value_J"}}},
      .seed = 42,
      .cases = toy_cases};
  return run_experiment(experiment, argc, argv);
}
