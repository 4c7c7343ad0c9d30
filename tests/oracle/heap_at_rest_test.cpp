// Spheres that fall into a box and come to rest: the steps at which more contacts stick than the motion
// needs, so that impulses are not unique. What holds of any impulses that solve them: the equations, as the
// independent certificate has them; the weight, that floor and walls carry; energy, which only contacts that
// part put in.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/stepper/implicit_stepper.h"
#include "core/stepper/interior_path.h"
#include "experiments/harness/judge.h"
#include "experiments/harness/ledger.h"
#include "experiments/scenarios/spheres_in_box.h"

namespace touchstone {
namespace {

constexpr double kStep = 0.01;        // [s]
constexpr double kCertified = 1e-10;  // at which answers are certified everywhere

SpheresInBox heap() {
  SpheresInBox box;
  box.spheres = 30;
  return box;
}

/// What normal impulses of contacts whose bodies part put in [J]: on the way from one end of a step to the
/// next the normal turns, and a gap that stays closed is one that opens along the last normal.
double work_of_parting(std::span<const BodyState<3>> state, std::span<const ContactImpulse<3>> contacts) {
  double sum = 0;
  for (const ContactImpulse<3>& c : contacts)
    sum += c.normal_impulse * std::max(0.0, relative_motion(c, state, state).normal);
  return sum;
}

/// Impulse of floor and walls on the heap [N s].
Vector<3> support(const Scene<3>& scene, std::span<const ContactImpulse<3>> contacts) {
  Vector<3> sum = Vector<3>::Zero();
  for (const ContactImpulse<3>& c : contacts) {
    const Vector<3> impulse = c.normal_impulse * c.normal + c.tangents * c.friction_impulse.head<2>();
    if (scene.bodies[static_cast<std::size_t>(c.body_b)].fixed) sum += impulse;
    if (scene.bodies[static_cast<std::size_t>(c.body_a)].fixed) sum -= impulse;
  }
  return sum;
}

TEST(HeapAtRest, EveryStepIsSolvedUntilTheSpheresRest) {
  const Scene<3> scene = spheres_in_box_scene(heap());
  const certificate::Checker<3> checker(scene);
  const Judge<3> judge(scene);
  ImplicitStepper<3> stepper(scene, {});
  std::vector<BodyState<3>> before(stepper.state().begin(), stepper.state().end());
  Energy energy = judge.energy(before);
  const double start = energy.total();
  double fall = 0;
  double sway = 0;
  for (int k = 1; k <= 100; ++k) {
    ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved) << "step " << k;
    const certificate::Step<3> step{before, stepper.state(), stepper.contacts(), {}, kStep};
    const certificate::Report report = checker.check(step, certificate::Contacts::all);
    EXPECT_TRUE(report.holds_but_for_rounding(kCertified))
        << "step " << k << ": " << checker.describe(report, step);
    const Energy last = std::exchange(energy, judge.energy(stepper.state()));
    EXPECT_LE(energy.total() - last.total(),
              work_of_parting(stepper.state(), stepper.contacts()) + 1e-12 * std::abs(start))
        << "step " << k;
    fall = std::max(fall, energy.kinetic);
    sway = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      sway += scene.bodies[i].fixed ? 0.0
                                    : scene.bodies[i].mass *
                                          (stepper.state()[i].velocity - before[i].velocity).head<3>().norm();
    before.assign(stepper.state().begin(), stepper.state().end());
  }
  EXPECT_LE(energy.kinetic, 1e-3 * fall);
  // What momentum does not take the box carries, and at rest that is all but nothing.
  const double weight = heap().spheres * heap().mass * heap().gravity * kStep;
  EXPECT_LE((support(scene, stepper.contacts()) - Vector<3>(0, 0, weight)).norm(), sway + 1e-10 * weight);
  EXPECT_LE(sway, 1e-2 * weight);
}

// The path that leads there has the same product of impulse and gap in every contact, and friction against
// the slip: of a heap that is not at rest yet, started from bodies that fall freely.
TEST(InteriorPath, KeepsTheProductOfEveryContact) {
  constexpr double kTau = 1e-5;
  const Scene<3> scene = spheres_in_box_scene(heap());
  ImplicitStepper<3> stepper(scene, {});
  for (int k = 0; k < 20; ++k) ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved);
  // All contacts of the last step, as its own problem had them.
  StepProblem<3> problem(scene);
  std::vector<BodyState<3>> state(stepper.state().begin(), stepper.state().end());
  problem.begin(state, kStep);
  problem.select(stepper.problem().bodies(), {}, stepper.problem().contacts());
  ASSERT_TRUE(InteriorPath<3>::applies_to(problem));
  Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
  problem.free_velocity(z);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) problem.find_points(i, z);
  InteriorPath<3> path;
  path.begin(problem, z, 1e-3);
  ASSERT_TRUE(path.follow(kTau));
  path.write(z);
  double least = 1;
  double most = 0;
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    problem.evaluate_state(i, z);
    const double gap = problem.separation(i) / (kStep * problem.scale().velocity);
    const double product = z[problem.layout().contact(i).normal] * gap;
    least = std::min(least, product);
    most = std::max(most, product);
    const ContactState<3>& contact = problem.state(i);
    const Vector<2> slip = contact.frame.tangents.transpose() * contact.slip_velocity;
    EXPECT_LE(contact.y.head<2>().dot(slip), 0) << "contact " << i;
    EXPECT_LT(contact.y.norm(), problem.contacts()[i].law.mu * contact.p) << "contact " << i;
  }
  // The last correction changed nothing by more than a twentieth.
  EXPECT_LE(most, 1.1 * least);
  EXPECT_LE(most, kTau);
  Eigen::VectorXd momentum(6 * problem.moving_bodies());
  Eigen::VectorXd rows(problem.size());
  problem.evaluate(z, rows, nullptr);
  EXPECT_LE(rows.head(momentum.size()).cwiseAbs().maxCoeff(), 1e-2 * kTau);
}

}  // namespace
}  // namespace touchstone
