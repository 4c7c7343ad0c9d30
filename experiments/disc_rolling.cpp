// Question: what does a polygon with a linearised gap cost a disc that rolls on a plane, and why?
// Success criterion: the implicit NCP keeps the disc's energy to 1e-12 over 10 s at every step size. The loss
// of the Stewart-Trinkle LCP is accounted for: it falls with the edges N to a floor that the step sets, KE0
// exp(-(4/3) g h t / R), and with the step h to a limit that the edges set, KE0 / (1 + 2 pi omega0 t / (3
// N))^2. Source: Example 1 and Fig. 1 of Chakraborty, Berard, Akella and Trinkle, "An implicit time-stepping
// method for multibody systems with intermittent contact" (2007): (a) over N at h = 0.01 s, (b) over h at N =
// 1000. Expected: the two curves cross at omega h = 2 pi / N, which at N = 1000 is h = 0.002 s: the "limit"
// of Fig. 1(b). With the nearest vertex as the only candidate the loss is not even monotone in N.

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/harness/record.h"
#include "experiments/scenarios/disc_rolling.h"
#include "experiments/scenarios/disc_rolling_truths.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr const char* kScenario = "disc_rolling";
constexpr double kStepOfEdgesSweep = 0.01;  // [s]
constexpr int kEdgesOfStepSweep = 1000;
constexpr double kStepOfCheck = 0.0002;  // [s]; far below 2 pi / (N omega), where only the edges limit
constexpr double kUntilOfCheck = 2.0;    // [s]
constexpr int kSamples = 200;
const std::vector<double> kReportTimes = {1, 2, 5, 10};  // [s]
const DiscRolling kDisc;

/// One place in a sweep: what is run and compared there.
struct Point {
  std::string sweep;
  int edges = 0;
  double h = 0.0;
  double until = 0.0;
};

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
    } else {
      points.push_back({sweep, kEdgesOfStepSweep, kStepOfCheck, std::min(kUntilOfCheck, selection.until)});
    }
  }
  for (const Point& point : points)
    static_cast<void>(step_count(point.until, point.h));  // refuses before any work
  return points;
}

/// A column of the report times: kinetic_5s_J.
std::string report_column(const std::string& quantity, double t) {
  return quantity + "_" + number_cell(t) + "s_J";
}

std::vector<std::string> summary_columns() {
  std::vector<std::string> columns;
  const auto add_reports = [&](const std::string& quantity) {
    for (const double t : kReportTimes) columns.push_back(report_column(quantity, t));
  };
  const auto add = [&](std::initializer_list<const char*> names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  add_reports("kinetic");
  add({"loss_J", "relative_energy_loss", "polygon_loss_J", "linearisation_loss_J", "rest_loss_J",
       "relative_energy_drift", "largest_penetration_m", "largest_residual", "dynamics_residual",
       "kinematics_residual", "contact_residual", "friction_residual", "steps", "iterations", "failed_steps",
       "end_x_m", "end_y_m", "end_angle_rad"});
  add_reports("exact_polygon");
  add({"polygon_reason", "polygon_departure", "polygon_departure_s"});
  add_reports("edge_limited");
  add_reports("step_limited");
  return columns;
}

const std::vector<std::string> kSummary = summary_columns();
const std::vector<std::string> kCurve = {"t_s", "kinetic_J", "total_J"};

// --- truths

std::vector<double> sample_times(double until) {
  std::vector<double> times;
  for (int k = 0; k <= kSamples; ++k) times.push_back(until * k / kSamples);
  return times;
}

/// Every time that a case with this horizon may ask a truth for.
std::vector<double> truth_times(double until) {
  std::vector<double> times = sample_times(until);
  const std::vector<double> check = sample_times(std::min(until, kUntilOfCheck));
  times.insert(times.end(), check.begin(), check.end());
  times.insert(times.end(), kReportTimes.begin(), kReportTimes.end());
  return times;
}

/// By number of edges.
using ExactPolygons = std::map<int, ExactPolygon>;

/// The curve that stands under `key` in --methods, or none if that is no truth.
std::optional<EnergyCurve> truth_curve(const std::string& key, const Point& point,
                                       const ExactPolygons& truths) {
  if (key == "exact_polygon") return [&polygon = truths.at(point.edges)](double t) { return polygon.at(t); };
  if (key == "edge_limited") return edge_limited(kDisc, point.edges);
  if (key == "step_limited") return step_limited(kDisc, point.h);
  return std::nullopt;
}

// --- rows

void set_reports(Record& record, const std::string& quantity, double until, const EnergyCurve& curve) {
  for (const double t : kReportTimes) {
    const std::optional<Energy> energy = t <= until ? curve(t) : std::nullopt;
    if (energy) record.set(report_column(quantity, t), energy->kinetic);
  }
}

void set_loss(Record& record, double loss) {
  record.set("loss_J", loss).set("relative_energy_loss", loss / kDisc.kinetic_energy());
}

void set_closed_forms(Record& record, const Point& point, bool polygon) {
  set_reports(record, "step_limited", point.until, step_limited(kDisc, point.h));
  if (polygon) set_reports(record, "edge_limited", point.until, edge_limited(kDisc, point.edges));
}

void set_polygon_truth(Record& record, const Point& point, const ExactPolygon& polygon) {
  set_reports(record, "exact_polygon", point.until, [&](double t) { return polygon.at(t); });
  record.set("polygon_reason", polygon.result().reason);
  if (const auto& departure = polygon.result().first_departure) {
    record.set("polygon_departure", truth::to_string(departure->kind))
        .set("polygon_departure_s", departure->t);
  }
}

/// Takes the loss up to the horizon apart. Total energies are compared, because the kinetic energy of a
/// polygon swings by m g R (1 - cos(pi/N)) within an edge; less m g R they are what is kinetic when a vertex
/// is straight down.
void set_split(Record& record, const Point& point, const ExactPolygon& polygon, double loss) {
  const std::optional<Energy> start = polygon.at(0.0);
  const std::optional<Energy> end = polygon.at(point.until);
  if (!start || !end) return;
  const double of_polygon = start->total() - end->total();
  const double kept_by_polygon = end->total() - rest_potential(kDisc);
  const double kept_at_floor = step_limited(kDisc, point.h)(point.until)->kinetic;
  // What the floor takes beyond the polygon's own loss; nothing where the polygon loses more.
  const double of_linearisation = std::max(0.0, kept_by_polygon - kept_at_floor);
  record.set("polygon_loss_J", of_polygon).set("linearisation_loss_J", of_linearisation);
  record.set("rest_loss_J", loss - of_polygon - of_linearisation);
}

void set_account(Record& record, const CaseRun<2>& run) {
  record.set("relative_energy_drift", run.largest_drift_J / run.initial.kinetic);
  record.set("largest_penetration_m", run.largest_penetration)
      .set("largest_residual", run.residual.largest());
  record.set("dynamics_residual", run.residual.dynamics).set("kinematics_residual", run.residual.kinematics);
  record.set("contact_residual", run.residual.contact).set("friction_residual", run.residual.friction);
  record.set("steps", run.steps).set("iterations", run.iterations).set("failed_steps", run.failed_steps);
  const Pose<2>& end = run.end.front().pose;
  record.set("end_x_m", end.position.x())
      .set("end_y_m", end.position.y())
      .set("end_angle_rad", end.rotation.angle());
}

/// Rows of a method's case. @param polygon  null if the method rolls the disc itself
std::vector<std::vector<Row>> method_rows(const CaseRun<2>& run, const Point& point,
                                          const ExactPolygon* polygon) {
  Record summary(kSummary);
  for (std::size_t i = 0; i < kReportTimes.size(); ++i) {
    if (run.reported[i]) summary.set(report_column("kinetic", kReportTimes[i]), run.reported[i]->kinetic);
  }
  set_account(summary, run);
  set_closed_forms(summary, point, polygon != nullptr);
  if (polygon != nullptr) set_polygon_truth(summary, point, *polygon);
  if (run.status == CaseStatus::ok) {
    const double loss = run.initial.total() - run.final.total();
    set_loss(summary, loss);
    if (polygon != nullptr) set_split(summary, point, *polygon, loss);
  }
  std::vector<Row> curve;
  for (const Sample& sample : run.samples) {
    curve.push_back(
        {number_cell(sample.t_s), number_cell(sample.energy.kinetic), number_cell(sample.energy.total())});
  }
  return {{summary.row()}, curve};
}

/// Rows of a truth, in the same form.
CaseResult truth_result(const EnergyCurve& truth, const Point& point) {
  Record summary(kSummary);
  set_reports(summary, "kinetic", point.until, truth);
  const std::optional<Energy> start = truth(0.0);
  const std::optional<Energy> end = truth(point.until);
  if (start && end) set_loss(summary, start->total() - end->total());
  std::vector<Row> curve;
  for (const double t : sample_times(point.until)) {
    const std::optional<Energy> energy = truth(t);
    if (energy) curve.push_back({number_cell(t), number_cell(energy->kinetic), number_cell(energy->total())});
  }
  return {CaseStatus::ok, "", {{summary.row()}, curve}};
}

// --- cases

/// Lists the cases of a selection.
class CaseList {
 public:
  explicit CaseList(const Selection& selection)
      : selection_(selection),
        points_(points(selection)),
        scene_(std::make_shared<Scene<2>>(disc_rolling_scene())) {
    for (const Point& point : points_) {
      truths_->try_emplace(point.edges, kDisc, point.edges, truth_times(selection.until));
    }
  }

  std::vector<Case> take() {
    for (const MethodSpec& method : selection_.methods) add_method(method);
    return std::move(cases_);
  }

 private:
  void add_method(const MethodSpec& method) {
    if (truth_curve(method.key, points_.front(), *truths_)) {
      add_truth(method);
    } else if (options_in_force(*scene_, method).contains("edges")) {
      add_polygon_method(method);
    } else {
      add_disc_method(method);
    }
  }

  /// `h_s` of a truth is that of the cases that it stands beside, whether it depends on it or not.
  void add_truth(const MethodSpec& method) {
    if (!method.options.empty())
      throw InputError("--methods", fmt::format("'{}'", format_method(method)), "no options: it is a truth");
    for (const Point& point : points_) {
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
      if (point.sweep == "check" || std::find(seen.begin(), seen.end(), place) != seen.end()) continue;
      seen.push_back(place);
      for (const MethodSpec& variant : variants(method, point.sweep)) {
        add_case(variant, point, {point.sweep, "", ""}, 1.0, false);
      }
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
    spec.run = {.h = point.h, .until = point.until, .samples = kSamples, .report = kReportTimes};
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
      .methods = {"implicit_ncp", "stewart_trinkle", "exact_polygon", "edge_limited", "step_limited"},
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
                "which sweeps: edges, step_size, check",
                AxisKind::text,
                {"edges", "step_size", "check"},
                {"edges", "step_size", "check"},
                1,
                {"edges", "step_size", "check"}}},
      .until = 10.0,
      .quick_until = 1.0};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = command_line(),
      .sweep_columns = {"sweep", "edges", "candidates"},
      .tables = {{"summary", kSummary}, {"kinetic_energy", kCurve}},
      .seed = std::nullopt,
      .cases = [](const Selection& selection) { return CaseList(selection).take(); }};
  return run_experiment(experiment, argc, argv);
}
