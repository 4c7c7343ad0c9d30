#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/model/errors.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/trace.h"

/// The same input gives the same bytes, whatever ran before or runs beside it.
namespace touchstone::conformance {

namespace {

template <int Dim>
void same_twice(const Subject<Dim>& subject) {
  EXPECT_EQ(trace(subject.entry), trace(subject.entry));
}

/// Another scene before and two runs in step with each other: no state leaks through globals.
template <int Dim>
void no_leak(const Subject<Dim>& subject) {
  const std::string alone_in_process = trace(subject.entry);
  const auto other = subject.entry.make(on_ground(ball<Dim>("other", 1.5 * up<Dim>(), 0.7), 0.6), {});
  advance(*other, kStep, 30);
  const auto first = subject.entry.make(busy_scene<Dim>(), {});
  const auto second = subject.entry.make(busy_scene<Dim>(), {});
  std::string first_text;
  std::string second_text;
  for (int k = 0; k < kTraceSteps; ++k) {
    advance(*first, kStep, 1);
    advance(*other, kStep, 1);
    advance(*second, kStep, 1);
    append(first_text, *first);
    append(second_text, *second);
  }
  EXPECT_EQ(first_text, alone_in_process);
  EXPECT_EQ(second_text, alone_in_process);
}

/// A fresh process prints the trace; so would any engine chatter be seen here, because it would be in the
/// way.
template <int Dim>
void fresh_process(const Subject<Dim>& subject) {
  const std::string here = trace(subject.entry);
  const std::string there = trace_of_fresh_process<Dim>(subject.entry.key);
  EXPECT_EQ(here, there);
}

/// A box that slides on the ground and stops, with more contact forces than its motion determines.
template <int Dim>
Scene<Dim> sliding_box() {
  Body<Dim> box = ball<Dim>("box", 0.5 * up<Dim>());
  box.shape = {Box<Dim>{Vector<Dim>::Constant(0.5)}};
  box.inertia = Inertia<Dim>::Identity() / 6;
  box.velocity[0] = 0.2;
  return on_ground(box, 0.3);
}

/// Neither while it loads nor while it steps does anything come out, whoever in the library prints it.
template <int Dim>
void silent(const Subject<Dim>& subject) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (const auto& scene : {busy_scene<Dim>(), sliding_box<Dim>()}) {
    try {
      const auto method = subject.entry.make(scene, {});
      for (int k = 0; k < kTraceSteps; ++k) {
        if (method->step(kStep).status != StepStatus::solved) break;
      }
    } catch (const Unsupported&) {
    }
  }
  std::fflush(stdout);
  constexpr std::size_t kShown = 200;
  EXPECT_EQ(testing::internal::GetCapturedStdout().substr(0, kShown), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr().substr(0, kShown), "");
}

/// The bodies given in the reverse order. Engines may solve in another order, so this is not to the last bit;
/// a body that got another's mass or law would be off by its own motion.
template <int Dim>
void two_orders(const Subject<Dim>& subject) {
  Scene<Dim> scene = busy_scene<Dim>();
  scene.bodies[2].pose.position = 1.6 * up<Dim>() - 5 * Vector<Dim>::Unit(0);  // apart: no chaos
  scene.bodies[2].mass = 0.3;
  Scene<Dim> reversed = scene;
  std::reverse(reversed.bodies.begin(), reversed.bodies.end());
  const auto forward = subject.entry.make(scene, {});
  const auto backward = subject.entry.make(reversed, {});
  advance(*forward, kStep, kTraceSteps);
  advance(*backward, kStep, kTraceSteps);
  const std::size_t last = scene.bodies.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const auto& a = forward->state()[i];
    const auto& b = backward->state()[last - i];
    EXPECT_LE((a.velocity - b.velocity).norm(), subject.traits.contact_speed) << scene.bodies[i].name;
    EXPECT_LE((a.pose.position - b.pose.position).norm(), subject.traits.contact_speed)
        << scene.bodies[i].name;
  }
}

}  // namespace

template <int Dim>
std::vector<Feature<Dim>> repeat_features() {
  return {
      {"same_twice", "two runs in one process give the same bytes", &same_twice<Dim>},
      {"no_leak", "other scenes before and beside a run leave no trace in it", &no_leak<Dim>},
      {"fresh_process", "another process gives the same bytes, and nothing else on stdout",
       &fresh_process<Dim>},
      {"silent", "nothing is printed", &silent<Dim>},
      {"two_orders", "the order of the bodies does not matter", &two_orders<Dim>},
  };
}
template std::vector<Feature<2>> repeat_features();
template std::vector<Feature<3>> repeat_features();

}  // namespace touchstone::conformance
