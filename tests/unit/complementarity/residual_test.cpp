#include "core/complementarity/residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/complementarity/report.h"
#include "experiments/problems/literature.h"

namespace touchstone {
namespace {

using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double of_row(double lower, double upper, double z, double f) {
  return natural_residual(VectorXd::Constant(1, lower), VectorXd::Constant(1, upper),
                          VectorXd::Constant(1, z), VectorXd::Constant(1, f))
      .value;
}

TEST(NaturalResidual, IsZeroExactlyAtComplementaryRows) {
  EXPECT_EQ(of_row(0, infinity, 0, 3), 0);
  EXPECT_EQ(of_row(0, infinity, 2, 0), 0);
  EXPECT_EQ(of_row(0, 5, 5, -3), 0);
  EXPECT_EQ(of_row(-infinity, 5, 5, -3), 0);
  EXPECT_EQ(of_row(-infinity, infinity, 17, 0), 0);
  EXPECT_EQ(of_row(2, 2, 2, 99), 0) << "a fixed unknown satisfies any F";
}

TEST(NaturalResidual, MeasuresTheDistanceToTheClampedPoint) {
  EXPECT_EQ(of_row(0, infinity, 0, -3), 3) << "F of the wrong sign at the bound";
  EXPECT_EQ(of_row(0, infinity, 2, 0.5), 0.5) << "the smaller of z and F";
  EXPECT_EQ(of_row(0, infinity, 0.5, 2), 0.5);
  EXPECT_EQ(of_row(0, 5, 5, 3), 3);
  EXPECT_EQ(of_row(0, 5, 4, -3), 1) << "no farther than the bound";
  EXPECT_EQ(of_row(-infinity, infinity, 1, -0.25), 0.25);
  EXPECT_EQ(of_row(0, infinity, -1, 0), 1) << "z out of its bounds";
}

TEST(NaturalResidual, NamesTheWorstRow) {
  const VectorXd lower = VectorXd::Zero(3);
  const VectorXd upper = VectorXd::Constant(3, infinity);
  const NaturalResidual residual =
      natural_residual(lower, upper, Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0.1, 0.7, 0.2));
  EXPECT_EQ(residual.value, 0.7);
  EXPECT_EQ(residual.worst_row, 1);
}

TEST(NaturalResidual, IsInfiniteWhereAnythingIsNotFinite) {
  EXPECT_EQ(of_row(0, infinity, 0, nan), infinity);
  EXPECT_EQ(of_row(0, infinity, nan, 0), infinity);
  EXPECT_EQ(of_row(0, infinity, 0, infinity), infinity) << "an infinite F must not hide behind the bound";
  EXPECT_EQ(of_row(0, 1, infinity, infinity), infinity);
  const NaturalResidual residual = natural_residual(VectorXd::Zero(3), VectorXd::Constant(3, infinity),
                                                    VectorXd::Zero(3), Eigen::Vector3d(-9, 1, nan));
  EXPECT_EQ(residual.worst_row, 2);
}

TEST(NaturalResidual, OfAProblemEvaluatesIt) {
  const problems::TestProblem test = problems::path4();
  EXPECT_LT(natural_residual(*test.problem, test.solutions[0]).value, 1e-14);
  EXPECT_EQ(natural_residual(*test.problem, VectorXd::Zero(4)).value, 6);
  EXPECT_EQ(natural_residual(*test.problem, VectorXd::Zero(4)).worst_row, 3);
}

TEST(RecordList, KeepsTheWayInAndTheEnd) {
  RecordList<int, 4> list;
  EXPECT_TRUE(list.values().empty());
  for (int i = 0; i < 9; ++i) list.push(i);
  EXPECT_EQ(list.count(), 9);
  ASSERT_EQ(list.values().size(), 4U);
  EXPECT_EQ(list.values()[2], 2);
  EXPECT_EQ(list.values()[3], 8);
}

TEST(Report, DescribesTheWorstRowByName) {
  SolveReport report;
  report.status = SolveStatus::ray_termination;
  report.residual = 0.25;
  report.worst_row = 2;
  report.stages.push({SolverKind::semismooth_newton, StageStart::perturbed, SolveStatus::stalled, 7, 0.5});
  const std::string text = describe(report, *problems::munson1().problem);
  EXPECT_NE(text.find("ray_termination"), std::string::npos) << text;
  EXPECT_NE(text.find("row 2"), std::string::npos) << text;
  EXPECT_NE(text.find("semismooth_newton from the perturbed start: stalled"), std::string::npos) << text;
}

TEST(Report, EveryStatusHasItsOwnName) {
  std::vector<std::string_view> names;
  for (int s = 0; s <= static_cast<int>(SolveStatus::non_finite); ++s) {
    names.push_back(to_string(static_cast<SolveStatus>(s)));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(std::count(names.begin(), names.end(), "unknown"), 0);
}

}  // namespace
}  // namespace touchstone
