// The broad phase against all pairs one by one.
#include "core/stepper/contact_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/model/errors.h"
#include "core/stepper/box_tree.h"

namespace touchstone {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Bodies at random: balls and boxes from tiny to huge, at rest to very fast, some fixed, some jointed, none
/// to three half-spaces.
template <int Dim>
class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : random_(seed) {
    const int bodies = integer(1, 60);
    const double size = std::pow(10, real(-3, 3));     // of the region
    const double spread = real(0, 1) < 0.5 ? 0.3 : 3;  // decades of the bodies' sizes
    scene_.gravity = real(0, 20) * direction();
    for (int i = 0; i < bodies; ++i) add_body(size, spread);
    for (int i = integer(0, 3); i > 0; --i) add_plane(size);
    std::shuffle(scene_.bodies.begin(), scene_.bodies.end(), random_);
    for (int i = integer(0, 5); i > 0; --i) add_joint();
  }

  [[nodiscard]] const Scene<Dim>& scene() const { return scene_; }
  [[nodiscard]] double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Vector<Dim> direction() {
    Vector<Dim> v;
    for (int k = 0; k < Dim; ++k) v[k] = std::normal_distribution<double>()(random_);
    return v.normalized();
  }
  Body<Dim>& add_body(double region, double spread) {
    Body<Dim>& body = scene_.bodies.emplace_back();
    body.fixed = real(0, 1) < 0.2;
    const double size = 0.2 * region * std::pow(10, real(-spread, 0));
    if (real(0, 1) < 0.5) {
      body.shape.geometry = Sphere<Dim>{size};
    } else {
      body.shape.geometry = Box<Dim>{Vector<Dim>(size * Vector<Dim>::Ones())};
    }
    body.shape.placement.position = real(0, 0.5) * size * direction();
    for (int k = 0; k < Dim; ++k) body.pose.position[k] = region * real(-1, 1);
    const double speed = real(0, 1) < 0.1 ? 1000 * region : region;
    body.velocity.template head<Dim>() = real(0, speed) * direction();
    return body;
  }
  void add_plane(double region) {
    Body<Dim>& plane = scene_.bodies.emplace_back();
    plane.fixed = true;
    plane.shape.geometry = HalfSpace<Dim>{direction(), region * real(-1, 0)};
  }
  void add_joint() {
    const int last = static_cast<int>(scene_.bodies.size()) - 1;
    const int a = integer(0, last);
    const int b = integer(0, last);
    if (a != b) scene_.joints.push_back({.body_a = a, .body_b = b});
  }

  std::mt19937 random_;
  Scene<Dim> scene_;
};

/// Every pair whose balls, from the surfaces' own bounds, come within reach: the rule as the header tells it.
template <int Dim>
Pairs all_pairs(const Scene<Dim>& scene, const std::vector<BodyState<Dim>>& state, double h) {
  const int count = static_cast<int>(scene.bodies.size());
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces;
  for (const auto& body : scene.bodies) surfaces.push_back(make_surface(body.shape));
  Pairs pairs;
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      if ((scene.bodies[a].fixed && scene.bodies[b].fixed) || scene.jointed(i, j)) continue;
      double reach = h * h * scene.gravity.norm();
      double size = 0;
      for (const auto k : {a, b}) {
        if (scene.bodies[k].fixed) continue;
        reach += h * state[k].velocity.template head<Dim>().norm();
        size = std::max(size, surfaces[k]->bounding_ball().radius);
      }
      reach += 0.02 * size;
      const auto center = [&](std::size_t k) {
        return state[k].pose.to_world(surfaces[k]->bounding_ball().center);
      };
      double gap = 0;
      if (surfaces[a]->plane() != nullptr || surfaces[b]->plane() != nullptr) {
        const auto plane = surfaces[a]->plane() != nullptr ? a : b;
        const auto other = plane == a ? b : a;
        gap = surfaces[plane]->value(0, state[plane].pose.to_body(center(other))) -
              surfaces[other]->bounding_ball().radius;
      } else {
        gap = (center(a) - center(b)).norm() - surfaces[a]->bounding_ball().radius -
              surfaces[b]->bounding_ball().radius;
      }
      if (gap <= reach * (1 + 1e-12)) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

template <int Dim>
Pairs selected_pairs(const ContactCandidates<Dim>& candidates) {
  Pairs pairs;
  for (const int i : candidates.selected()) {
    const auto& pair = candidates.pairs()[static_cast<std::size_t>(i)];
    EXPECT_TRUE(pair.selected);
    pairs.push_back(std::minmax({pair.contact.body_1, pair.contact.body_2}));
  }
  return pairs;
}

template <int Dim>
void expect_the_same(unsigned seeds) {
  std::size_t found = 0;
  std::size_t possible = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    RandomScene<Dim> random(seed);
    const Scene<Dim>& scene = random.scene();
    ContactCandidates<Dim> candidates(scene);
    std::vector<BodyState<Dim>> state = initial_state(scene);
    for (const double h : {1e-3, 0.1}) {
      candidates.select(state, h);
      const Pairs expected = all_pairs(scene, state, h);
      ASSERT_EQ(selected_pairs(candidates), expected) << "seed " << seed << ", h = " << h;
      found += expected.size();
      possible += scene.bodies.size() * (scene.bodies.size() - 1) / 2;
      std::size_t flags = 0;
      for (const auto& pair : candidates.pairs()) flags += pair.selected ? 1 : 0;
      ASSERT_EQ(flags, expected.size()) << "pairs of the step before are selected still";
      for (std::size_t i = 0; i < state.size(); ++i) {
        if (!scene.bodies[i].fixed) state[i].pose = advanced(state[i].pose, state[i].velocity, h);
      }
    }
  }
  EXPECT_GT(found, 10U * seeds) << "scenes in which nothing is near test nothing";
  EXPECT_LT(found, possible / 2);
}

TEST(ContactCandidates, AreThoseOfAllPairsInThePlane) { expect_the_same<2>(1000); }
TEST(ContactCandidates, AreThoseOfAllPairsInSpace) { expect_the_same<3>(1000); }

TEST(ContactCandidates, AddsWhatOverlapsAndWasNotSelected) {
  Scene<3> scene;
  for (int i = 0; i < 10; ++i) {
    Body<3>& body = scene.bodies.emplace_back();
    body.pose.position = {10.0 * i, 0, 0};
    body.shape.geometry = Sphere<3>{1.0};
  }
  ContactCandidates<3> candidates(scene);
  std::vector<BodyState<3>> state = initial_state(scene);
  candidates.select(state, 0.01);
  EXPECT_TRUE(candidates.selected().empty());
  state[7].pose.position = {21.5, 0, 0};  // into body 2
  state[1].pose.position = {0, 1.9, 0};   // into body 0
  EXPECT_TRUE(candidates.add_overlapping(state));
  EXPECT_EQ(selected_pairs(candidates), (Pairs{{0, 1}, {2, 7}}));
  EXPECT_FALSE(candidates.add_overlapping(state)) << "nothing new";
}

TEST(ContactCandidates, ABodyThatIsNowhereIsNearNothing) {
  Scene<2> scene;
  scene.bodies.resize(6);
  for (auto& body : scene.bodies) body.shape.geometry = Sphere<2>{1.0};
  ContactCandidates<2> candidates(scene);
  std::vector<BodyState<2>> state = initial_state(scene);
  state[3].pose.position[0] = std::nan("");
  candidates.select(state, 0.01);
  EXPECT_EQ(candidates.selected().size(), 10U) << "the other five are all in one place";
}

TEST(ContactCandidates, RefusesTwoHalfSpacesOfWhichOneMoves) {
  Scene<2> scene;
  scene.bodies.resize(2);
  for (auto& body : scene.bodies) body.shape.geometry = HalfSpace<2>{};
  EXPECT_THROW(ContactCandidates<2>{scene}, Unsupported);
  scene.bodies[0].fixed = scene.bodies[1].fixed = true;
  EXPECT_NO_THROW(ContactCandidates<2>{scene});
}

}  // namespace
}  // namespace touchstone
