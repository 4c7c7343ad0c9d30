// Steps at random are what they say: the same for a seed, of every kind, without overlap, and the same again
// from the file that they are written to.
#include "tests/support/random_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "experiments/scene_file/scene_file.h"

namespace touchstone::random_steps {
namespace {

struct Plane {
  static constexpr int dim = 2;
};
struct Space {
  static constexpr int dim = 3;
};
using Dimensions = testing::Types<Plane, Space>;

template <typename D>
class RandomStepsIn : public testing::Test {
 public:
  static constexpr int dim = D::dim;
};
TYPED_TEST_SUITE(RandomStepsIn, Dimensions);

TYPED_TEST(RandomStepsIn, AreTheSameForASeed) {
  constexpr int Dim = TestFixture::dim;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const RandomStep<Dim> once = random_step<Dim>(seed);
    static_cast<void>(random_step<Dim>(seed + 7));
    const RandomStep<Dim> again = random_step<Dim>(seed);
    EXPECT_EQ(write_scene(once.scene), write_scene(again.scene));
    EXPECT_EQ(once.h, again.h);
    EXPECT_NE(write_scene(once.scene), write_scene(random_step<Dim>(seed + 1).scene));
  }
}

// The reader also refuses bodies that overlap by more than 1e-9 of their size.
TYPED_TEST(RandomStepsIn, ReadBackAsTheyWereWritten) {
  constexpr int Dim = TestFixture::dim;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Scene<Dim> scene = random_step<Dim>(seed).scene;
    const auto read = std::get<Scene<Dim>>(scene_file::parse_scene(write_scene(scene), std::to_string(seed)));
    ASSERT_EQ(read.bodies.size(), scene.bodies.size());
    EXPECT_EQ(read.contact_law.mu, scene.contact_law.mu);
    EXPECT_EQ(read.gravity, scene.gravity);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body<Dim>& a = scene.bodies[i];
      const Body<Dim>& b = read.bodies[i];
      EXPECT_EQ(a.pose.position, b.pose.position);
      EXPECT_LT((a.pose.rotation.matrix() - b.pose.rotation.matrix()).norm(), 1e-14);
      EXPECT_EQ(a.velocity, b.velocity);
      EXPECT_EQ(a.fixed, b.fixed);
      EXPECT_EQ(shape_name(a.shape), shape_name(b.shape));
      if (a.fixed) continue;
      EXPECT_EQ(a.mass, b.mass);
      EXPECT_EQ(a.inertia, b.inertia);
    }
  }
}

TYPED_TEST(RandomStepsIn, AreOfEveryKind) {
  constexpr int Dim = TestFixture::dim;
  std::set<std::string> shapes;
  std::set<std::ptrdiff_t> moving;
  double largest_mass_ratio = 1;
  int frictionless = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Scene<Dim> scene = random_step<Dim>(seed).scene;
    std::istringstream names(shapes_of(scene));
    for (std::string name; std::getline(names, name, ',');) shapes.insert(name);
    double least = 1e9;
    double most = 0;
    for (const auto& body : scene.bodies) {
      if (body.fixed) continue;
      least = std::min(least, body.mass);
      most = std::max(most, body.mass);
    }
    largest_mass_ratio = std::max(largest_mass_ratio, most / least);
    moving.insert(std::count_if(scene.bodies.begin(), scene.bodies.end(), [](auto& b) { return !b.fixed; }));
    if (scene.contact_law.mu == 0) ++frictionless;
  }
  EXPECT_EQ(shapes.size(), std::variant_size_v<typename Geometry<Dim>::Variant>);
  EXPECT_EQ(*moving.begin(), 1);
  EXPECT_EQ(*moving.rbegin(), 8);
  EXPECT_GT(largest_mass_ratio, 1e3);
  EXPECT_GT(frictionless, 10);
  EXPECT_LT(frictionless, 150);
}

}  // namespace
}  // namespace touchstone::random_steps
