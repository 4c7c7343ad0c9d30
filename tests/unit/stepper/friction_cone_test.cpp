// The algebra of the cone of friction, against what defines it.
#include "core/stepper/friction_cone.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace touchstone {
namespace {

using Cone = FrictionCone<4>;
using Element = Cone::Element;

constexpr double kRounding = 1e-12;

/// Inside the cone, from its middle to 1e-3 of its boundary.
std::vector<Element> inside() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Element> all;
  for (const double part : {0.0, 0.5, 0.999}) {
    for (const double size : {1e-3, 1.0, 1e3}) {
      const Eigen::Vector3d tail = Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized();
      all.push_back(size * (Element() << 1.0, part * tail).finished());
    }
  }
  return all;
}

TEST(FrictionCone, QuotientUndoesProduct) {
  for (const Element& x : inside()) {
    for (const Element& z : inside()) {
      const Element back = Cone::quotient(x, Cone::product(x, z));
      // The condition number of x -> x o z is at most 1 / (1 - 0.999).
      EXPECT_LE((back - z).norm(), 1e3 * kRounding * z.norm());
    }
  }
}

TEST(FrictionCone, LongestStepEndsAtTheBoundary) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Element& x : inside()) {
    const Element direction(unit(random), unit(random), unit(random), unit(random));
    const double step = Cone::longest_step(x, direction);
    if (std::isinf(step)) {
      EXPECT_GE(direction[0], direction.tail<3>().norm());
      continue;
    }
    const Element end = x + step * direction;
    EXPECT_NEAR(end[0], end.tail<3>().norm(), kRounding * end.norm());
    EXPECT_GT(Cone::determinant(Element(x + 0.5 * step * direction)), 0);
  }
}

TEST(ConeScaling, MapsOneElementToTheOther) {
  for (const Element& x : inside()) {
    for (const Element& z : inside()) {
      const ConeScaling<4> scaling(x, z);
      const Element forth = scaling.apply(z);
      const Element back = scaling.apply_inverse(x);
      EXPECT_LE((forth - back).norm(), 1e3 * kRounding * forth.norm());
      // Its square by blocks: W^2 z = x.
      const Eigen::Vector3d side = scaling.side();
      const Eigen::Matrix3d rest = scaling.schur_complement() + side * side.transpose() / scaling.head();
      Element squared;
      squared << scaling.head() * z[0] + side.dot(z.tail<3>()), side * z[0] + rest * z.tail<3>();
      EXPECT_LE((squared - x).norm(), 1e6 * kRounding * x.norm());
    }
  }
}

}  // namespace
}  // namespace touchstone
