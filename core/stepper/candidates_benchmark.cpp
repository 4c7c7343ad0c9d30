// What finding the pairs within reach costs by the number of bodies: equal balls at random, of one density
// whatever their number, above a half-space. "BigO" is the constant of n log n that fits best, "RMS" how
// badly it fits; the exponent is the slope of log time over log n through all sizes, printed by the last
// line.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "core/stepper/contact_candidates.h"

namespace {

using namespace touchstone;

Scene<3> crowd(int bodies) {
  constexpr double kRoom = 2.5;  // edge of the cube that each ball has, over its radius
  std::mt19937 random(1);
  const double edge = kRoom * std::cbrt(bodies);
  std::uniform_real_distribution<double> place(0, edge);
  std::normal_distribution<double> speed;
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < bodies; ++i) {
    Body<3>& body = scene.bodies.emplace_back();
    body.pose.position = {place(random), place(random), place(random)};
    body.velocity << speed(random), speed(random), speed(random), Vector<3>::Zero();
    body.shape.geometry = Sphere<3>{1.0};
  }
  Body<3>& ground = scene.bodies.emplace_back();
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<3>{};
  return scene;
}

void select_pairs(benchmark::State& run) {
  const Scene<3> scene = crowd(static_cast<int>(run.range(0)));
  ContactCandidates<3> candidates(scene);
  const auto state = initial_state(scene);
  for (auto _ : run) {
    candidates.select(state, 0.01);
    benchmark::DoNotOptimize(candidates.selected().data());
  }
  run.counters["pairs"] = static_cast<double>(candidates.selected().size());
  run.SetComplexityN(run.range(0));
}
BENCHMARK(select_pairs)
    ->Arg(10)
    ->Arg(30)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Arg(3000)
    ->Complexity(benchmark::oNLogN);

/// Prints as usual and keeps the times for the exponent.
class WithExponent : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration)
        times_[std::log(static_cast<double>(run.complexity_n))] = std::log(run.GetAdjustedCPUTime());
    }
    ConsoleReporter::ReportRuns(runs);
  }
  /// Slope of the least-squares line.
  [[nodiscard]] double exponent() const {
    double x = 0, y = 0, xx = 0, xy = 0;
    const auto n = static_cast<double>(times_.size());
    for (const auto& [size, time] : times_) {
      x += size / n;
      y += time / n;
      xx += size * size / n;
      xy += size * time / n;
    }
    return (xy - x * y) / (xx - x * x);
  }

 private:
  std::map<double, double> times_;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  WithExponent reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  std::printf("time grows as n^%.2f\n", reporter.exponent());
}
