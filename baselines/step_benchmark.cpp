// Time of one step of every method on the rolling disc of Example 1, h = 0.01, and each as a ratio to the LCP
// step with a polygon of ten edges: ratios of one run hold on a noisy machine where times do not.
//
// In steady rolling an implicit step starts at its own solution and only has to see that it is one. So it is
// also timed while the disc slides, when each step solves: `sliding`.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>

#include "baselines/registry.h"
#include "core/model/errors.h"

namespace touchstone {
namespace {

constexpr double kStep = 0.01;

Scene<2> disc_on_plane(double angular_velocity) {
  Scene<2> scene;
  scene.gravity = {0, -9.81};
  scene.contact_law.mu = 0.4;
  Body<2> disc;
  disc.name = "disc";
  disc.inertia << 0.5;
  disc.pose.position = {0, 1};
  disc.velocity << -3, 0, angular_velocity;
  Body<2> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape = {HalfSpace<2>{}};
  scene.bodies = {disc, ground};
  return scene;
}

/// Steps over a stretch of motion again and again, so that the state does not run away from what is to be
/// timed.
void time_steps(benchmark::State& state, const std::string& key, const Options& options,
                double angular_velocity, int stretch) {
  const Scene<2> scene = disc_on_plane(angular_velocity);
  std::unique_ptr<Method<2>> method;
  int left = 0;
  long iterations = 0;
  for (auto _ : state) {
    if (left == 0) {
      state.PauseTiming();
      method = find_method<2>(key).make(scene, options);
      (void)method->step(kStep);
      left = stretch;
      state.ResumeTiming();
    }
    const StepReport report = method->step(kStep);
    benchmark::DoNotOptimize(method->state().data());
    if (report.status != StepStatus::solved) {
      state.SkipWithError("a step was not solved");
      break;
    }
    iterations += report.iterations;
    --left;
  }
  state.counters["iterations"] =
      benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
}

constexpr int kRollingStretch = 1000;
constexpr int kSlidingStretch = 24;  // 0.25 s: the disc rolls from 0.2549 s on
const std::string kReference = "stewart_trinkle edges=10";

void register_benchmarks() {
  const auto add = [](const std::string& name, const std::string& key, const Options& options, double spin,
                      int stretch) {
    benchmark::RegisterBenchmark(
        name.c_str(), [=](benchmark::State& state) { time_steps(state, key, options, spin, stretch); });
  };
  for (const std::string solver : {"condensed", "path", "semismooth"}) {
    add("implicit_ncp rolling " + solver, "implicit_ncp", {{"solver", solver}}, 3, kRollingStretch);
    add("implicit_ncp sliding " + solver, "implicit_ncp", {{"solver", solver}}, 0, kSlidingStretch);
  }
  for (const std::string edges : {"10", "100", "1000"}) {
    for (const std::string candidates : {"reachable", "nearest:1"}) {
      const bool reference = edges == "10" && candidates == "reachable";
      const std::string name = fmt::format("stewart_trinkle edges={} {}", edges, candidates);
      add(reference ? kReference : name, "stewart_trinkle", {{"edges", edges}, {"candidates", candidates}}, 3,
          kRollingStretch);
    }
  }
  for (const auto& method : methods<2>()) {
    if (method.key == "implicit_ncp" || method.key == "stewart_trinkle") continue;
    add(std::string(method.key), std::string(method.key), {}, 3, kRollingStretch);
  }
}

/// Prints each time as the library does, and its ratio to the reference when all are there.
class RatioReporter final : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (!run.error_occurred && run.aggregate_name != "mean") {
        times_[run.run_name.function_name] = run.GetAdjustedCPUTime();
      }
    }
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    ConsoleReporter::Finalize();
    const auto reference = times_.find(kReference);
    if (reference == times_.end()) return;
    fmt::print("\nTime of a step over that of '{}':\n", kReference);
    for (const auto& [name, time] : times_) fmt::print("  {:40} {:8.3f}\n", name, time / reference->second);
  }

 private:
  std::map<std::string, double> times_;
};

}  // namespace
}  // namespace touchstone

int main(int argc, char** argv) {
  touchstone::register_benchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  touchstone::RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return 0;
}
