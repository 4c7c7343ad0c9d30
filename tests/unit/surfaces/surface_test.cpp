#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/unit/surfaces/gallery.h"

/// What must hold for the inequalities of every shape: exact derivatives, convexity, a length as unit, and a
/// support mapping that agrees with them.
namespace touchstone::testing {

namespace {

template <int Dim>
class Points {
 public:
  explicit Points(const ConvexSurface<Dim>& surface) : surface_(surface), ball_(surface.bounding_ball()) {}

  double size() const { return ball_.radius; }
  /// Inside, outside and on the surface (and just off it) by turns; the last reaches edges and tips.
  Vector<Dim> next() {
    const int kind = count_++ % 4;
    const Vector<Dim> d = random_direction<Dim>(random_);
    if (kind == 0) return random_point(random_, ball_.center, 2 * ball_.radius);
    if (kind == 1) return random_point(random_, ball_.center, 0.5 * ball_.radius);
    const Vector<Dim> on = surface_.support(d);
    return kind == 2 ? on : Vector<Dim>(on + 1e-3 * ball_.radius * random_direction<Dim>(random_));
  }

 private:
  const ConvexSurface<Dim>& surface_;
  typename ConvexSurface<Dim>::BoundingBall ball_;
  Random random_{1};
  int count_ = 0;
};

/// The central difference of `f` along `e`, and how far it can be trusted: what halving the step changes.
template <typename Function, typename Point>
auto central_difference(const Function& f, const Point& x, const Point& e, double step) {
  using Value = decltype(f(x));
  const auto at = [&](double h) -> Value { return (f(x + h * e) - f(x - h * e)) / (2 * h); };
  struct Estimate {
    Value value;
    Value error;
  };
  return Estimate{at(step / 2), at(step) - at(step / 2)};
}

template <int Dim>
void expect_exact_derivatives(const Exhibit<Dim>& exhibit) {
  const auto surface = make_surface(exhibit.shape);
  Points<Dim> points(*surface);
  const double step = 1e-5 * points.size();
  for (int sample = 0; sample < 400; ++sample) {
    const Vector<Dim> x = points.next();
    for (int i = 0; i < surface->count(); ++i) {
      const SurfaceJet<Dim> jet = surface->jet(i, x);
      ASSERT_NEAR(jet.value, surface->value(i, x), 1e-15 * (1 + std::abs(jet.value)));
      ASSERT_TRUE(jet.hessian.isApprox(jet.hessian.transpose(), 1e-12) || jet.hessian.isZero(0));
      for (int k = 0; k < Dim; ++k) {
        const Vector<Dim> e = Vector<Dim>::Unit(k);
        const auto value = [&](const Vector<Dim>& y) {
          return Eigen::Matrix<double, 1, 1>(surface->value(i, y));
        };
        const auto slope = central_difference(value, x, e, step);
        ASSERT_NEAR(jet.gradient[k], slope.value[0], 2 * std::abs(slope.error[0]) + 1e-9)
            << "f_" << i << " along " << k << " at " << x.transpose();
        const auto gradient = [&](const Vector<Dim>& y) { return surface->jet(i, y).gradient; };
        const auto bend = central_difference(gradient, x, e, step);
        ASSERT_LE((jet.hessian.col(k) - bend.value).norm(), 2 * bend.error.norm() + 1e-8 / points.size())
            << "f_" << i << " along " << k << " at " << x.transpose();
      }
    }
  }
}

template <int Dim>
void expect_convex(const Exhibit<Dim>& exhibit) {
  const auto surface = make_surface(exhibit.shape);
  Points<Dim> points(*surface);
  for (int sample = 0; sample < 1000; ++sample) {
    const Vector<Dim> x = points.next();
    const Vector<Dim> y = points.next();
    for (int i = 0; i < surface->count(); ++i) {
      const double chord = 0.5 * (surface->value(i, x) + surface->value(i, y));
      ASSERT_LE(surface->value(i, 0.5 * (x + y)), chord + 1e-13 * points.size());
      const Matrix<Dim> hessian = surface->jet(i, x).hessian;
      const Vector<Dim> eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix<Dim>>(hessian).eigenvalues();
      ASSERT_GE(eigenvalues[0], -1e-12 * (hessian.norm() + 1 / points.size())) << "at " << x.transpose();
    }
  }
}

/// f is a length: its gradient on the surface is neither small nor large.
template <int Dim>
void expect_gradient_of_order_one(const Exhibit<Dim>& exhibit) {
  const auto surface = make_surface(exhibit.shape);
  Random random(2);
  for (int sample = 0; sample < 1000; ++sample) {
    const Vector<Dim> x = surface->support(random_direction<Dim>(random));
    for (int i = 0; i < surface->count(); ++i) {
      if (surface->value(i, x) < -1e-9) continue;
      const double length = surface->jet(i, x).gradient.norm();
      ASSERT_GE(length, 0.15) << "f_" << i << " at " << x.transpose();
      ASSERT_LE(length, 4.0) << "f_" << i << " at " << x.transpose();
    }
  }
}

template <int Dim>
double outside(const ConvexSurface<Dim>& surface, const Vector<Dim>& x) {
  double largest = surface.value(0, x);
  for (int i = 1; i < surface.count(); ++i) largest = std::max(largest, surface.value(i, x));
  return largest;
}

/// A point of the body from a random ray out of `inside`, by bisection on the inequalities alone.
template <int Dim>
Vector<Dim> boundary_point(const ConvexSurface<Dim>& surface, const Vector<Dim>& inside,
                           const Vector<Dim>& ray) {
  double low = 0;
  double high = 2 * surface.bounding_ball().radius;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (outside<Dim>(surface, inside + middle * ray) <= 0 ? low : high) = middle;
  }
  return inside + low * ray;
}

template <int Dim>
std::vector<Vector<Dim>> boundary_samples(const ConvexSurface<Dim>& surface, int count) {
  Random random(3);
  Vector<Dim> inside = Vector<Dim>::Zero();
  constexpr int kCorners = 20;
  for (int k = 0; k < kCorners; ++k) inside += surface.support(random_direction<Dim>(random)) / kCorners;
  std::vector<Vector<Dim>> samples;
  for (int k = 0; k < count; ++k) {
    samples.push_back(boundary_point(surface, inside, random_direction<Dim>(random)));
  }
  return samples;
}

template <int Dim>
void expect_support_beyond_samples(const Exhibit<Dim>& exhibit) {
  const auto surface = make_surface(exhibit.shape);
  const auto ball = surface->bounding_ball();
  const auto samples = boundary_samples(*surface, 4000);
  Random random(4);
  double widest = 0;
  for (int k = 0; k < 300; ++k) {
    Vector<Dim> d = random_direction<Dim>(random);
    if (k < Dim) d = Vector<Dim>::Unit(k);
    const Vector<Dim> x = surface->support(d);
    ASSERT_LE(outside(*surface, x), 1e-12);
    ASSERT_LE((x - ball.center).norm(), ball.radius + 1e-12);
    double reach = -1e300;
    for (const auto& y : samples) reach = std::max(reach, d.dot(y));
    ASSERT_GE(d.dot(x), reach - 1e-12) << "along " << d.transpose();
    ASSERT_LE(d.dot(x), reach + 0.15 * ball.radius) << "along " << d.transpose();
    ASSERT_NEAR(d.dot(x), d.dot(surface->support(1e-7 * d)), 1e-12 * ball.radius);
    widest = std::max(widest, (x - ball.center).norm());
  }
  EXPECT_GE(widest, 0.55 * ball.radius) << "bounding ball is not tight";
}

}  // namespace

class PlanarSurface : public ::testing::TestWithParam<Exhibit<2>> {};
class SpatialSurface : public ::testing::TestWithParam<Exhibit<3>> {};

TEST_P(PlanarSurface, DerivativesAreExact) { expect_exact_derivatives(GetParam()); }
TEST_P(SpatialSurface, DerivativesAreExact) { expect_exact_derivatives(GetParam()); }
TEST_P(PlanarSurface, EveryInequalityIsConvex) { expect_convex(GetParam()); }
TEST_P(SpatialSurface, EveryInequalityIsConvex) { expect_convex(GetParam()); }
TEST_P(PlanarSurface, GradientIsOfOrderOne) { expect_gradient_of_order_one(GetParam()); }
TEST_P(SpatialSurface, GradientIsOfOrderOne) { expect_gradient_of_order_one(GetParam()); }
TEST_P(PlanarSurface, SupportReachesBeyondSamples) { expect_support_beyond_samples(GetParam()); }
TEST_P(SpatialSurface, SupportReachesBeyondSamples) { expect_support_beyond_samples(GetParam()); }

constexpr auto kName = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Gallery, PlanarSurface, ::testing::ValuesIn(gallery<2>()), kName);
INSTANTIATE_TEST_SUITE_P(Gallery, SpatialSurface, ::testing::ValuesIn(gallery<3>()), kName);

}  // namespace touchstone::testing
