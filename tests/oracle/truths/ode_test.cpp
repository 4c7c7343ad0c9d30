// Is the integrator as accurate as the truths that rest on it claim (1e-12), and does it find events?
// Oracles: closed forms, time reversal, and a problem whose derivative is singular at the start.
#include "experiments/scenarios/truths/ode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace touchstone::truth {
namespace {

using Pair = OdeVector<2>;

Pair oscillator(double, const Pair& y) { return {y[1], -y[0]}; }

TEST(GaussRule, IntegratesPolynomialsUpToTwiceItsOrder) {
  const auto& rule = GaussRule<10>::instance();
  for (int degree = 0; degree < 20; ++degree) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 10; ++i) sum += rule.weight[i] * std::pow(rule.node[i], degree);
    EXPECT_NEAR(sum, 1.0 / (degree + 1), 2e-16) << degree;
  }
  double beyond =
      0.0;  // negative control: at degree 20 the rule is wrong by (10!)^4 / (21 (20!)^2) = 1.4e-12
  for (std::size_t i = 0; i < 10; ++i) beyond += rule.weight[i] * std::pow(rule.node[i], 20);
  EXPECT_NEAR(1.0 / 21.0 - beyond, 1.39e-12, 0.02e-12);
}

TEST(GaussRule, CollocationMatrixIntegratesTheNodalPolynomial) {
  const auto& rule = GaussRule<10>::instance();
  for (std::size_t i = 0; i < 10; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 10; ++j) sum += rule.integral[i][j] * std::pow(rule.node[j], 9);
    EXPECT_NEAR(sum, std::pow(rule.node[i], 10) / 10.0, 1e-16);
  }
}

TEST(Quadrature, AgreesWithTheCompleteEllipticIntegral) {
  const double k = 0.9;
  const auto integrand = [&](double x) { return 1.0 / std::sqrt(1.0 - k * k * std::sin(x) * std::sin(x)); };
  EXPECT_NEAR(quadrature(integrand, 0.0, std::numbers::pi / 2, 4), std::comp_ellint_1(k), 4e-15);
}

TEST(Ode, OscillatorKeepsTwelveDigitsOverAHundredPeriods) {
  const double end = 200.0 * std::numbers::pi;
  const Pair y = integrate<2>(oscillator, 0.0, {1.0, 0.0}, end);
  EXPECT_NEAR(y[0], 1.0, 1e-12);
  EXPECT_NEAR(y[1], 0.0, 1e-12);
}

TEST(Ode, EccentricKeplerOrbitReturnsToItsStart) {
  using State = OdeVector<4>;
  const auto kepler = [](double, const State& y) -> State {
    const double r3 = std::pow(y[0] * y[0] + y[1] * y[1], 1.5);
    return {y[2], y[3], -y[0] / r3, -y[1] / r3};
  };
  const double e = 0.9;
  const State start(1.0 - e, 0.0, 0.0, std::sqrt((1.0 + e) / (1.0 - e)));
  const State y = integrate<4>(kepler, 0.0, start, 2.0 * std::numbers::pi);
  // A time error dt shows as a displacement v dt, and at the start v = 4.4.
  EXPECT_LT((y - start).head<2>().norm(), 1e-12);
}

struct DenseError {
  double worst = 0.0;  ///< of the dense output against cos t on [0, 30]
  int steps = 0;
};

DenseError dense_error(const OdeOptions& options) {
  DenseError result;
  const auto none = [](double, const Pair&) { return std::array<double, 0>{}; };
  const auto observer = [&](const DenseStep<2>& step, double end) {
    for (int i = 0; i <= 20; ++i) {
      const double t = step.begin() + (end - step.begin()) * i / 20.0;
      result.worst = std::max(result.worst, std::abs(step(t)[0] - std::cos(t)));
    }
  };
  result.steps = integrate<2, 0>(oscillator, 0.0, {1.0, 0.0}, 30.0, none, {}, observer, options).steps;
  return result;
}

TEST(Ode, DenseOutputHoldsBetweenTheSteps) { EXPECT_LT(dense_error({}).worst, 1e-13); }

TEST(Ode, ToleranceBuysAccuracyWithSteps) {
  // The iteration for the nodes needs short steps anyway, so that a loose tolerance is undercut by far.
  const DenseError loose = dense_error({.tolerance = 1e-6});
  const DenseError tight = dense_error({.tolerance = 1e-15});
  EXPECT_LT(loose.worst, 1e-6);
  EXPECT_LT(tight.worst, loose.worst);
  EXPECT_GT(tight.steps, loose.steps);
}

TEST(Ode, FirstEventIsTheEarliestAndExact) {
  const auto events = [](double t, const Pair& y) { return std::array{y[0], 1.0 - t / 3.0, y[1] + 2.0}; };
  const auto ignore = [](const DenseStep<2>&, double) {};
  const auto r = integrate<2, 3>(oscillator, 0.0, {1.0, 0.0}, 10.0, events, {true, true, true}, ignore);
  ASSERT_EQ(r.status, OdeStatus::event);
  EXPECT_EQ(r.event, 0u);
  EXPECT_NEAR(r.t, std::numbers::pi / 2, 1e-15);
}

TEST(Ode, UnarmedEventWaitsUntilItWasPositive) {
  const auto events = [](double, const Pair& y) {
    return std::array{y[1]};
  };  // -sin t from 0: negative first
  const auto ignore = [](const DenseStep<2>&, double) {};
  const auto late = integrate<2, 1>(oscillator, 0.0, {1.0, 0.0}, 10.0, events, {false}, ignore);
  EXPECT_NEAR(late.t, 2.0 * std::numbers::pi, 1e-14);
  const auto at_once = integrate<2, 1>(oscillator, 0.0, {1.0, 0.0}, 10.0, events, {true}, ignore);
  EXPECT_NEAR(at_once.t, 0.0, 1e-15);
}

TEST(Ode, ShortExcursionBetweenTwoNodesIsSeen) {
  // Touches zero from above for 2e-4 around t = 1, in one
  // step from 0 to 3 (linear problem, so no step is refused).
  const auto drift = [](double, const OdeVector<1>&) { return OdeVector<1>(1.0); };
  const auto events = [](double, const OdeVector<1>& y) {
    return std::array{(y[0] - 1.0) * (y[0] - 1.0) - 1e-8};
  };
  const auto ignore = [](const DenseStep<1>&, double) {};
  const auto r =
      integrate<1, 1>(drift, 0.0, OdeVector<1>(0.0), 3.0, events, {true}, ignore, {.first_step = 3.0});
  ASSERT_EQ(r.status, OdeStatus::event);
  EXPECT_NEAR(r.t, 1.0 - 1e-4, 1e-12);
}

TEST(Ode, SlipThatGrowsFromZeroIsIntegratedThroughItsSingularStart) {
  // w' = (7, t) - 5 w/|w|, w(0) = 0: starts as 2 t (1, 0), where
  // df/dw is 5 / (2 t). Oracle: other steps, other tolerance.
  const auto field = [](double t, const Pair& w) -> Pair {
    const double size = w.norm();
    return Pair(7.0, t) - 5.0 * (size > 0.0 ? Pair(w / size) : Pair(1.0, 0.0));
  };
  const Pair tight = integrate<2>(field, 0.0, Pair::Zero(), 2.0, {.tolerance = 1e-15, .first_step = 1e-3});
  const Pair loose = integrate<2>(field, 0.0, Pair::Zero(), 2.0, {.tolerance = 1e-13, .first_step = 1e-2});
  EXPECT_LT((tight - loose).norm(), 1e-12);
  EXPECT_GT(tight[1], 0.1);  // the direction did turn
}

TEST(Ode, RefusesOptionsOutOfRange) {
  const auto run = [](const OdeOptions& options) {
    (void)integrate<2>(oscillator, 0.0, {1.0, 0.0}, 1.0, options);
  };
  EXPECT_THROW(run({.tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW(run({.floor = 0.0}), std::invalid_argument);
  EXPECT_THROW(run({.first_step = -1.0}), std::invalid_argument);
  EXPECT_THROW(run({.max_step = 0.0}), std::invalid_argument);
  EXPECT_THROW(run({.max_steps = 0}), std::invalid_argument);
  EXPECT_THROW(run({.first_step = 1e-3, .max_steps = 1}), std::runtime_error);
}

TEST(Ode, MaxStepIsKept) {
  double longest = 0.0;
  const auto none = [](double, const Pair&) { return std::array<double, 0>{}; };
  const auto observer = [&](const DenseStep<2>& step, double end) {
    longest = std::max(longest, end - step.begin());
  };
  (void)integrate<2, 0>(oscillator, 0.0, {1.0, 0.0}, 3.0, none, {}, observer, {.max_step = 0.01});
  EXPECT_LE(longest, 0.01 + 1e-15);
}

}  // namespace
}  // namespace touchstone::truth
