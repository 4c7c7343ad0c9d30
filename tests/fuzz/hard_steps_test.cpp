// Steps at random that searches have failed at, kept: those solved since are to stay so, certified at 1e-10.
// Those that are not solved are to be refused, and their contacts wedge with a drift that they cannot close
// (wedge.h); of some all modes of their contacts are searched here, of the others by unsolved_steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "experiments/scene_file/scene_file.h"
#include "tests/fuzz/wedge.h"
#include "tests/support/mode_search.h"
#include "tests/support/random_steps.h"
#include "tests/support/step_fault.h"

namespace touchstone {
namespace {

constexpr double kCertified = 1e-10;
constexpr int kStarts = 2;  ///< of each mode

constexpr std::string_view kJammed = "jammed: impulses grow without bound";

struct HardStep {
  std::string scene;  ///< file name without extension
  double h = 0.0;     ///< [s]
  bool has_solution = true;
};

/// The first three cells of each row.
std::vector<std::array<std::string, 3>> rows_of(const std::string& file) {
  std::ifstream in(fmt::format("{}/{}", HARD_STEPS, file));
  std::vector<std::array<std::string, 3>> rows;
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    for (auto& cell : rows.emplace_back()) std::getline(cells, cell, ',');
  }
  return rows;
}

std::vector<HardStep> listed() {
  std::vector<HardStep> steps;
  for (const auto& [scene, h, solution] : rows_of("list.csv"))
    steps.push_back({scene, std::stod(h), solution == "yes"});
  return steps;
}

/// Those of the steps that are not solved whose impulses grow without bound.
std::vector<HardStep> jammed() {
  std::vector<HardStep> steps;
  for (const auto& [seed, h, reason] : rows_of("unsolved.csv")) {
    if (reason == kJammed) steps.push_back({"step_" + seed, std::stod(h), false});
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
        EXPECT_EQ(report.reason, kJammed);
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

/// What find_wedge() says of the step, once it was tried.
template <int Dim>
std::optional<Wedge> wedge_of(const Scene<Dim>& scene, double h, StepReport& report) {
  ImplicitStepper<Dim> stepper(scene, {});
  report = stepper.step(h);
  StepProblem<Dim> island = stepper.problem();
  Eigen::VectorXd end;
  return find_wedge(island, end);
}

class JammedSteps : public testing::TestWithParam<HardStep> {};

// The relaxed problem is solved to what rounding of loads of 1e3 m V leaves, so that its drift is a fact of
// the step; and that drift is more than any answer may be off by.
TEST_P(JammedSteps, WedgeWithADriftThatNoImpulsesClose) {
  constexpr double kRounding = 1e-11;
  std::visit(
      [&](const auto& scene) {
        StepReport report;
        const auto wedge = wedge_of(scene, GetParam().h, report);
        EXPECT_EQ(report.status, StepStatus::not_converged);
        EXPECT_EQ(report.reason, kJammed);
        ASSERT_TRUE(wedge.has_value());
        EXPECT_GE(wedge->contacts.size(), 2U);
        EXPECT_LT(wedge->residual, kRounding);
        EXPECT_LT(wedge->imbalance, kRounding);
        EXPECT_LT(wedge->use_of_cone, 1.0);
        EXPECT_LT(wedge->drift, -kCertified);
        EXPECT_LT(wedge->drift_change, 1e-3 * std::abs(wedge->drift));
        RecordProperty("drift", fmt::format("{:.1e}", wedge->drift));
      },
      scene_of(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Listed, JammedSteps, testing::ValuesIn(jammed()),
                         [](const auto& step) { return step.param.scene; });

// The self-stress foretells with how much friction the contacts wedge: with less than it uses the step is
// solved and no path runs off, with more it stays jammed.
TEST(Wedge, NeedsTheFrictionOfItsSelfStress) {
  constexpr double kMargin = 0.05;
  const HardStep step{"step_27202", 0.0001155797857412539, false};
  const auto scene = std::get<Scene<3>>(scene_of(step));
  StepReport report;
  const auto wedge = wedge_of(scene, step.h, report);
  ASSERT_TRUE(wedge.has_value());
  for (const bool less : {true, false}) {
    Scene<3> other = scene;
    other.contact_law.mu *= wedge->use_of_cone * (less ? 1 - kMargin : 1 + kMargin);
    EXPECT_EQ(wedge_of(other, step.h, report).has_value(), !less);
    EXPECT_EQ(report.status, less ? StepStatus::solved : StepStatus::not_converged);
  }
}

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
