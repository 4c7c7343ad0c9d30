// The natural residual of a step, as those who solve it find it contact by contact, is what the judge of all
// solves finds in the rows of the whole problem.
#include <gtest/gtest.h>

#include <limits>

#include "core/complementarity/residual.h"
#include "core/stepper/condensed_system.h"
#include "core/stepper/contact_relaxation.h"
#include "core/stepper/implicit_stepper.h"
#include "tests/support/pile.h"

namespace touchstone {
namespace {

/// A box on the ground, so that there are multipliers, a ball on it and an ellipsoid on that.
template <int Dim>
Scene<Dim> tower() {
  Body<Dim> box = ball(3.0, at<Dim>(0, 0, 0.5));
  box.shape.geometry = Box<Dim>{at<Dim>(2, 2, 0.5)};
  Body<Dim> top = ball(1.5, at<Dim>(0, 0, 3.8));
  top.shape.geometry = Ellipsoid<Dim>{at<Dim>(1.1, 1.1, 0.8)};
  return pile<Dim>({box, ball(2.0, at<Dim>(0.2, 0.1, 2)), top});
}

template <int Dim>
void expect_one_residual() {
  ImplicitStepper<Dim> stepper(tower<Dim>(), {});
  ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
  StepProblem<Dim> problem = stepper.problem();
  const Eigen::Index size = problem.size();
  ASSERT_GT(size, problem.layout().contact(0).multipliers_1);
  CondensedSystem<Dim> condensed;
  condensed.bind(problem);
  condensed.set_form({});
  ContactRelaxation<Dim> relaxation;
  Eigen::VectorXd f(size);
  // Each unknown in turn is off, so that each row in turn is the worst one.
  for (Eigen::Index k = 0; k < size; ++k) {
    for (const double off : {0.1, -0.1}) {
      Eigen::VectorXd z = stepper.solution().head(size);
      z[k] += off;
      EXPECT_EQ(relaxation.run(problem, std::numeric_limits<double>::infinity(), z), 0);
      condensed.evaluate(z);  // both take sigma = |w|
      problem.evaluate(z, f, nullptr);
      const double judged = natural_residual(problem.lower(), problem.upper(), z, f).value;
      const double rounding = 4 * std::numeric_limits<double>::epsilon() * z.cwiseAbs().maxCoeff();
      EXPECT_NEAR(relaxation.residual(), judged, rounding) << problem.row_name(k);
      EXPECT_NEAR(condensed.residual(), judged, rounding) << problem.row_name(k);
    }
  }
}

TEST(StepResidual, IsTheSameContactByContactAsOfTheWholeProblem) {
  expect_one_residual<2>();
  expect_one_residual<3>();
}

}  // namespace
}  // namespace touchstone
