// Steps at random that searches have failed at, kept: those solved since are to stay so, certified at 1e-10,
// and those without a solution are to be refused, and shown to have none: no mode of their contacts has one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "experiments/scene_file/scene_file.h"
#include "tests/support/mode_search.h"
#include "tests/support/random_steps.h"
#include "tests/support/step_fault.h"

namespace touchstone {
namespace {

constexpr double kCertified = 1e-10;
constexpr int kStarts = 2;  ///< of each mode

struct HardStep {
  std::string scene;  ///< file name without extension
  double h = 0.0;     ///< [s]
  bool has_solution = true;
};

std::vector<HardStep> listed() {
  std::ifstream in(std::string(HARD_STEPS) + "/list.csv");
  std::vector<HardStep> steps;
  std::string line;
  std::getline(in, line);  // scene,h,solution,cause
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::array<std::string, 3> cell;
    for (auto& c : cell) std::getline(cells, c, ',');
    steps.push_back({cell[0], std::stod(cell[1]), cell[2] == "yes"});
  }
  return steps;
}

scene_file::AnyScene scene_of(const HardStep& step) {
  return scene_file::read_scene(fmt::format("{}/{}.toml", HARD_STEPS, step.scene));
}

class HardSteps : public testing::TestWithParam<HardStep> {};

TEST_P(HardSteps, AreSolvedAndCertifiedOrRefused) {
  const HardStep& hard = GetParam();
  std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        ImplicitStepper<Dim> stepper(scene, {});
        const std::vector<BodyState<Dim>> before(stepper.state().begin(), stepper.state().end());
        const StepReport report = stepper.step(hard.h);
        if (hard.has_solution) {
          ASSERT_EQ(report.status, StepStatus::solved) << report.reason << ", residual " << report.residual;
          const auto fault = step_fault(stepper, before, hard.h, kCertified);
          EXPECT_TRUE(!fault || fault->is_rounding) << fault->description;
          return;
        }
        EXPECT_EQ(report.status, StepStatus::not_converged);
        for (std::size_t i = 0; i < before.size(); ++i) {  // a step that is not solved changes nothing
          EXPECT_EQ(stepper.state()[i].velocity, before[i].velocity);
          EXPECT_EQ(stepper.state()[i].pose.position, before[i].pose.position);
        }
        EXPECT_EQ(report.reason, "jammed: impulses grow without bound");
        StepProblem<Dim> island = stepper.problem();
        const ModeReport modes = search_modes(island, {.starts = kStarts});
        // That the search solves the modes' equations is what makes it count that no root fulfils the
        // inequalities as well; by far, against what would be certified.
        EXPECT_GE(modes.solved_modes, modes.modes / 2);
        EXPECT_GT(modes.least_violation, 100 * kCertified);
        RecordProperty("least_violation", fmt::format("{:.1e}", modes.least_violation));
      },
      scene_of(hard));
}

INSTANTIATE_TEST_SUITE_P(Listed, HardSteps, testing::ValuesIn(listed()),
                         [](const auto& step) { return step.param.scene; });

// Of steps that have a solution the search of modes finds it.
TEST(ModeSearch, FindsTheSolutionsOfOrdinarySteps) {
  int searched = 0;
  for (std::uint64_t seed = 1; searched < 10; ++seed) {
    const auto step = random_steps::random_step<2>(seed);
    ImplicitStepper<2> stepper(step.scene, {});
    ASSERT_EQ(stepper.step(step.h).status, StepStatus::solved);
    StepProblem<2> island = stepper.problem();
    if (island.contacts().empty() || island.contacts().size() > 2) continue;
    ++searched;
    EXPECT_LE(search_modes(island, {.starts = 5}).least_violation, kCertified) << "seed " << seed;
  }
}

}  // namespace
}  // namespace touchstone
