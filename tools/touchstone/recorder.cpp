#include "tools/touchstone/recorder.h"

#include <cmath>
#include <limits>

#include "core/contact/closest_points.h"
#include "experiments/harness/run_case.h"

namespace touchstone::program {

namespace {

using harness::format_csv;
using harness::number_cell;
using harness::Row;

/// A body's state in space.
struct SpatialState {
  Vector<3> position, velocity, omega;
  Eigen::Quaterniond orientation;
};

SpatialState in_space(const BodyState<3>& state) {
  return {state.pose.position, state.velocity.head<3>(), state.velocity.tail<3>(),
          state.pose.rotation.quaternion()};
}

SpatialState in_space(const BodyState<2>& state) {
  const double half = state.pose.rotation.angle() / 2;
  return {{state.pose.position.x(), state.pose.position.y(), 0},
          {state.velocity[0], state.velocity[1], 0},
          {0, 0, state.velocity[2]},
          Eigen::Quaterniond(std::cos(half), 0, 0, std::sin(half))};
}

/// Components t, o and r; in the plane o and r are zero.
Vector<3> in_space(const FrictionVector<2>& friction) { return {friction[0], 0, 0}; }
Vector<3> in_space(const FrictionVector<3>& friction) { return friction; }

void append(Row& row, const Vector<3>& v) {
  for (const double value : v) row.push_back(number_cell(value));
}

}  // namespace

CsvText::CsvText(Row header) : header_(std::move(header)), text_(format_csv({header_, {}})) {}

void CsvText::append(std::vector<Row> rows) {
  harness::Table table{header_, std::move(rows)};
  sort_rows(table);
  for (Row& row : table.rows) text_ += format_csv({std::move(row), {}});
}

template <int Dim>
Recorder<Dim>::Recorder(const Method<Dim>& method)
    : method_(method),
      trajectory_({"t_s", "body", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s",
                   "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"}),
      contacts_({"t_s", "body_a", "body_b", "gap_m", "normal_N", "tangent_t_N", "tangent_o_N", "torsion_Nm",
                 "slip_m_s", "spin_rad_s"}),
      energy_({"t_s", "kinetic_J", "potential_J", "total_J", "friction_loss_J", "impact_loss_J", "drift_J"}),
      estimate_({"t_s", "body", "position_m", "turn_rad", "velocity_m_s", "angular_velocity_rad_s"}) {
  for (const auto& body : method.scene().bodies) surfaces_.push_back(make_surface(body.shape));
}

template <int Dim>
void Recorder<Dim>::record(double t, double h, const EnergyLedger<Dim>& ledger) {
  const std::string cell = number_cell(t);
  record_bodies(cell);
  if (h > 0) record_contacts(cell, h);
  record_energy(cell, ledger);
  record_estimate(cell);
}

template <int Dim>
void Recorder<Dim>::record_bodies(const std::string& t) {
  std::vector<Row> rows;
  const auto state = method_.state();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Body<Dim>& body = method_.scene().bodies[i];
    if (body.fixed) continue;
    const SpatialState s = in_space(state[i]);
    Row row = {t, body.name};
    append(row, s.position);
    row.push_back(number_cell(s.orientation.w()));
    append(row, s.orientation.vec());
    append(row, s.velocity);
    append(row, s.omega);
    rows.push_back(std::move(row));
  }
  trajectory_.append(std::move(rows));
}

/// The signed distance of the two bodies where they are now, whatever the method thinks of it.
template <int Dim>
double Recorder<Dim>::gap(const ContactImpulse<Dim>& contact) const {
  const auto a = static_cast<std::size_t>(contact.body_a);
  const auto b = static_cast<std::size_t>(contact.body_b);
  const auto state = method_.state();
  return closest_points(*surfaces_[a], state[a].pose, *surfaces_[b], state[b].pose).gap;
}

template <int Dim>
void Recorder<Dim>::record_contacts(const std::string& t, double h) {
  std::vector<Row> rows;
  const auto state = method_.state();
  for (const auto& contact : method_.contacts()) {
    const auto name = [&](int body) { return method_.scene().bodies[static_cast<std::size_t>(body)].name; };
    const RelativeMotion<Dim> motion = relative_motion(contact, state, state);
    Row row = {t, name(contact.body_a), name(contact.body_b), number_cell(gap(contact)),
               number_cell(contact.normal_impulse / h)};
    append(row, in_space(contact.friction_impulse) / h);
    row.push_back(number_cell((contact.tangents.transpose() * motion.velocity).norm()));
    row.push_back(number_cell(motion.spin));
    rows.push_back(std::move(row));
  }
  contacts_.append(std::move(rows));
}

/// The losses are unknown, and their cells empty, where a method does not tell its contact impulses.
template <int Dim>
void Recorder<Dim>::record_energy(const std::string& t, const EnergyLedger<Dim>& ledger) {
  const bool told = method_.capabilities().contact_impulses;
  const auto loss = [&](double value) {
    return number_cell(told ? value : std::numeric_limits<double>::quiet_NaN());
  };
  const Energy& energy = ledger.energy();
  const EnergyAccount& account = ledger.account();
  energy_.append({{t, number_cell(energy.kinetic), number_cell(energy.potential), number_cell(energy.total()),
                   loss(account.friction_loss), loss(account.impact_loss), loss(account.drift)}});
}

/// Lengths of what the method takes its state to be off, a row a moving body.
template <int Dim>
void Recorder<Dim>::record_estimate(const std::string& t) {
  std::vector<Row> rows;
  const auto errors = method_.error_estimate();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Body<Dim>& body = method_.scene().bodies[i];
    if (body.fixed) continue;
    const harness::EstimatedError error = harness::estimated_error(errors[i]);
    rows.push_back({t, body.name, number_cell(error.position_m), number_cell(error.turn_rad),
                    number_cell(error.velocity_m_s), number_cell(error.angular_velocity_rad_s)});
  }
  estimate_.append(std::move(rows));
}

template <int Dim>
std::vector<harness::FileContent> Recorder<Dim>::files(const std::filesystem::path& folder) const {
  std::vector<harness::FileContent> files = {{folder / "trajectory.csv", trajectory_.text()},
                                             {folder / "contacts.csv", contacts_.text()},
                                             {folder / "energy.csv", energy_.text()}};
  if (!method_.error_estimate().empty()) files.push_back({folder / kErrorEstimateFile, estimate_.text()});
  return files;
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace touchstone::program
