// Question: what does a polygon with a linearised gap cost a disc that rolls on a plane, and why?
// Success criterion: the implicit NCP keeps the disc's energy to 1e-12 over 10 s at every step size. The loss
// of the Stewart-Trinkle LCP is accounted for: it falls with the edges N to a floor that the step sets, KE0
// exp(-(4/3) g h t / R), and with the step h to a limit that the edges set, KE0 / (1 + 2 pi omega0 t / (3
// N))^2. Source: Example 1 and Fig. 1 of Chakraborty, Berard, Akella and Trinkle, "An implicit time-stepping
// method for multibody systems with intermittent contact" (2007): (a) over N at h = 0.01 s, (b) over h at N =
// 1000. Expected: the two curves cross at omega h = 2 pi / N, which at N = 1000 is h = 0.002 s: the "limit"
// of Fig. 1(b). With the nearest vertex as the only candidate the loss is not even monotone in N. Every
// engine is run beside them on the disc and on N-gons. A rigid polygon loses energy at its corners whoever
// simulates it, so a method is judged by what it loses beyond the exact, event-driven polygon; as h falls
// that is expected to vanish for rigid contacts in double precision.

#include <algorithm>
#include <memory>
#include <optional>

#include "experiments/disc_rolling_rows.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/scenarios/disc_rolling.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

using namespace touchstone::disc_rolling;

constexpr const char* kScenario = "disc_rolling";
constexpr double kStepOfEdgesSweep = 0.01;  // [s]
constexpr int kEdgesOfStepSweep = 1000;
constexpr double kStepOfCheck = 0.0002;  // [s]; far below 2 pi / (N omega), where only the edges limit

/// The points of the sweep `engines`: fine steps over as long as kMostEngineSteps take.
std::vector<Point> engine_points(const Selection& selection) {
  std::vector<Point> points;
  for (const int edges : selection.integers("engine-edges")) {
    for (const double h : selection.numbers("engine-step-sizes")) {
      const double until = std::min(selection.until, static_cast<double>(kMostEngineSteps) * h);
      points.push_back({"engines", edges, h, until});
    }
  }
  return points;
}

std::vector<Point> points(const Selection& selection) {
  std::vector<Point> points;
  for (const std::string& sweep : selection.texts("sweeps")) {
    if (sweep == "edges") {
      for (const int edges : selection.integers("edges")) {
        points.push_back({sweep, edges, kStepOfEdgesSweep, selection.until});
      }
    } else if (sweep == "step_size") {
      for (const double h : selection.numbers("step-sizes")) {
        points.push_back({sweep, kEdgesOfStepSweep, h, selection.until});
      }
    } else if (sweep == "engines") {
      for (const Point& point : engine_points(selection)) points.push_back(point);
    } else {
      points.push_back({sweep, kEdgesOfStepSweep, kStepOfCheck, std::min(kUntilOfCheck, selection.until)});
    }
  }
  for (const Point& point : points)
    static_cast<void>(step_count(point.until, point.h));  // refuses before any work
  return points;
}

/// Every time that a case of these points may ask a truth for.
std::vector<double> truth_times(const std::vector<Point>& points) {
  std::vector<double> times = kReportTimes;
  for (const Point& point : points) {
    const std::vector<double> samples = sample_times(point);
    times.insert(times.end(), samples.begin(), samples.end());
  }
  return times;
}

// --- cases

/// Lists the cases of a selection.
class CaseList {
 public:
  explicit CaseList(const Selection& selection)
      : selection_(selection),
        points_(points(selection)),
        scene_(std::make_shared<Scene<2>>(disc_rolling_scene())) {
    const std::vector<double> times = truth_times(points_);
    for (const Point& point : points_) {
      if (point.edges > 0) truths_->try_emplace(point.edges, kDisc, point.edges, times);
    }
  }

  std::vector<Case> take() {
    for (const MethodSpec& method : selection_.methods) add_method(method);
    return std::move(cases_);
  }

 private:
  void add_method(const MethodSpec& method) {
    if (is_truth(method.key)) return add_truth(method);
    const Options options = options_in_force(*scene_, method);
    const bool is_engine = !find_method<2>(method.key).version().empty();
    if (!is_engine && options.contains("candidates")) {
      add_polygon_method(method);
    } else if (!is_engine) {
      add_disc_method(method);
    }
    add_to_engines_sweep(method, options);
  }

  /// `h_s` of a truth is that of the cases that it stands beside, whether it depends on it or not.
  void add_truth(const MethodSpec& method) {
    if (!method.options.empty())
      throw InputError("--methods", fmt::format("'{}'", format_method(method)), "no options: it is a truth");
    for (const Point& point : points_) {
      if (point.edges == 0) continue;
      Case one;
      one.id = {kScenario, method.key, "", {point.sweep, number_cell(long{point.edges}), ""},
                point.h,   point.until};
      one.cost = 1.0;
      one.run = [curve = *truth_curve(method.key, point, *truths_), point, keep = truths_] {
        return truth_result(curve, point);
      };
      cases_.push_back(std::move(one));
    }
  }

  /// A method that makes a polygon of the disc: at every point, with every policy.
  void add_polygon_method(const MethodSpec& method) {
    for (const Point& point : points_) {
      if (point.sweep == "engines") continue;
      for (const std::string& policy : selection_.texts("candidates")) {
        if (point.sweep == "check" && policy != selection_.texts("candidates").front()) continue;
        MethodSpec spec = method;
        spec.options.insert({{"edges", std::to_string(point.edges)}, {"candidates", policy}});
        const double cost_of_step = policy == "all" ? 1.0 + point.edges / 200.0 : 1.0;  // as measured
        add_case(spec, point, {point.sweep, spec.options["edges"], spec.options["candidates"]}, cost_of_step,
                 true);
      }
    }
  }

  /// A method that rolls the disc itself: once for each step of a sweep, for it has no edges.
  void add_disc_method(const MethodSpec& method) {
    std::vector<std::pair<std::string, double>> seen;
    for (const Point& point : points_) {
      const std::pair<std::string, double> place = {point.sweep, point.h};
      const bool elsewhere = point.sweep == "check" || point.sweep == "engines";
      if (elsewhere || std::find(seen.begin(), seen.end(), place) != seen.end()) continue;
      seen.push_back(place);
      for (const MethodSpec& variant : variants(method, point.sweep)) {
        add_case(variant, point, {point.sweep, "", ""}, 1.0, false);
      }
    }
  }

  /// Every method as it comes, on the disc and on each polygon that it can make of it.
  void add_to_engines_sweep(const MethodSpec& method, const Options& options) {
    for (const Point& point : points_) {
      if (point.sweep != "engines" || (point.edges > 0 && !options.contains("edges"))) continue;
      MethodSpec spec = method;
      if (point.edges > 0) spec.options.insert({"edges", std::to_string(point.edges)});
      const std::string edges = point.edges > 0 ? std::to_string(point.edges) : "";
      const double cost_of_step = method.key.starts_with("simbody") ? 20.0 : 1.0;  // as measured
      add_case(spec, point, {point.sweep, edges, ""}, cost_of_step, point.edges > 0);
    }
  }

  /// Both solvers and both gap functions of the implicit NCP beside the sweep over edges, if no options were
  /// given.
  static std::vector<MethodSpec> variants(const MethodSpec& method, const std::string& sweep) {
    if (method.key != "implicit_ncp" || sweep != "edges" || !method.options.empty()) return {method};
    std::vector<MethodSpec> variants;
    for (const char* solver : {"path", "semismooth"}) {
      for (const char* gap : {"workspace", "distance"}) {
        variants.push_back({method.key, {{"solver", solver}, {"gap", gap}}});
      }
    }
    return variants;
  }

  void add_case(const MethodSpec& method, const Point& point, Row sweep, double cost_of_step,
                bool is_polygon) {
    MethodCase<2> spec;
    spec.scenario = kScenario;
    spec.scene = scene_;
    spec.method = method;
    spec.sweep = std::move(sweep);
    spec.run = {.h = point.h, .until = point.until, .samples = samples_of(point), .report = kReportTimes};
    spec.cost_of_step = cost_of_step;
    spec.tabulate = [point, is_polygon, truths = truths_](const CaseRun<2>& run) {
      return method_rows(run, point, is_polygon ? &truths->at(point.edges) : nullptr);
    };
    cases_.push_back(make_case(std::move(spec)));
  }

  const Selection& selection_;
  std::vector<Point> points_;
  std::shared_ptr<const Scene<2>> scene_;
  std::shared_ptr<ExactPolygons> truths_ = std::make_shared<ExactPolygons>();
  std::vector<Case> cases_;
};

/// Ours, the truths, and every engine of this build.
std::vector<std::string> default_methods() {
  std::vector<std::string> keys = {"implicit_ncp", "stewart_trinkle", "exact_polygon", "edge_limited",
                                   "step_limited"};
  for (const MethodEntry<2>& entry : methods<2>()) {
    if (!entry.version().empty()) keys.emplace_back(entry.key);
    // Over-damped contacts beside its own, which are critically damped and rebound from each corner.
    if (entry.key == "mujoco_elliptic_stiff") keys.emplace_back("mujoco_elliptic_stiff:dampratio=5");
  }
  return keys;
}

CommandLineSpec command_line() {
  return {
      .name = "disc_rolling",
      .about =
          "What does a polygon with a linearised gap cost a disc that rolls on a plane, and why? (Fig. 1)",
      .examples =
          "  disc_rolling                                   what is committed, about a minute on two cores\n"
          "  disc_rolling --quick --out /tmp/quick          a first look\n"
          "  disc_rolling --sweeps edges --edges 10,100     one sweep with two of its values\n"
          "  disc_rolling --methods implicit_ncp:gap=distance,edge_limited --list\n",
      .methods = default_methods(),
      .axes = {{"edges",
                "edges N of the polygon, sweep (a) at h = 0.01 s",
                AxisKind::integer,
                {"10", "20", "30", "50", "100", "200", "500", "1000"},
                {"10", "100"},
                3},
               {"step-sizes",
                "step sizes h [s], sweep (b) at N = 1000",
                AxisKind::positive,
                {"0.05", "0.01", "0.005", "0.001", "0.0005", "0.0001"},
                {"0.05", "0.01"}},
               {"candidates",
                "which vertices a step sees: reachable, all, nearest:k, epsilon:e",
                AxisKind::text,
                {"reachable", "all", "nearest:1", "nearest:2", "epsilon:0.01"},
                {"reachable", "all", "nearest:1"}},
               {"sweeps",
                "which sweeps: edges, step_size, check, engines",
                AxisKind::text,
                {"edges", "step_size", "check", "engines"},
                {"edges", "step_size", "check", "engines"},
                1,
                {"edges", "step_size", "check", "engines"}},
               {"engine-edges",
                "edges N, sweep of all methods; 0: the disc itself",
                AxisKind::integer,
                {"0", "30", "100", "1000"},
                {"0", "100"},
                0},
               {"engine-step-sizes",
                "step sizes h [s], sweep of all methods; 10,000 steps at most",
                AxisKind::positive,
                {"0.01", "0.001", "0.0001", "0.00002"},
                {"0.01"}}},
      .until = 10.0,
      .quick_until = 1.0};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = command_line(),
      .sweep_columns = {"sweep", "edges", "candidates"},
      .tables = {{"summary", summary_columns()}, {"kinetic_energy", curve_columns()}},
      .seed = std::nullopt,
      .cases = [](const Selection& selection) { return CaseList(selection).take(); }};
  return run_experiment(experiment, argc, argv);
}
