// Question: does a ball that rolls on one ball and slides on another change between rolling, sliding and
// separation when it should, and without a jump?
// Success criterion: the implicit NCP keeps Eqs. 10-11, the contacts closed, the rolling contact without slip
// and the sliding one on the friction ellipsoid, each to 1e-10 at every step; its events come in the right
// order; and its error against the event-driven integration of the same laws is of first order in h. Source:
// Example 3, Figs. 6, 7 and 8 of Chakraborty, Berard, Akella and Trinkle, "An implicit time-stepping method
// for multibody systems with intermittent contact" (2007), h = 0.01 s; mass and inertia, not printed, are a
// solid unit ball's. Expected: contact 1 slides from the start and separates at 3.213 s; contact 2 rolls,
// slides from 2.945 s and separates at 3.702 s (read off the paper's plots: 3.2, 3 and 3.6 s); velocities are
// smooth.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "experiments/harness/account_columns.h"
#include "experiments/harness/contact_view.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/harness/motion_error.h"
#include "experiments/scenarios/ball_history.h"
#include "experiments/scenarios/sphere_on_spheres.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr const char* kScenario = "sphere_on_spheres";
constexpr const char* kTruth = "event_driven";
constexpr double kTrajectoryStep = 0.01;  // [s]; the paper's
constexpr int kFigureSamples = 200;       // of the truth and of the methods that Figs. 6 to 8 are drawn from
constexpr int kSamples = 50;              // of every other one
const std::vector<double> kReportTimes = {2, 2.5, 3.5, 4};  // [s]
const truth::SphereOnSpheres kBalls;

std::vector<std::string> summary_columns() {
  std::vector<std::string> columns = error_columns(kReportTimes);
  columns.insert(columns.end(),
                 {"story", "contact_2_slides_s", "contact_1_separates_s", "contact_2_separates_s",
                  "largest_event_error_s", "largest_event_error_steps", "rolling_slip_m_s",
                  "sliding_friction_gap_Ns", "separation_jump", "true_friction_loss_J"});
  const std::vector<std::string> account = account_columns();
  columns.insert(columns.end(), account.begin(), account.end());
  return columns;
}

std::vector<std::string> trajectory_columns() {
  std::vector<std::string> columns = {"t_s",      "vx_m_s",   "vy_m_s",  "vz_m_s",
                                      "wx_rad_s", "wy_rad_s", "wz_rad_s"};
  for (const char* i : {"1", "2"}) {
    for (const char* column : {"mode_{}", "normal_{}_N", "tangential_{}_N", "torsion_{}_Nm",
                               "friction_norm_{}_N", "slip_{}_m_s", "spin_{}_rad_s"}) {
      columns.push_back(fmt::format(fmt::runtime(column), i));
    }
  }
  return columns;
}

const std::vector<std::string> kSummary = summary_columns();
const std::vector<std::string> kTrajectory = trajectory_columns();

// --- the truth

/// The event-driven integration at the times that a table may ask for.
class BallTruth {
 public:
  explicit BallTruth(double until) {
    std::vector<double> times;
    for (const double t : kReportTimes) {
      if (t <= until) times.push_back(t);
    }
    for (int k = 0; k <= kFigureSamples; ++k) times.push_back(until * k / kFigureSamples);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    result_ = truth::roll_on_spheres(kBalls, times);
    events_ = ball_events(result_);
    for (const truth::SphereOnSpheresSample& s : result_.samples) {
      motions_[s.t] = {s.position, s.velocity, s.omega, s.orientation};
    }
  }

  [[nodiscard]] std::optional<TrueMotion> at(double t) const {
    const auto it = motions_.find(t);
    return it == motions_.end() ? std::nullopt : std::optional(it->second);
  }
  [[nodiscard]] const BallEvents& events() const { return events_; }
  /// What friction takes up to the horizon: all that is lost, as nothing bounces. The force is constant, so
  /// its work is the fall of a potential [J].
  [[nodiscard]] double friction_loss() const {
    const auto energy = [](const truth::SphereOnSpheresSample& s) {
      return 0.5 * kBalls.mass * s.velocity.squaredNorm() + 0.5 * kBalls.inertia * s.omega.squaredNorm() -
             kBalls.force.dot(s.position);
    };
    return energy(result_.samples.front()) - energy(result_.samples.back());
  }
  [[nodiscard]] BallHistory history() const { return ball_history(kBalls, result_); }

 private:
  truth::SphereOnSpheresResult result_;
  BallEvents events_;
  std::map<double, TrueMotion> motions_;
};

// --- rows

void set_events(Record& record, const BallEvents& events) {
  record.set("story", events.story);
  if (events.slides[1]) record.set("contact_2_slides_s", *events.slides[1]);
  if (events.separates[0]) record.set("contact_1_separates_s", *events.separates[0]);
  if (events.separates[1]) record.set("contact_2_separates_s", *events.separates[1]);
}

/// Of the events that the truth has, if the method has them all.
void set_event_error(Record& record, const BallEvents& events, const BallEvents& truth, double h) {
  double largest = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto member : {&BallEvents::slides, &BallEvents::separates}) {
      const std::optional<double>& expected = (truth.*member)[i];
      const std::optional<double>& found = (events.*member)[i];
      if (expected && !found) return;
      if (expected) largest = std::max(largest, std::abs(*found - *expected));
    }
  }
  record.set("largest_event_error_s", largest).set("largest_event_error_steps", largest / h);
}

void set_laws(Record& record, const BallLaws& laws) {
  record.set("rolling_slip_m_s", laws.rolling_slip).set("sliding_friction_gap_Ns", laws.sliding_friction_gap);
  if (laws.separation_jump) record.set("separation_jump", *laws.separation_jump);
}

std::vector<Row> trajectory_rows(const BallHistory& history, int samples) {
  const std::size_t every =
      std::max<std::size_t>(1, (history.size() - 1) / static_cast<std::size_t>(samples));
  std::vector<Row> rows;
  for (std::size_t k = 0; k < history.size(); k += every) {
    Row row = {number_cell(history[k].t)};
    for (const double v : history[k].velocity) row.push_back(number_cell(v));
    for (std::size_t i = 0; i < 2; ++i) {
      if (!history[k].contacts) {
        row.resize(row.size() + 7);
        continue;
      }
      const BallContactInstant& c = (*history[k].contacts)[i];
      row.emplace_back(to_string(c.mode));
      for (const double value : {c.normal, c.tangential, c.torsion, c.friction_norm, c.slip, c.spin}) {
        row.push_back(number_cell(value));
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// --- cases

/// What is run: a method with its options on one scene with one step.
struct Point {
  MethodSpec method;
  std::string shape;
  std::shared_ptr<const Scene<3>> scene;
  double h = 0.0;
  std::optional<double> coarser;  ///< the next larger step of the sweep, which the order is measured against
};

/// Lists the cases of a selection.
class CaseList {
 public:
  explicit CaseList(const Selection& selection)
      : selection_(selection),
        steps_(selection.numbers("step-sizes")),
        truth_(std::make_shared<BallTruth>(selection.until)) {
    std::sort(steps_.begin(), steps_.end());
    for (const auto& [name, shape] :
         {std::pair{"ellipsoid", BallShape::ellipsoid}, std::pair{"sphere", BallShape::sphere}}) {
      scenes_[name] = std::make_shared<Scene<3>>(sphere_on_spheres_scene(shape, kBalls));
    }
  }

  std::vector<Case> take() {
    for (const MethodSpec& method : selection_.methods) {
      if (method.key == kTruth) {
        add_truth(method);
      } else {
        add_method(method);
      }
    }
    return std::move(cases_);
  }

 private:
  void add_truth(const MethodSpec& method) {
    if (!method.options.empty())
      throw InputError("--methods", "'" + format_method(method) + "'", "no options: it is a truth");
    Case one;
    one.id = {kScenario, kTruth, "", {""}, std::numeric_limits<double>::quiet_NaN(), selection_.until};
    one.run = [truth = truth_] {
      Record summary(kSummary);
      set_events(summary, truth->events());
      summary.set("true_friction_loss_J", truth->friction_loss());
      const auto samples = trajectory_rows(truth->history(), kFigureSamples);
      return CaseResult{CaseStatus::ok, "", {{summary.row()}, samples}};
    };
    cases_.push_back(std::move(one));
  }

  /// With ellipsoids, as the paper has them; and with spheres, if the method refuses ellipsoids.
  void add_method(const MethodSpec& method) {
    for (const char* shape : {"ellipsoid", "sphere"}) {
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        for (const MethodSpec& variant : variants(method, steps_[i])) {
          Point point{variant, shape, scenes_.at(shape), steps_[i], std::nullopt};
          if (i + 1 < steps_.size()) point.coarser = steps_[i + 1];
          add_case(point);
        }
      }
      if (can_represent(method, *scenes_.at(shape))) break;
    }
  }

  /// At the paper's step both solvers and both gap functions of the implicit NCP, if no options were given.
  static std::vector<MethodSpec> variants(const MethodSpec& method, double h) {
    if (method.key != "implicit_ncp" || h != kTrajectoryStep || !method.options.empty()) return {method};
    std::vector<MethodSpec> variants;
    for (const char* solver : {"path", "semismooth"}) {
      for (const char* gap : {"workspace", "distance"}) {
        variants.push_back({method.key, {{"solver", solver}, {"gap", gap}}});
      }
    }
    return variants;
  }

  static bool can_represent(const MethodSpec& method, const Scene<3>& scene) {
    try {
      static_cast<void>(find_method<3>(method.key).make(scene, method.options));
      return true;
    } catch (const Unsupported&) {
      return false;
    }
  }

  void add_case(const Point& point) {
    MethodCase<3> spec;
    spec.scenario = kScenario;
    spec.scene = point.scene;
    spec.method = point.method;
    spec.sweep = {point.shape};
    spec.run = {.h = point.h, .until = selection_.until, .keep_steps = true};
    spec.tabulate = [point, until = selection_.until, truth = truth_](const CaseRun<3>& run) {
      return method_rows(run, point, until, *truth);
    };
    cases_.push_back(make_case(std::move(spec)));
  }

  static std::vector<std::vector<Row>> method_rows(const CaseRun<3>& run, const Point& point, double until,
                                                   const BallTruth& truth) {
    const int ball = point.scene->body("ball");
    const auto motion = [&truth](double t) { return truth.at(t); };
    const ReportedErrors errors = reported_errors(run, ball, kReportTimes, motion);
    const BallHistory history = ball_history(run, *point.scene, point.h);
    Record summary(kSummary);
    set_errors(summary, kReportTimes, errors);
    if (point.coarser) {
      const CaseRun<3> coarse = run_beside(*point.scene, point.method, *point.coarser, until);
      set_orders(summary, kReportTimes, reported_errors(coarse, ball, kReportTimes, motion), *point.coarser,
                 errors, point.h);
    }
    const BallEvents events = ball_events(history);
    set_events(summary, events);
    if (run.status == CaseStatus::ok) set_event_error(summary, events, truth.events(), point.h);
    set_laws(summary, ball_laws(history, point.h));
    summary.set("true_friction_loss_J", truth.friction_loss());
    set_account(summary, run);
    const int samples = point.method.key == "implicit_ncp" ? kFigureSamples : kSamples;
    if (point.h != kTrajectoryStep) return {{summary.row()}, {}};
    return {{summary.row()}, trajectory_rows(history, samples)};
  }

  const Selection& selection_;
  std::vector<double> steps_;  ///< increasing [s]
  std::map<std::string, std::shared_ptr<const Scene<3>>> scenes_;
  std::shared_ptr<const BallTruth> truth_;
  std::vector<Case> cases_;
};

std::vector<std::string> default_methods() {
  std::vector<std::string> keys = method_keys<3>();
  keys.emplace_back(kTruth);
  return keys;
}

CommandLineSpec command_line() {
  return {
      .name = kScenario,
      .about = "Does a ball on two balls roll, slide and separate when it should? (Figs. 6, 7 and 8)",
      .examples =
          "  sphere_on_spheres                              what is committed, every method there is\n"
          "  sphere_on_spheres --methods implicit_ncp,event_driven --step-sizes 0.02,0.01 --out /tmp/balls\n",
      .methods = default_methods(),
      .axes = {{"step-sizes",
                "step sizes h [s]; trajectories are kept at 0.01",
                AxisKind::positive,
                {"0.1", "0.05", "0.02", "0.01", "0.005", "0.002", "0.001", "0.0005"},
                {"0.1", "0.05", "0.01"}}},
      .until = 4.0,
      .quick_until = 4.0};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = command_line(),
      .sweep_columns = {"shape"},
      .tables = {{"summary", kSummary}, {"trajectory", kTrajectory}},
      .seed = std::nullopt,
      .cases = [](const Selection& selection) { return CaseList(selection).take(); }};
  return run_experiment(experiment, argc, argv);
}
