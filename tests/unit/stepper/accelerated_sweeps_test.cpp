// AcceleratedSweeps against sweeps that are neither accelerated nor in single precision, and where what
// changes is much smaller than what it is added to.
#include "core/stepper/accelerated_sweeps.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/stepper/contact_relaxation.h"
#include "core/stepper/contact_sweeps.h"
#include "core/stepper/implicit_stepper.h"
#include "tests/support/pile.h"

namespace touchstone {
namespace {

using Kind = SweepAcceleration::Kind;

constexpr double kStep = 0.01;  // [s]

/// A ball that falls on two that lie on the ground beside each other, one of which is pushed on: contacts
/// that stick, slide and open.
template <int Dim>
Scene<Dim> three_balls() {
  Scene<Dim> scene = pile<Dim>(
      {ball(1.0, at<Dim>(0, 0, 1)), ball(3.0, at<Dim>(2, 0, 1)), ball(2.1, at<Dim>(1.1, 0.1, 2.72))});
  scene.bodies[0].velocity.template head<Dim>() = at<Dim>(0.8, 0.1, 0);
  scene.bodies[2].velocity.template head<Dim>() = at<Dim>(0.1, 0, -1);
  return scene;
}

/// Their problem, and a point from which to sweep.
template <int Dim>
struct Fixture {
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  Scene<Dim> scene = three_balls<Dim>();
  ImplicitStepper<Dim> stepper{scene, {}};
  StepProblem<Dim> problem{scene};
  Eigen::VectorXd z;

  Fixture() {
    std::vector<BodyState<Dim>> state;
    for (const Body<Dim>& body : scene.bodies) state.push_back({body.pose, body.velocity});
    EXPECT_EQ(stepper.step(kStep).status, StepStatus::solved);
    problem.begin(state, kStep);
    problem.select(stepper.problem().bodies(), {}, stepper.problem().contacts());
    EXPECT_GE(contacts().size(), 4U);
    z = Eigen::VectorXd::Zero(problem.size());
    problem.free_velocity(z);
    for (std::size_t i = 0; i < contacts().size(); ++i) {
      problem.find_points(i, z);
      z[problem.layout().contact(i).normal] = 0.1;  // so that momentum has to be restored as well
      z[problem.layout().contact(i).friction] = -0.02;
    }
  }

  [[nodiscard]] const std::vector<ContactPair<Dim>>& contacts() const { return problem.contacts(); }

  /// Brings z to a solution.
  void solve() {
    ContactRelaxation<Dim> relaxation;
    relaxation.run(problem, 1e-14, z);
    EXPECT_LE(relaxation.residual(), 1e-14);
  }

  /// Changes the impulses in z of contacts that bear a load.
  /// @return  the largest of the impulses
  double disturb(double size) {
    double largest = 0;
    for (std::size_t i = 0; i < contacts().size(); ++i) {
      const ContactLayout& at = problem.layout().contact(i);
      if (!(z[at.normal] > 1e-3)) continue;
      largest = std::max(largest, z[at.normal]);
      z[at.normal] += size;
      z[at.friction] -= size / 2;
    }
    return largest;
  }

  [[nodiscard]] double friction(std::size_t i, const Eigen::VectorXd& at) const {
    return at.template segment<Dimension<Dim>::friction>(problem.layout().contact(i).friction).norm();
  }

  /// Gives contact i a coefficient of friction of its own.
  void set_mu(std::size_t i, double mu) {
    std::vector<ContactPair<Dim>> changed = contacts();
    changed[i].law.mu = mu;
    problem.select(stepper.problem().bodies(), {}, changed);
  }

  /// Sweeps from z on the geometry there.
  Eigen::VectorXd sweep(double size, double tolerance, Kind kind) {
    AcceleratedSweeps<Dim> sweeps;
    sweeps.bind(problem);
    std::vector<Twist<Dim>> rows;
    for (int b = 0; b < problem.moving_bodies(); ++b) rows.push_back(problem.momentum_row(b, z));
    StepBlock<Dim> block;
    for (std::size_t i = 0; i < contacts().size(); ++i) {
      problem.evaluate_state(i, z);
      sweeps.freeze(problem, i, problem.state(i), z);
      problem.contact_block(i, false, block);
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
        if (block.place[k] >= 0)
          rows[static_cast<std::size_t>(block.place[k])] +=
              block.f.template segment<kVelocity>(block.column[k]);
      }
    }
    std::vector<std::size_t> all(contacts().size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<std::size_t> bodies(rows.size());
    std::iota(bodies.begin(), bodies.end(), std::size_t{0});
    sweeps.start(all, size);
    for (const std::size_t b : bodies) sweeps.restore_momentum(problem, b, rows[b]);
    EXPECT_LT(sweeps.run(all, 10000, tolerance, kind), 10000);
    Eigen::VectorXd result = z;
    sweeps.write(problem, all, bodies, result);
    return result;
  }
};

template <typename D>
class AcceleratedSweepsTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AcceleratedSweepsTest, Dimensions);

TYPED_TEST(AcceleratedSweepsTest, EndWhereSweepsInDoublePrecisionEnd) {
  Fixture<TypeParam::value> fixture;
  Eigen::VectorXd expected = fixture.z;
  ContactSweeps<TypeParam::value>().run(fixture.problem, 20000, expected);
  ASSERT_GT((expected - fixture.z).cwiseAbs().maxCoeff(), 0.1);
  for (const Kind kind : {Kind::anderson, Kind::conjugate_gradients}) {
    const Eigen::VectorXd found = fixture.sweep(1, 1e-6, kind);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-4);
  }
}

/// Friction and slip that are next to nothing have a direction, along which those of a contact that begins to
/// slide would be told; in single precision that is lost, as the least normal number is 1e-38.
TYPED_TEST(AcceleratedSweepsTest, BeginWhereFrictionIsNextToNothing) {
  for (const double friction : {0.0, 1e-320, 1e-42, 1e-39, 1e-20, 1e-9}) {
    Fixture<TypeParam::value> fixture;
    for (std::size_t i = 0; i < fixture.contacts().size(); ++i)
      fixture.z[fixture.problem.layout().contact(i).friction] = friction;
    Eigen::VectorXd expected = fixture.z;
    ContactSweeps<TypeParam::value>().run(fixture.problem, 20000, expected);
    const Eigen::VectorXd found = fixture.sweep(1, 1e-6, Kind::anderson);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-4) << "friction " << friction;
  }
}

/// Two digits of a change, as rounds need them. Impulses of 0.1 m V in single precision would be off by fifty
/// times the change.
TYPED_TEST(AcceleratedSweepsTest, ResolveChangesFarBelowSinglePrecisionOfImpulses) {
  constexpr double kChange = 1e-10;
  Fixture<TypeParam::value> fixture;
  fixture.solve();
  const Eigen::VectorXd solution = fixture.z;
  ASSERT_GT(fixture.disturb(kChange), 0.1);
  const Eigen::VectorXd found = fixture.sweep(kChange, 1e-5 * kChange, Kind::anderson);
  EXPECT_LT((found - solution).cwiseAbs().maxCoeff(), 0.01 * kChange);
}

/// A contact that sticks is given so much friction that it sticks with 1e-10 m V to spare, or slides for want
/// of as much. Which of the two it is decides where sweeps end; a difference of squares of impulses in single
/// precision takes both for the same.
TYPED_TEST(AcceleratedSweepsTest, TellSlidingFromStickingFarBelowSinglePrecisionOfImpulses) {
  constexpr int kDim = TypeParam::value;
  constexpr double kChange = 1e-10;
  Fixture<kDim> solved;
  solved.solve();
  int tried = 0;
  for (std::size_t i = 0; i < solved.contacts().size(); ++i) {
    const double p = solved.z[solved.problem.layout().contact(i).normal];
    const double sticking = solved.friction(i, solved.z);
    if (!(sticking > 0.01 * p && sticking < 0.9 * solved.contacts()[i].law.mu * p)) continue;
    ++tried;
    for (const double margin : {kChange, -kChange}) {
      Fixture<kDim> fixture;
      fixture.z = solved.z;
      fixture.set_mu(i, (sticking + margin) / p);
      fixture.disturb(kChange);
      Eigen::VectorXd expected = fixture.z;
      ContactSweeps<kDim>().run(fixture.problem, 20000, expected);
      const double left =
          fixture.contacts()[i].law.mu * expected[fixture.problem.layout().contact(i).normal] -
          fixture.friction(i, expected);
      EXPECT_NEAR(left, std::max(margin, 0.0), 0.01 * kChange) << "contact " << i;
      const Eigen::VectorXd found = fixture.sweep(kChange, 1e-5 * kChange, Kind::anderson);
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 0.01 * kChange)
          << "contact " << i << (margin > 0 ? " sticks" : " slides");
    }
  }
  EXPECT_GT(tried, 0);
}

}  // namespace
}  // namespace touchstone
