// Time of one step of every method on the rolling disc of Example 1 and on the sphere on two spheres of
// Example 3, h = 0.01, and each as a ratio to an LCP step of the scene (on the disc with a polygon of ten
// edges) and of the implicit NCP's step to it: ratios of one run hold on a noisy machine where times do not.
//
// In steady rolling an implicit step starts at its own solution and only has to see that it is one. So it is
// also timed while the disc slides, when each step solves: `sliding`.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <optional>

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

/// Example 3, as experiments/scenes/sphere_on_spheres.toml with spheres for ellipsoids.
Scene<3> sphere_on_spheres(double e_r) {
  Scene<3> scene;
  scene.contact_law.mu = 0.2;
  scene.contact_law.e_r = e_r;
  const auto add = [&](const std::string& name, bool fixed, const Vector<3>& position, double radius) {
    Body<3> ball;
    ball.name = name;
    ball.fixed = fixed;
    ball.pose.position = position;
    ball.shape = {Sphere<3>{radius}};
    scene.bodies.push_back(ball);
  };
  add("ball", false, {0, 6.62105263157895, 8.78417110772903}, 1);
  scene.bodies[0].inertia = 0.4 * Inertia<3>::Identity();
  scene.bodies[0].force = {1.0, 2.6, -9.81};
  add("support 1", true, {0, 0, 0}, 10);
  add("support 2", true, {0, 11.4, 0}, 9);
  return scene;
}

/// Steps over a stretch of motion again and again, so that the state does not run away from what is to be
/// timed.
template <int Dim>
void time_steps(benchmark::State& state, const std::string& key, const Options& options,
                const Scene<Dim>& scene, int stretch) {
  std::unique_ptr<Method<Dim>> method;
  int left = 0;
  long iterations = 0;
  for (auto _ : state) {
    if (left == 0) {
      state.PauseTiming();
      method = find_method<Dim>(key).make(scene, options);
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
constexpr int kSlidingStretch = 24;   // 0.25 s: the disc rolls from 0.2549 s on
constexpr int kSpheresStretch = 290;  // to 2.9 s: slides on one ball and rolls on the other, until 2.94 s
constexpr double kTorsion = 0.3;      // e_r [m]
const std::string kSpheres = "sphere_on_spheres ";
const std::string kReference = "stewart_trinkle edges=10";
const std::string kOurs = "implicit_ncp rolling condensed";
const std::string kSpheresReference = kSpheres + "stewart_trinkle";
const std::string kSpheresOurs = kSpheres + "implicit_ncp";

/// The scene as `entry` takes it: without torsion if the method has none. None if it refuses that too.
std::optional<Scene<3>> spheres_for(const MethodEntry<3>& entry) {
  for (const double e_r : {kTorsion, 0.0}) {
    try {
      static_cast<void>(entry.make(sphere_on_spheres(e_r), {}));
      return sphere_on_spheres(e_r);
    } catch (const Unsupported&) {
    }
  }
  return {};
}

/// All methods in space, each once with its torsion, or without it where it has none.
void register_spheres() {
  for (const auto& method : methods<3>()) {
    const auto scene = spheres_for(method);
    if (!scene) continue;
    const std::string key(method.key);
    const bool torsion = scene->contact_law.e_r > 0;
    benchmark::RegisterBenchmark(
        (kSpheres + key + (torsion ? "" : " e_r=0")).c_str(),
        [key, scene](benchmark::State& state) { time_steps<3>(state, key, {}, *scene, kSpheresStretch); });
  }
}

void register_benchmarks() {
  const auto add = [](const std::string& name, const std::string& key, const Options& options, double spin,
                      int stretch) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      time_steps<2>(state, key, options, disc_on_plane(spin), stretch);
    });
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
  register_spheres();
}

/// Prints each time as the library does, and its ratio to the reference when all are there.
class RatioReporter final : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (!run.error_occurred && (run.aggregate_name.empty() || run.aggregate_name == "median")) {
        times_[run.run_name.function_name] = run.GetAdjustedCPUTime();
      }
    }
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    ConsoleReporter::Finalize();
    print_ratios("", kReference, kOurs);
    print_ratios(kSpheres, kSpheresReference, kSpheresOurs);
  }

 private:
  /// Of the benchmarks whose names begin with `scene`; "": of the disc.
  void print_ratios(const std::string& scene, const std::string& reference, const std::string& ours) const {
    const auto lcp = times_.find(reference);
    const auto ncp = times_.find(ours);
    if (lcp == times_.end() || ncp == times_.end()) return;
    fmt::print("\nTime of a step over that of '{}', and of '{}' over it:\n", reference, ours);
    for (const auto& [name, time] : times_) {
      if (name.starts_with(kSpheres) == !scene.empty())
        fmt::print("  {:45} {:8.3f} {:8.3f}\n", name, time / lcp->second, ncp->second / time);
    }
  }

  std::map<std::string, double> times_;  ///< processor time [ns]; the median of repetitions
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
