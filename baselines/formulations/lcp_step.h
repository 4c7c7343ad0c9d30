#pragma once

#include <map>
#include <span>
#include <vector>

#include "baselines/formulations/contact_candidates.h"
#include "baselines/formulations/friction_pyramid.h"
#include "core/complementarity/linear_path.h"

namespace touchstone {

/// M^-1 of one body at the start of a step; zero of a fixed body.
template <int Dim>
struct InverseMass {
  double linear = 0.0;                          ///< [1/kg]
  Inertia<Dim> angular = Inertia<Dim>::Zero();  ///< world frame [1/(kg m^2)]

  [[nodiscard]] bool movable() const { return linear > 0.0; }
  /// M^-1 w, column by column.
  template <typename Wrenches>
  [[nodiscard]] Wrenches apply(const Wrenches& w) const {
    Wrenches result;
    result.template topRows<Dim>() = linear * w.template topRows<Dim>();
    result.template bottomRows<Dimension<Dim>::angular>() =
        angular * w.template bottomRows<Dimension<Dim>::angular>();
    return result;
  }
};

/// What a step starts from. Spans by body, `laws` and `pyramids` by pair; all outlive the solve.
template <int Dim>
struct LcpStepData {
  std::span<const ContactPair> pairs;
  std::span<const ContactLaw<Dim>> laws;  ///< only their direction of t is read
  std::span<const FrictionPyramid<Dim>> pyramids;
  std::span<const BodyState<Dim>> state;  ///< at the start of the step
  std::span<const InverseMass<Dim>> inverse_mass;
  std::span<const Twist<Dim>> free;  ///< nu_f, the velocity at the end of the step without contact
  double speed = 1.0;                ///< > 0: the scale of the free velocities [m/s]
  double h = 0.0;                    ///< [s]
};

/// The linear complementarity problem of one step (Stewart & Trinkle 1996; the paper's Eq. 4 with W at the
/// start of the step, psi to first order and the friction ellipsoid as a pyramid). Per candidate:
///   (a)  0 <= p_n    _|_  psi / h + W_n^T nu'      >= 0
///   (b)  0 <= beta_j _|_  d_j . W_f^T nu' + sigma  >= 0,   j = 1 ... d
///   (c)  0 <= sigma  _|_  mu p_n - sum_j beta_j    >= 0
/// with  nu' = nu_f + sum M^-1 (W_n p_n + W_f sum_j d_j beta_j)  put in. A frictionless contact is (a) alone.
///
/// Few of many candidates touch, so their rows are generated: Lemke's method solves the problem of a working
/// set, empty at first; of each pair the candidate that then violates (a) most, the first of equals, joins
/// the set; and so on until none is violated. Each round adds one at least, so there is an end, and then the
/// working set's impulses, with zeros for the others (and for their sigma the slip speed), solve the problem
/// of ALL candidates.
///
/// A candidate that is never violated has no influence at all. The velocity of every round is that of a
/// problem of some vertices, to which the bound of reach_bound.h applies: what lies outside it is never
/// violated. Hence `reachable` and `all` solve the very same problems, and give the same trajectory to the
/// last bit even where a problem has several solutions.
///
/// A round cannot fail if nothing is penetrated at the start of the step (Stewart & Trinkle 1996). Its matrix
/// is copositive, so a ray of Lemke's method has a direction u >= 0 with  u^T M u = 0,  hence  W u = 0,  and
/// u^T q < 0  (Cottle, Pang & Stone 1992, section 4.4);  but  u^T q = u_n^T psi / h + (W u)^T nu_f >= 0.
///
/// Scaling: velocities by V, that of the free motion or of leaving the deepest penetration within the step,
/// whichever is larger; impulses by V and the contact's reduced mass.
template <int Dim>
class LcpStep final : private ColumnSource {
 public:
  /// Components n, t (, o, r) of an impulse or of a relative velocity at a contact.
  using ContactVector = Eigen::Matrix<double, 1 + Dimension<Dim>::friction, 1>;
  using Candidates = std::span<const ContactCandidate<Dim>>;

  struct Report {
    LinearPathStatus status = LinearPathStatus::solved;
    int pivots = 0;  ///< of all rounds
    /// max |min(z, w)| over the rows of the working set, w at nu', scaled as described above.
    double residual = 0.0;
  };

  /// Makes room for so many candidates at once, and for working sets of up to kReservedRows rows: their steps
  /// allocate nothing. A larger one does when its size is met for the first time.
  /// @param pyramids  of all pairs
  void reserve(int candidates, std::span<const FrictionPyramid<Dim>> pyramids);

  /// Rows of 25 contacts in the plane, and of 10 with the default pyramid in space.
  static constexpr int kReservedRows = 100;

  /// @param velocity  out: nu' by body. Meaningless unless solved
  [[nodiscard]] Report solve(const LcpStepData<Dim>& data, Candidates candidates,
                             std::span<Twist<Dim>> velocity);

  /// After solve(): of candidate i on body A of its pair, [N s] and [N m s].
  [[nodiscard]] ContactVector impulse(int i) const;

 private:
  static constexpr int kFixed = -1;
  static constexpr int kIdle = -1;
  using Wrenches = Eigen::Matrix<double, Dimension<Dim>::velocity, 1 + Dimension<Dim>::friction>;

  /// A candidate in the working set.
  struct Contact {
    int candidate = 0;
    int body_a = kFixed;  ///< kFixed if it does not move
    int body_b = kFixed;
    const FrictionPyramid<Dim>* pyramid = nullptr;
    Wrenches wrench_a, wrench_b;      ///< W: columns W_n, W_t (, W_o, W_r)
    Wrenches response_a, response_b;  ///< M^-1 W times the reduced mass
    double reduced_mass = 0.0;        ///< [kg]
    double gap_speed = 0.0;           ///< psi / (h V)
    Eigen::Index first = 0;           ///< of its rows (a), (b), (c)
    ContactVector impulse = ContactVector::Zero();
  };
  /// Vectors of one problem size. One set a size, because a vector that changes its size allocates.
  struct Workspace {
    LinearPath path;
    Eigen::VectorXd rows, cover, z;

    void reserve(Eigen::Index n) {
      path.reserve(n);
      for (Eigen::VectorXd* v : {&rows, &cover, &z}) v->resize(n);
    }
  };

  static std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] double velocity_scale() const;
  [[nodiscard]] bool add_violated();
  [[nodiscard]] int most_violated(int first, int end) const;
  [[nodiscard]] Contact make_contact(int candidate) const;
  void number_contacts();
  [[nodiscard]] LinearPathResult solve_working_set();
  void read_impulses(const Eigen::VectorXd& z);
  void find_velocity();
  [[nodiscard]] double residual();

  void write_velocity_rows(std::span<const Twist<Dim>> velocity, Eigen::VectorXd& rows) const;
  static ContactVector unit_impulse(const Contact& contact, Eigen::Index local);
  static void write_rows(const Contact& contact, const ContactVector& velocity,
                         Eigen::Ref<Eigen::VectorXd> rows);
  static void add_sparse_entries(const Contact& contact, Eigen::Index local, double amount,
                                 Eigen::Ref<Eigen::VectorXd> rows);

  // ColumnSource: the matrix of the working set's problem.
  [[nodiscard]] Eigen::Index size() const override { return size_; }
  void column(Eigen::Index j, Eigen::Ref<Eigen::VectorXd> out) const override;

  LcpStepData<Dim> data_;
  Candidates candidates_;
  std::span<Twist<Dim>> velocity_;
  double speed_ = 1.0;                     // V [m/s]
  std::vector<Contact> contacts_;          // the working set, ascending by candidate
  std::vector<int> contact_of_candidate_;  // kIdle: not in the working set
  std::vector<int> contact_of_row_;
  Eigen::Index size_ = 0;
  std::map<Eigen::Index, Workspace> workspaces_;  // by size
};

/// Tangents t (, o) of a contact whose law names the direction of t.
template <int Dim>
TangentBasis<Dim> contact_tangents(const Vector<Dim>& normal, const ContactLaw<Dim>& law);

}  // namespace touchstone
