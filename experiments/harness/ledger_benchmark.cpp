// What the energy ledger costs by the number of contacts: balls in a row, each in touch with the next one and
// with the ground, booked standing still, so that every contact is one of the step before. "BigO" is the
// constant of n log n that fits best, "RMS" how badly it fits.
#include <benchmark/benchmark.h>

#include "experiments/harness/ledger.h"

namespace {

using namespace touchstone;

Scene<3> row(int balls) {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < balls; ++i) {
    Body<3>& body = scene.bodies.emplace_back();
    body.pose.position = {2.0 * i, 0, 1};
    body.shape.geometry = Sphere<3>{1.0};
  }
  Body<3>& ground = scene.bodies.emplace_back();
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<3>{};
  return scene;
}

ContactImpulse<3> contact(int a, int b, const Vector<3>& point, const Vector<3>& normal) {
  ContactImpulse<3> contact;
  contact.body_a = a;
  contact.body_b = b;
  contact.point_a = contact.point_b = point;
  contact.normal = normal;
  contact.tangents << normal.z(), 0, 0, 1, normal.x(), 0;
  contact.normal_impulse = 1;
  return contact;
}

void book_step(benchmark::State& run) {
  const int balls = static_cast<int>(run.range(0));
  const Scene<3> scene = row(balls);
  const Judge<3> judge(scene);
  const auto state = initial_state(scene);
  std::vector<ContactImpulse<3>> contacts;
  for (int i = 0; i < balls; ++i) {
    contacts.push_back(contact(i, balls, {2.0 * i, 0, 0}, Vector<3>::UnitZ()));
    if (i + 1 < balls) contacts.push_back(contact(i, i + 1, {2.0 * i + 1, 0, 1}, -Vector<3>::UnitX()));
  }
  EnergyLedger<3> ledger(scene, judge, state);
  ledger.book(0.01, state, state, contacts, {});
  for (auto _ : run) {
    ledger.book(0.01, state, state, contacts, {});
    benchmark::DoNotOptimize(ledger.account().drift);
  }
  run.counters["contacts"] = static_cast<double>(contacts.size());
  run.SetComplexityN(static_cast<int>(contacts.size()));
}
BENCHMARK(book_step)->RangeMultiplier(4)->Range(16, 4096)->Complexity(benchmark::oNLogN);

}  // namespace

BENCHMARK_MAIN();
