// Example 2 of the paper: the implicit step gives the recursion that its own optimality demands, exactly.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/harness/contact_view.h"
#include "experiments/harness/method_case.h"
#include "experiments/scenarios/sphere_spin.h"

namespace touchstone {
namespace {

using harness::CaseRun;
using harness::KeptStep;

struct Errors {
  double spin = 0.0;         ///< against the discrete truth [rad/s]
  double torsion = 0.0;      ///< of the torsional impulse [N m s]
  double other = 0.0;        ///< largest of the five velocities that stay 0
  double residual = 0.0;     ///< of Eqs. 10-11
  double last_moment = 0.0;  ///< mean moment of the last step that brakes [N m]
};

Errors spin_down(const truth::SpinningSphere& sphere, const Options& options, double h, double until) {
  const Scene<3> scene = sphere_spin_scene(sphere);
  const CaseRun<3> run = harness::run_beside<3>(scene, {"implicit_ncp", options}, h, until);
  EXPECT_EQ(run.status, harness::CaseStatus::ok) << run.reason;
  Errors errors;
  errors.residual = run.residual.largest();
  for (std::size_t k = 1; k < run.kept.size(); ++k) {
    const KeptStep<3>& step = run.kept[k];
    const truth::SpinStep expected = truth::spin_after_steps(sphere, h, static_cast<int>(k));
    const Twist<3>& nu = step.state[0].velocity;
    errors.spin = std::max(errors.spin, std::abs(nu[5] - expected.omega));
    errors.other = std::max(errors.other, nu.head<5>().cwiseAbs().maxCoeff());
    const auto contact = harness::strongest_contact(scene, step.state, step.contacts, 0, 1);
    if (!contact) {
      ADD_FAILURE() << "no contact in step " << k;
      continue;
    }
    errors.torsion = std::max(errors.torsion, std::abs(contact->torsional_impulse - h * expected.moment));
    if (std::abs(contact->torsional_impulse) > 1e-9) errors.last_moment = contact->torsional_impulse / h;
  }
  return errors;
}

class SphereSpin : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  /// A step may end within the tolerance of its solution, and 280 steps of the smallest h add that up: what
  /// is to be found to 1e-12 needs more than the default of 1e-13.
  static Options options() {
    return {{"solver", std::get<0>(GetParam())}, {"gap", std::get<1>(GetParam())}, {"tolerance", "1e-14"}};
  }
};

TEST_P(SphereSpin, GivesTheDiscreteTruthAtEveryStepSize) {
  for (const double h : {0.1, 0.07, 0.02, 0.005}) {
    const Errors errors = spin_down({}, options(), h, 1.4);
    EXPECT_LE(errors.spin, 1e-12) << "h = " << h;
    EXPECT_LE(errors.torsion, 1e-12) << "h = " << h;
    EXPECT_LE(errors.other, 1e-12) << "h = " << h;
    EXPECT_LE(errors.residual, 1e-10) << "h = " << h;
  }
}

TEST_P(SphereSpin, TheLastStepHasTheMomentThatIsLeft) {
  // The sphere brakes from 0.98 s to 1 s of the step that ends at 1.05 s.
  EXPECT_NEAR(spin_down({}, options(), 0.07, 1.4).last_moment, -0.4 * 1.962 * (0.02 / 0.07), 1e-11);
}

TEST_P(SphereSpin, HoldsForOtherSpheresAndTheOtherSense) {
  const truth::SpinningSphere sphere{.mass = 2.5, .inertia = 0.3, .friction = 0.7, .e_r = 0.1, .omega = -5.0};
  const Errors errors = spin_down(sphere, options(), 0.013, 1.3);
  EXPECT_LE(errors.spin, 1e-12);
  EXPECT_LE(errors.torsion, 1e-12);
  EXPECT_GT(errors.last_moment, 0.0);
}

INSTANTIATE_TEST_SUITE_P(SolversAndGaps, SphereSpin,
                         testing::Combine(testing::Values("path", "semismooth"),
                                          testing::Values("workspace", "distance")));

TEST(SphereSpinDefaults, GiveTheDiscreteTruthOfThePapersStep) {
  const Errors errors = spin_down({}, {}, 0.07, 1.4);
  EXPECT_LE(errors.spin, 1e-12);
  EXPECT_LE(errors.torsion, 1e-12);
  EXPECT_LE(errors.other, 1e-12);
}

TEST(SphereSpinControl, WithoutTorsionItSpinsOn) {
  // The truth of a sphere with e_r = 0 is another one, so the comparison above can fail.
  const truth::SpinningSphere smooth{.e_r = 0.0};
  EXPECT_LE(spin_down(smooth, {}, 0.07, 1.4).spin, 1e-12);
  EXPECT_GT(truth::spin_at(smooth, 1.4) - truth::spin_at({}, 1.4), 1.9);
}

}  // namespace
}  // namespace touchstone
