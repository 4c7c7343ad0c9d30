// Is the event-driven ball on two balls right to 1e-11? Oracles: the known event times,
// the constraints themselves, Newton's law by differences of the trajectory, the energy
// balance by quadrature, and an independent time-stepping of the same laws.
#include "experiments/scenarios/truths/sphere_on_spheres.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/scenarios/truths/ball_contact.h"
#include "experiments/scenarios/truths/gauss_legendre.h"

namespace touchstone::truth {
namespace {

using Eigen::Vector3d;

std::vector<double> grid(double from, double to, int intervals) {
  std::vector<double> times;
  for (int i = 0; i <= intervals; ++i) times.push_back(from + (to - from) * i / intervals);
  return times;
}

double energy(const SphereOnSpheres& scene, const SphereOnSpheresSample& s) {
  return 0.5 * scene.mass * s.velocity.squaredNorm() + 0.5 * scene.inertia * s.omega.squaredNorm();
}

TEST(SphereOnSpheres, HasTheKnownEvents) {
  const SphereOnSpheresResult result = roll_on_spheres({}, {4.0});
  ASSERT_EQ(result.status, SphereOnSpheresStatus::completed);
  EXPECT_EQ(result.start_modes[0], BallContactMode::sliding);
  EXPECT_EQ(result.start_modes[1], BallContactMode::sticking);
  ASSERT_EQ(result.events.size(), 3u);
  EXPECT_EQ(result.events[0].kind, BallEventKind::slip_begins);
  EXPECT_EQ(result.events[0].contact, 1);
  EXPECT_NEAR(result.events[0].t, 2.9448, 5e-5);
  EXPECT_EQ(result.events[1].kind, BallEventKind::separates);
  EXPECT_EQ(result.events[1].contact, 0);
  EXPECT_NEAR(result.events[1].t, 3.2132, 5e-5);
  EXPECT_EQ(result.events[2].kind, BallEventKind::separates);
  EXPECT_EQ(result.events[2].contact, 1);
  EXPECT_NEAR(result.events[2].t, 3.7016, 5e-5);
}

TEST(SphereOnSpheres, KeepsEveryContactLaw) {
  const SphereOnSpheres scene;
  const SphereOnSpheresResult result = roll_on_spheres(scene, grid(0.0, 4.0, 1601));
  ASSERT_EQ(result.samples.size(), 1602u);
  for (const SphereOnSpheresSample& s : result.samples) {
    for (std::size_t i = 0; i < 2; ++i) {
      const BallContactSample& c = s.contacts[i];
      // Recomputed from position and velocities, not taken from the sample.
      const Vector3d n = (s.position - scene.supports[i].center).normalized();
      const double gap =
          (s.position - scene.supports[i].center).norm() - scene.supports[i].radius - scene.radius;
      const Vector3d velocity = s.velocity - scene.radius * s.omega.cross(n);
      if (c.mode == BallContactMode::apart) {
        EXPECT_EQ(c.normal, 0.0);
        EXPECT_GE(gap, -1e-13);
        continue;
      }
      EXPECT_LE(std::abs(gap), 1e-12) << s.t;
      EXPECT_LE(std::abs(n.dot(velocity)), 1e-12) << s.t;
      EXPECT_GE(c.normal, 0.0);
      EXPECT_NEAR(n.dot(c.friction), 0.0, 1e-12);
      const double norm = std::sqrt(c.friction.squaredNorm() + std::pow(c.torsion / scene.e_r, 2));
      if (c.mode == BallContactMode::sticking) {
        EXPECT_LE(velocity.norm() + std::abs(s.omega.dot(n)), 1e-12) << s.t;
        EXPECT_LE(norm, scene.mu * c.normal);
      } else {
        EXPECT_NEAR(norm, scene.mu * c.normal, 1e-12);
        // Maximum dissipation: p_f = -mu p_n E w / |w|; compared as |w| p_f, which is regular at w = 0.
        const double spin = scene.e_r * s.omega.dot(n);
        const double sigma = std::sqrt(velocity.squaredNorm() + spin * spin);
        EXPECT_LE((sigma * c.friction + scene.mu * c.normal * velocity).norm(), 1e-12) << s.t;
        EXPECT_NEAR(sigma * c.torsion, -scene.mu * c.normal * scene.e_r * spin, 1e-12) << s.t;
      }
    }
  }
}

TEST(SphereOnSpheres, ForcesAreTheRateOfMomentum) {
  const SphereOnSpheres scene;
  const double h = 1e-3;
  for (const double t : {0.5, 1.5, 2.8, 3.1, 3.4, 3.9}) {
    const SphereOnSpheresResult result = roll_on_spheres(scene, {t - 2 * h, t - h, t, t + h, t + 2 * h});
    const auto& s = result.samples;
    const auto slope = [&](const auto& value) -> Vector3d {  // fourth order
      return (8.0 * (value(s[3]) - value(s[1])) - (value(s[4]) - value(s[0]))) / (12.0 * h);
    };
    Vector3d force = scene.force;
    Vector3d moment = Vector3d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      const BallContactSample& c = s[2].contacts[i];
      const Vector3d n = (s[2].position - scene.supports[i].center).normalized();
      force += c.normal * n + c.friction;
      moment += -scene.radius * n.cross(c.friction) + c.torsion * n;
    }
    EXPECT_LT((slope([&](const auto& x) -> Vector3d { return scene.mass * x.velocity; }) - force).norm(),
              1e-9)
        << t;
    EXPECT_LT((slope([&](const auto& x) -> Vector3d { return scene.inertia * x.omega; }) - moment).norm(),
              1e-9)
        << t;
    EXPECT_LT((slope([&](const auto& x) -> Vector3d { return x.position; }) - s[2].velocity).norm(), 1e-9)
        << t;
    // Orientation: R' R^T = [omega]_x.
    const Eigen::Matrix3d rate =
        (s[3].orientation.toRotationMatrix() - s[1].orientation.toRotationMatrix()) / (2 * h);
    const Eigen::Matrix3d spin = rate * s[2].orientation.toRotationMatrix().transpose();
    EXPECT_LT((Vector3d(spin(2, 1), spin(0, 2), spin(1, 0)) - s[2].omega).norm(), 1e-4) << t;
  }
}

TEST(SphereOnSpheres, EnergyBalancesByQuadratureOfTheDissipation) {
  const SphereOnSpheres scene;
  std::vector<double> ends{0.0};
  for (const BallEvent& event : roll_on_spheres(scene, {4.0}).events) ends.push_back(event.t);
  for (std::size_t phase = 0; phase + 1 < ends.size(); ++phase) {
    const auto& rule = GaussRule<20>::instance();
    constexpr int panels = 8;
    const double width = (ends[phase + 1] - ends[phase]) / panels;
    std::vector<double> times{ends[phase]};
    for (int p = 0; p < panels; ++p) {
      for (const double node : rule.node) times.push_back(ends[phase] + width * (p + node));
    }
    times.push_back(ends[phase + 1]);
    const SphereOnSpheresResult result = roll_on_spheres(scene, times);
    double work = 0.0;
    double dissipated = 0.0;
    for (std::size_t k = 1; k + 1 < times.size(); ++k) {
      const SphereOnSpheresSample& s = result.samples[k];
      const double weight = width * rule.weight[(k - 1) % rule.weight.size()];
      work += weight * scene.force.dot(s.velocity);
      for (const BallContactSample& c : s.contacts) {
        dissipated -= weight * (c.friction.dot(c.slip) + c.torsion * c.spin);
      }
    }
    EXPECT_GT(dissipated, 0.0);
    EXPECT_NEAR(energy(scene, result.samples.back()) - energy(scene, result.samples.front()),
                work - dissipated, 2e-11);
  }
}

TEST(SphereOnSpheres, DoesNotDependOnTheToleranceToTenDigits) {
  const std::vector<double> times = grid(0.0, 4.0, 40);
  const SphereOnSpheresResult loose = roll_on_spheres({}, times, 1e-13);
  const SphereOnSpheresResult tight = roll_on_spheres({}, times, 1e-14);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(loose.events[i].t, tight.events[i].t, 1e-12);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_LT((loose.samples[i].position - tight.samples[i].position).norm(), 1e-11);
    EXPECT_LT((loose.samples[i].velocity - tight.samples[i].velocity).norm(), 1e-11);
    EXPECT_LT((loose.samples[i].omega - tight.samples[i].omega).norm(), 1e-11);
  }
}

TEST(SphereOnSpheres, StartModesDoNotDependOnWhereTheirSearchBegins) {
  const SphereOnSpheres scene;
  const auto contacts = ball::contacts_of(scene, {scene.position, Vector3d::Zero(), Vector3d::Zero()});
  ball::ContactStates reference;
  ASSERT_TRUE(ball::start_states(scene, contacts, reference));
  for (int corner = 0; corner < 16; ++corner) {
    const auto part = [&](int bit) { return (corner >> bit) & 1 ? 1.5 : -1.5; };
    const std::array<ball::Surface, 2> start{ball::Surface(part(0), part(1), part(2), part(3)),
                                             ball::Surface(part(3), -part(1), part(0), part(2))};
    ball::ContactStates found;
    ASSERT_TRUE(ball::start_states(scene, contacts, found, start));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(found[i].mode, reference[i].mode);
      EXPECT_LT((found[i].direction - reference[i].direction).norm(), 1e-12);
    }
  }
}

/// The same laws at velocity level with step h: normals at
/// mid-step, impulses by projected Gauss-Seidel. First order.
struct CrudeBall {
  Vector3d x, v = Vector3d::Zero(), omega = Vector3d::Zero();
  std::array<double, 2> last_contact{0.0, 0.0};
  double first_slip = 0.0;

  void run(const SphereOnSpheres& scene, double h, double end) {
    x = scene.position;
    std::array<double, 2> p_n{};
    std::array<Eigen::Vector4d, 2> y{Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
    for (int k = 0; k * h < end; ++k) {
      const Vector3d middle = x + 0.5 * h * v;
      std::array<Vector3d, 2> n;
      v += h * scene.force / scene.mass;
      for (std::size_t i = 0; i < 2; ++i) {
        n[i] = (middle - scene.supports[i].center).normalized();
        if ((middle - scene.supports[i].center).norm() - scene.supports[i].radius - scene.radius > 1e-4) {
          p_n[i] = 0.0, y[i].setZero();
        }
        y[i].head<3>() -= n[i] * n[i].dot(y[i].head<3>());
        strike(scene, n[i], p_n[i], y[i]);
      }
      for (int sweep = 0; sweep < 400; ++sweep) {
        for (std::size_t i = 0; i < 2; ++i) sweep_contact(scene, middle, i, n[i], p_n[i], y[i]);
      }
      for (std::size_t i = 0; i < 2; ++i) {
        if (p_n[i] > 0.0) last_contact[i] = (k + 1) * h;
      }
      if (first_slip == 0.0 && (v - scene.radius * omega.cross(n[1])).norm() > 1e-5) first_slip = (k + 1) * h;
      x += h * v;
    }
  }

  void strike(const SphereOnSpheres& scene, const Vector3d& n, double p_n, const Eigen::Vector4d& y) {
    const Vector3d force = p_n * n + y.head<3>();
    v += force / scene.mass;
    omega += (-scene.radius * n.cross(force) + scene.e_r * y[3] * n) / scene.inertia;
  }

  void sweep_contact(const SphereOnSpheres& scene, const Vector3d& at, std::size_t i, const Vector3d& n,
                     double& p_n, Eigen::Vector4d& y) {
    const double gap = (at - scene.supports[i].center).norm() - scene.supports[i].radius - scene.radius;
    if (gap > 1e-4) return;
    const double next_n = std::max(0.0, p_n - scene.mass * n.dot(v));
    strike(scene, n, next_n - p_n, Eigen::Vector4d::Zero());
    p_n = next_n;
    const Vector3d slip = v - scene.radius * omega.cross(n);
    Eigen::Vector4d next = y;
    next.head<3>() -= (slip - n * n.dot(slip)) / 3.5;
    next[3] -= scene.e_r * omega.dot(n) / 3.5;
    if (next.norm() > scene.mu * p_n) next *= scene.mu * p_n / next.norm();
    strike(scene, n, 0.0, next - y);
    y = next;
  }
};

TEST(SphereOnSpheres, AgreesWithAnIndependentTimeStepping) {
  const SphereOnSpheres scene;
  const double end = 3.5;
  const SphereOnSpheresResult exact = roll_on_spheres(scene, {end});
  std::array<double, 2> error{};
  for (std::size_t level = 0; level < 2; ++level) {
    CrudeBall crude;
    crude.run(scene, level == 0 ? 2e-3 : 1e-3, end);
    error[level] = (crude.v - exact.samples.back().velocity).norm();
    EXPECT_NEAR(crude.first_slip, exact.events[0].t, 0.005);
    EXPECT_NEAR(crude.last_contact[0], exact.events[1].t, 0.005);
  }
  EXPECT_LT(error[1], 0.006);
  EXPECT_NEAR(error[0] / error[1], 2.0, 0.1);
}

TEST(SphereOnSpheres, SaysSoWhereTheModelEnds) {
  SphereOnSpheres pinned;  // pressed into the groove: both contacts stick, and their forces are undetermined
  pinned.force = {0.0, 0.0, -9.81};
  pinned.mu = 2.0;
  EXPECT_EQ(roll_on_spheres(pinned, {1.0}).status, SphereOnSpheresStatus::no_start);
  SphereOnSpheres lifted;
  lifted.force = {0.0, 0.0, 5.0};
  const SphereOnSpheresResult flight = roll_on_spheres(lifted, {1.0});
  EXPECT_EQ(flight.start_modes[0], BallContactMode::apart);
  EXPECT_EQ(flight.start_modes[1], BallContactMode::apart);
  EXPECT_NEAR(flight.samples.back().position.z(), lifted.position.z() + 2.5, 1e-13);
}

TEST(SphereOnSpheres, RefusesBadInput) {
  const auto with = [](auto change) {
    SphereOnSpheres scene;
    change(scene);
    return scene;
  };
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.mass = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.inertia = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.radius = 1.1; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.mu = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.e_slip = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.e_r = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres(with([](auto& s) { s.position.z() += 1e-6; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres({}, {1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(roll_on_spheres({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::truth
