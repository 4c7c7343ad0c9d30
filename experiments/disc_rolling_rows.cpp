#include "experiments/disc_rolling_rows.h"

#include <algorithm>

#include "experiments/harness/record.h"

namespace touchstone::disc_rolling {

using namespace harness;

namespace {

/// A column of the report times: kinetic_5s_J.
std::string report_column(const std::string& quantity, double t) {
  return quantity + "_" + number_cell(t) + "s_J";
}

std::vector<std::string> all_summary_columns() {
  std::vector<std::string> columns;
  const auto add_reports = [&](const std::string& quantity) {
    for (const double t : kReportTimes) columns.push_back(report_column(quantity, t));
  };
  const auto add = [&](std::initializer_list<const char*> names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  add_reports("kinetic");
  add_reports("polygon_loss");
  add_reports("method_loss");
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

/// At each report time: what the shape that the method simulates loses by physics, and what it loses or gains
/// beyond that. The disc itself loses nothing.
void set_split_over_time(Record& record, const CaseRun<2>& run, const ExactPolygon* polygon) {
  for (std::size_t i = 0; i < kReportTimes.size(); ++i) {
    const double t = kReportTimes[i];
    double of_polygon = 0.0;
    if (polygon != nullptr) {
      const std::optional<Energy> start = polygon->at(0.0);
      const std::optional<Energy> then = polygon->at(t);
      if (!start || !then) continue;
      of_polygon = start->total() - then->total();
    }
    if (!run.reported[i]) continue;
    const double loss = run.initial.total() - run.reported[i]->total();
    record.set(report_column("polygon_loss", t), of_polygon);
    record.set(report_column("method_loss", t), loss - of_polygon);
  }
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

}  // namespace

const std::vector<std::string>& summary_columns() {
  static const std::vector<std::string> columns = all_summary_columns();
  return columns;
}

const std::vector<std::string>& curve_columns() {
  static const std::vector<std::string> columns = {"t_s", "kinetic_J", "total_J"};
  return columns;
}

int samples_of(const Point& point) { return point.sweep == "engines" ? kEngineSamples : kSamples; }

std::vector<double> sample_times(const Point& point) {
  const int samples = samples_of(point);
  std::vector<double> times;
  for (int k = 0; k <= samples; ++k) times.push_back(point.until * k / samples);
  return times;
}

bool is_truth(const std::string& key) {
  return key == "exact_polygon" || key == "edge_limited" || key == "step_limited";
}

std::optional<EnergyCurve> truth_curve(const std::string& key, const Point& point,
                                       const ExactPolygons& truths) {
  if (key == "exact_polygon") return [&polygon = truths.at(point.edges)](double t) { return polygon.at(t); };
  if (key == "edge_limited") return edge_limited(kDisc, point.edges);
  if (key == "step_limited") return step_limited(kDisc, point.h);
  return std::nullopt;
}

std::vector<std::vector<Row>> method_rows(const CaseRun<2>& run, const Point& point,
                                          const ExactPolygon* polygon) {
  Record summary(summary_columns());
  for (std::size_t i = 0; i < kReportTimes.size(); ++i) {
    if (run.reported[i]) summary.set(report_column("kinetic", kReportTimes[i]), run.reported[i]->kinetic);
  }
  set_split_over_time(summary, run, polygon);
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

CaseResult truth_result(const EnergyCurve& truth, const Point& point) {
  Record summary(summary_columns());
  set_reports(summary, "kinetic", point.until, truth);
  const std::optional<Energy> start = truth(0.0);
  const std::optional<Energy> end = truth(point.until);
  if (start && end) set_loss(summary, start->total() - end->total());
  std::vector<Row> curve;
  for (const double t : sample_times(point)) {
    const std::optional<Energy> energy = truth(t);
    if (energy) curve.push_back({number_cell(t), number_cell(energy->kinetic), number_cell(energy->total())});
  }
  return {CaseStatus::ok, "", {{summary.row()}, curve}};
}

}  // namespace touchstone::disc_rolling
