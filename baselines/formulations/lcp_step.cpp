#include "baselines/formulations/lcp_step.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/contact/frame.h"

namespace touchstone {

using Eigen::Index;

namespace {

// A gap that its velocity would miss by less than this times V h is not violated: well above the rounding of
// a solve.
constexpr double kViolation = 1e-12;

/// Columns W_n, W_t (, W_o, W_r) of a force at `arm` from the centre of mass (paper, Eq. 1 and section V.A).
template <int Dim>
auto contact_wrenches(const Vector<Dim>& normal, const TangentBasis<Dim>& tangents, const Vector<Dim>& arm) {
  Eigen::Matrix<double, Dimension<Dim>::velocity, 1 + Dimension<Dim>::friction> w;
  w.col(0) = wrench<Dim>(normal, arm);
  for (int i = 0; i < Dimension<Dim>::tangent; ++i) w.col(1 + i) = wrench<Dim>(tangents.col(i), arm);
  if constexpr (Dim == 3) w.col(3) << Vector<3>::Zero(), normal;
  return w;
}

/// Number of rows of one contact.
template <int Dim>
Index rows_of(const FrictionPyramid<Dim>& pyramid) {
  return pyramid.size() == 0 ? 1 : pyramid.size() + 2;
}

}  // namespace

template <int Dim>
TangentBasis<Dim> contact_tangents(const Vector<Dim>& normal, const ContactLaw<Dim>& law) {
  return contact_frame(normal, usable_reference(normal, law.tangent)).tangents;
}

template <int Dim>
void LcpStep<Dim>::reserve(int candidates, std::span<const FrictionPyramid<Dim>> pyramids) {
  contacts_.reserve(index(candidates));
  contact_of_candidate_.reserve(index(candidates));
  contact_of_row_.reserve(index(kReservedRows));
  // The fewest contacts whose rows make up n, for each n: contacts of different pairs may differ in rows.
  std::array<int, kReservedRows + 1> contacts{};
  for (int n = 1; n <= kReservedRows; ++n) {
    contacts[index(n)] = candidates + 1;
    for (const auto& pyramid : pyramids) {
      const Index rows = rows_of(pyramid);
      if (rows <= n) contacts[index(n)] = std::min(contacts[index(n)], contacts[index(n - rows)] + 1);
    }
    if (contacts[index(n)] <= candidates) workspaces_[n].reserve(n);
  }
}

template <int Dim>
auto LcpStep<Dim>::solve(const LcpStepData<Dim>& data, Candidates candidates, std::span<Twist<Dim>> velocity)
    -> Report {
  data_ = data;
  candidates_ = candidates;
  velocity_ = velocity;
  speed_ = velocity_scale();
  contacts_.clear();
  contact_of_candidate_.assign(candidates.size(), kIdle);
  std::copy(data.free.begin(), data.free.end(), velocity.begin());
  Report report;
  while (add_violated()) {
    const LinearPathResult result = solve_working_set();
    report.pivots += result.pivots;
    report.status = result.status;
    if (!result.solved()) return report;
    find_velocity();
  }
  report.residual = residual();
  return report;
}

template <int Dim>
auto LcpStep<Dim>::impulse(int i) const -> ContactVector {
  const int contact = contact_of_candidate_[index(i)];
  return contact == kIdle ? ContactVector(ContactVector::Zero()) : contacts_[index(contact)].impulse;
}

template <int Dim>
double LcpStep<Dim>::velocity_scale() const {
  double scale = data_.speed;
  for (const auto& candidate : candidates_) scale = std::max(scale, -candidate.points.gap / data_.h);
  return scale;
}

/// Takes the candidate of each pair that violates (a) most into the working set; false if there is none.
template <int Dim>
bool LcpStep<Dim>::add_violated() {
  const std::size_t before = contacts_.size();
  for (std::size_t first = 0; first < candidates_.size();) {
    std::size_t end = first + 1;
    while (end < candidates_.size() && candidates_[end].pair == candidates_[first].pair) ++end;
    const int worst = most_violated(static_cast<int>(first), static_cast<int>(end));
    if (worst != kIdle) contacts_.push_back(make_contact(worst));
    first = end;
  }
  if (contacts_.size() == before) return false;
  number_contacts();
  return true;
}

/// Of the idle candidates first ... end - 1, the first of those with the least  psi / h + W_n^T nu;  kIdle if
/// none is violated.
template <int Dim>
int LcpStep<Dim>::most_violated(int first, int end) const {
  int worst = kIdle;
  double worst_row = -kViolation * speed_;
  for (int i = first; i < end; ++i) {
    if (contact_of_candidate_[index(i)] != kIdle) continue;
    const auto& [pair, vertex, points] = candidates_[index(i)];
    const auto velocity_at = [&](int body, const Vector<Dim>& point) {
      return point_velocity<Dim>(velocity_[index(body)], point - data_.state[index(body)].pose.position);
    };
    const Vector<Dim> relative = velocity_at(data_.pairs[index(pair)].body_a, points.point_a) -
                                 velocity_at(data_.pairs[index(pair)].body_b, points.point_b);
    const double row = points.gap / data_.h + points.normal.dot(relative);
    if (row >= worst_row) continue;
    worst_row = row;
    worst = i;
  }
  return worst;
}

template <int Dim>
auto LcpStep<Dim>::make_contact(int candidate) const -> Contact {
  const auto& [pair_index, vertex, points] = candidates_[index(candidate)];
  const ContactPair& pair = data_.pairs[index(pair_index)];
  const InverseMass<Dim>& mass_a = data_.inverse_mass[index(pair.body_a)];
  const InverseMass<Dim>& mass_b = data_.inverse_mass[index(pair.body_b)];
  const TangentBasis<Dim> tangents = contact_tangents<Dim>(points.normal, data_.laws[index(pair_index)]);
  const Vector<Dim> arm_a = points.point_a - data_.state[index(pair.body_a)].pose.position;
  const Vector<Dim> arm_b = points.point_b - data_.state[index(pair.body_b)].pose.position;
  Contact contact;
  contact.candidate = candidate;
  contact.body_a = mass_a.movable() ? pair.body_a : kFixed;
  contact.body_b = mass_b.movable() ? pair.body_b : kFixed;
  contact.pyramid = &data_.pyramids[index(pair_index)];
  contact.reduced_mass = 1 / (mass_a.linear + mass_b.linear);
  contact.wrench_a = contact_wrenches<Dim>(points.normal, tangents, arm_a);
  contact.wrench_b = -contact_wrenches<Dim>(points.normal, tangents, arm_b);
  contact.response_a = contact.reduced_mass * mass_a.apply(contact.wrench_a);
  contact.response_b = contact.reduced_mass * mass_b.apply(contact.wrench_b);
  contact.gap_speed = points.gap / (data_.h * speed_);
  return contact;
}

/// Puts the working set in the order of the candidates and numbers its rows.
template <int Dim>
void LcpStep<Dim>::number_contacts() {
  std::sort(contacts_.begin(), contacts_.end(),
            [](const Contact& x, const Contact& y) { return x.candidate < y.candidate; });
  contact_of_row_.clear();
  size_ = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    contact_of_candidate_[index(contacts_[c].candidate)] = static_cast<int>(c);
    contacts_[c].first = size_;
    size_ += rows_of(*contacts_[c].pyramid);
    contact_of_row_.resize(index(size_), static_cast<int>(c));
  }
}

template <int Dim>
LinearPathResult LcpStep<Dim>::solve_working_set() {
  Workspace& work = workspaces_[size_];
  write_velocity_rows(data_.free, work.rows);
  work.cover.setOnes(size_);
  const LinearPathResult result = work.path.lemke(*this, work.rows, work.cover, work.z);
  if (result.solved()) read_impulses(work.z);
  return result;
}

template <int Dim>
void LcpStep<Dim>::read_impulses(const Eigen::VectorXd& z) {
  for (Contact& contact : contacts_) {
    contact.impulse.setZero();
    for (Index local = 0; local < rows_of(*contact.pyramid); ++local) {
      contact.impulse += z[contact.first + local] * unit_impulse(contact, local);
    }
    contact.impulse *= contact.reduced_mass * speed_;
  }
}

/// nu' = nu_f + M^-1 W p.
template <int Dim>
void LcpStep<Dim>::find_velocity() {
  std::copy(data_.free.begin(), data_.free.end(), velocity_.begin());
  for (const Contact& contact : contacts_) {
    const ContactVector change = contact.impulse / contact.reduced_mass;
    if (contact.body_a != kFixed) velocity_[index(contact.body_a)] += contact.response_a * change;
    if (contact.body_b != kFixed) velocity_[index(contact.body_b)] += contact.response_b * change;
  }
}

/// Overwrites the workspace's rows.
template <int Dim>
double LcpStep<Dim>::residual() {
  if (contacts_.empty()) return 0.0;
  Workspace& work = workspaces_[size_];
  write_velocity_rows(velocity_, work.rows);
  for (const Contact& contact : contacts_) {
    for (Index local = 0; local < rows_of(*contact.pyramid); ++local) {
      add_sparse_entries(contact, local, work.z[contact.first + local], work.rows);
    }
  }
  return work.z.cwiseMin(work.rows).template lpNorm<Eigen::Infinity>();
}

/// Rows (a), (b), (c) with what gaps and velocities make of them: the right side if the velocity is nu_f.
template <int Dim>
void LcpStep<Dim>::write_velocity_rows(std::span<const Twist<Dim>> velocity, Eigen::VectorXd& rows) const {
  rows.resize(size_);
  for (const Contact& contact : contacts_) {
    ContactVector relative = ContactVector::Zero();
    if (contact.body_a != kFixed) relative += contact.wrench_a.transpose() * velocity[index(contact.body_a)];
    if (contact.body_b != kFixed) relative += contact.wrench_b.transpose() * velocity[index(contact.body_b)];
    write_rows(contact, relative / speed_, rows);
    rows[contact.first] += contact.gap_speed;
  }
}

/// The impulse, components n, t (, o, r), of one of a contact's unknowns p_n, beta_1 ... beta_d, sigma at 1.
template <int Dim>
auto LcpStep<Dim>::unit_impulse(const Contact& contact, Index local) -> ContactVector {
  ContactVector impulse = ContactVector::Zero();
  if (local == 0) {
    impulse[0] = 1.0;
  } else if (local <= contact.pyramid->size()) {
    impulse.template tail<Dimension<Dim>::friction>() = contact.pyramid->directions.col(local - 1);
  }
  return impulse;
}

/// What a relative velocity makes of a contact's rows.
template <int Dim>
void LcpStep<Dim>::write_rows(const Contact& contact, const ContactVector& velocity,
                              Eigen::Ref<Eigen::VectorXd> rows) {
  const Index d = contact.pyramid->size();
  rows[contact.first] = velocity[0];
  if (d == 0) return;
  const auto slip = velocity.template tail<Dimension<Dim>::friction>();
  rows.segment(contact.first + 1, d).noalias() = contact.pyramid->directions.transpose() * slip;
  rows[contact.first + 1 + d] = 0.0;
}

/// What an unknown adds to its own contact's rows beside its impulse: sigma to (b), impulses to (c).
template <int Dim>
void LcpStep<Dim>::add_sparse_entries(const Contact& contact, Index local, double amount,
                                      Eigen::Ref<Eigen::VectorXd> rows) {
  const Index d = contact.pyramid->size();
  if (d == 0) return;
  if (local == 1 + d) {
    rows.segment(contact.first + 1, d).array() += amount;
  } else {
    rows[contact.first + 1 + d] += local == 0 ? contact.pyramid->mu * amount : -amount;
  }
}

template <int Dim>
void LcpStep<Dim>::column(Index j, Eigen::Ref<Eigen::VectorXd> out) const {
  const Contact& source = contacts_[index(contact_of_row_[index(j)])];
  const Index local = j - source.first;
  const ContactVector impulse = unit_impulse(source, local);
  const Twist<Dim> change_a = source.response_a * impulse;
  const Twist<Dim> change_b = source.response_b * impulse;
  const auto add_change = [&](int body, const Wrenches& wrenches, ContactVector& velocity) {
    if (body == kFixed) return;
    if (body == source.body_a) velocity += wrenches.transpose() * change_a;
    if (body == source.body_b) velocity += wrenches.transpose() * change_b;
  };
  for (const Contact& contact : contacts_) {
    ContactVector velocity = ContactVector::Zero();
    add_change(contact.body_a, contact.wrench_a, velocity);
    add_change(contact.body_b, contact.wrench_b, velocity);
    write_rows(contact, velocity, out);
  }
  add_sparse_entries(source, local, 1.0, out);
}

template TangentBasis<2> contact_tangents(const Vector<2>&, const ContactLaw<2>&);
template TangentBasis<3> contact_tangents(const Vector<3>&, const ContactLaw<3>&);
template class LcpStep<2>;
template class LcpStep<3>;

}  // namespace touchstone
