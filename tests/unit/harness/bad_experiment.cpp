// An experiment whose methods crash, hang, spoil their state and leave, for the tests of isolation. They come
// from a table of its own, and so through all that methods from the registry go through. Those named after an
// engine have a version, and are isolated by default; `ours` has none.

#include <fstream>

#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "tests/support/bad_method.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

/// Tells its process id, so that a test can see whether it lives on, and hangs.
void tell_and_hang(BodyState<2>& state) {
  if (const char* file = std::getenv("TOUCHSTONE_TEST_PID")) std::ofstream(file) << getpid() << std::endl;
  test::hang(state);
}

template <test::BadMethod::Misdeed misdeed>
std::unique_ptr<Method<2>> make(const Scene<2>& scene, const Options&) {
  return std::make_unique<test::BadMethod>(scene, misdeed);
}
std::unique_ptr<Method<2>> crash_on_loading(const Scene<2>&, const Options&) { std::abort(); }
std::unique_ptr<Method<2>> want_no_option(const Scene<2>&, const Options&) {
  throw InputError("option 'a'", 1.0, "none");
}

std::string engine_version() { return "1.0"; }
std::string no_version() { return {}; }

const std::vector<MethodEntry<2>> kTable = {
    {"crashes", "", &make<test::crash>, &engine_version},
    {"crashes_on_loading", "", &crash_on_loading, &engine_version},
    {"fine", "", &make<test::behave>, &engine_version},
    {"hangs", "", &make<tell_and_hang>, &engine_version},
    {"leaves", "", &make<test::leave>, &engine_version},
    {"ours", "", &make<test::behave>, &no_version},
    {"ours_crashes", "", &make<test::crash>, &no_version},
    {"refuses", "", &want_no_option, &engine_version},
    {"spoils", "", &make<test::spoil>, &engine_version},
};

std::vector<Case> cases(const Selection& selection) {
  Scene<2> scene;
  scene.bodies.resize(1);
  scene.bodies[0].name = "ball";
  scene.bodies[0].shape.geometry = Sphere<2>{1.0};
  const auto shared = std::make_shared<const Scene<2>>(scene);
  std::vector<Case> cases;
  for (const MethodSpec& method : selection.methods) {
    for (const std::string& number : selection.texts("numbers")) {
      MethodCase<2> one;
      one.scenario = "bad";
      one.scene = shared;
      one.method = method;
      one.table = kTable;
      one.sweep = {number};
      one.run = {.h = 0.5, .until = selection.until, .report = {}};
      one.tabulate = [](const CaseRun<2>& run) {
        return std::vector<std::vector<Row>>{{{number_cell(run.steps)}}};
      };
      cases.push_back(make_case(std::move(one)));
    }
  }
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = {.name = "bad",
                       .about = "What does a bad method cost?",
                       .examples = "  bad --quick\n",
                       .methods = {"fine"},
                       .axes = {{"numbers", "cases of each method", AxisKind::integer, {"1"}, {"1"}}},
                       .until = 5.0,
                       .quick_until = 5.0},
      .sweep_columns = {"number"},
      .tables = {{"summary", {"steps"}}},
      .seed = std::nullopt,
      .cases = cases};
  return run_experiment(experiment, argc, argv);
}
