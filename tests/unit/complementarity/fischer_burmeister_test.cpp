#include "core/complementarity/fischer_burmeister.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/complementarity/residual.h"

namespace touchstone {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Bounds {
  double lower, upper;
};

const std::vector<Bounds> all_bounds = {
    {-infinity, infinity}, {0, infinity}, {-infinity, 1}, {-0.5, 1}, {0.25, 0.25}};

double phi_of(const Bounds& bounds, double weight, double z, double f) {
  const VectorXd lower = VectorXd::Constant(1, bounds.lower);
  const VectorXd upper = VectorXd::Constant(1, bounds.upper);
  FischerBurmeister reformulation;
  reformulation.bind(lower, upper, weight);
  VectorXd phi(1);
  reformulation.evaluate(VectorXd::Constant(1, z), VectorXd::Constant(1, f), phi);
  return phi[0];
}

TEST(FischerBurmeister, VanishesExactlyWhereTheNaturalResidualDoes) {
  for (const Bounds& bounds : all_bounds) {
    for (const double weight : {1.0, 0.7}) {
      for (int i = -8; i <= 8; ++i) {
        for (int j = -8; j <= 8; ++j) {
          const double z = 0.25 * i;
          const double f = 0.25 * j;
          const double natural =
              natural_residual(VectorXd::Constant(1, bounds.lower), VectorXd::Constant(1, bounds.upper),
                               VectorXd::Constant(1, z), VectorXd::Constant(1, f))
                  .value;
          const double phi = std::abs(phi_of(bounds, weight, z, f));
          EXPECT_EQ(phi < 1e-14, natural < 1e-14)
              << bounds.lower << " " << bounds.upper << " " << z << " " << f;
          // Both measure the same: equivalent up to a factor (Tseng 1996 for the plain function).
          if (weight == 1.0) {
            EXPECT_LE(natural, 2.0 / (2.0 - std::sqrt(2.0)) * phi + 1e-14) << z << " " << f;
            EXPECT_LE(phi, 12.0 * natural + 1e-14) << z << " " << f;
          }
        }
      }
    }
  }
}

TEST(FischerBurmeister, DoesNotCancelForSmallArguments) {
  // phi = ab / (a + b) (1 + O(b/a)) for b << a: the plain formula would give 0 or a multiple of 1e-16.
  EXPECT_NEAR(phi_of({0, infinity}, 1.0, 1.0, 1e-20), 1e-20, 1e-30);
}

TEST(FischerBurmeister, JacobianIsTheDerivativeAwayFromKinks) {
  const double step = 1e-6;
  for (const Bounds& bounds : all_bounds) {
    for (const double weight : {1.0, 0.7}) {
      for (const double z : {-1.13, -0.31, 0.17, 0.61, 1.71}) {
        for (const double f : {-1.21, -0.41, 0.37, 1.19}) {
          const double slope = 1.7;  // of F in z
          const VectorXd lower = VectorXd::Constant(1, bounds.lower);
          const VectorXd upper = VectorXd::Constant(1, bounds.upper);
          FischerBurmeister reformulation;
          reformulation.bind(lower, upper, weight);
          double h = 0.0;
          reformulation.jacobian(VectorXd::Constant(1, z), VectorXd::Constant(1, f),
                                 MatrixXd::Constant(1, 1, slope), Eigen::Map<MatrixXd>(&h, 1, 1));
          const double difference = (phi_of(bounds, weight, z + step, f + slope * step) -
                                     phi_of(bounds, weight, z - step, f - slope * step)) /
                                    (2 * step);
          EXPECT_NEAR(h, difference, 1e-6) << bounds.lower << " " << bounds.upper << " " << z << " " << f;
        }
      }
    }
  }
}

TEST(FischerBurmeister, AtTheKinkTheElementIsALimitOfGradients) {
  const VectorXd lower = VectorXd::Zero(1);
  const VectorXd upper = VectorXd::Constant(1, infinity);
  FischerBurmeister reformulation;
  reformulation.bind(lower, upper, 1.0);
  double h = 0.0;
  reformulation.jacobian(VectorXd::Zero(1), VectorXd::Zero(1), MatrixXd::Constant(1, 1, 1.0),
                         Eigen::Map<MatrixXd>(&h, 1, 1));
  EXPECT_NEAR(h, 2.0 - std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace touchstone
