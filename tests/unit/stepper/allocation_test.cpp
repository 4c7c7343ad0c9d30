// A step allocates nothing once the first one has been made: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/stepper/implicit_stepper.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace touchstone {
namespace {

Scene<2> sliding_disc() {
  Scene<2> scene;
  scene.gravity = {0, -9.81};
  scene.contact_law.mu = 0.4;
  Body<2> disc;
  disc.name = "disc";
  disc.inertia << 0.5;
  disc.pose.position = {0, 1};
  disc.velocity << -3, 0, 0;  // slides first, then rolls: the solver has work to do
  Body<2> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape = {HalfSpace<2>{}};
  scene.bodies = {disc, ground};
  return scene;
}

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  const auto memory = std::make_unique<double>(1.0);
  EXPECT_EQ(allocations, before + 1) << *memory;
}

TEST(Allocation, APlanarStepMakesNone) {
  for (const auto solver : {ImplicitOptions::Solver::path, ImplicitOptions::Solver::semismooth}) {
    ImplicitStepper<2> stepper(sliding_disc(), {.solver = solver});
    ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
    const long before = allocations;
    int iterations = 0;
    for (int k = 0; k < 100; ++k) iterations += stepper.step(0.01).iterations;
    EXPECT_EQ(allocations, before);
    EXPECT_GT(iterations, 20);
  }
}

}  // namespace
}  // namespace touchstone
