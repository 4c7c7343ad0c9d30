#include "tests/support/mode_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "core/complementarity/residual.h"
#include "core/complementarity/semismooth_newton.h"

namespace touchstone {

namespace {

enum class Mode { open, stick, slip };

constexpr double kRoot = 1e-12;  ///< residual of a mode's equations at a solution

/// The equations of one mode: Eqs. 10-11 in the form of Fritz John with one side of each of a contact's
/// complementarities. Multipliers of faces keep theirs.
template <int Dim>
class ModeProblem final : public MixedComplementarityProblem {
 public:
  explicit ModeProblem(const StepProblem<Dim>& problem)
      : problem_(problem), mode_(problem.contacts().size()) {
    lower_ = problem.lower();
    upper_ = problem.upper();
    for (std::size_t i = 0; i < mode_.size(); ++i) {
      const ContactLayout& at = problem.layout().contact(i);
      lower_[at.normal] = lower_[at.slip] = -std::numeric_limits<double>::infinity();
    }
  }

  std::vector<Mode>& mode() { return mode_; }

  [[nodiscard]] Eigen::Index size() const override { return problem_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }

  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    problem_.evaluate(z, f, jacobian);
    const auto fix = [&](Eigen::Index unknown, double value) {
      f[unknown] = z[unknown] - value;
      if (jacobian == nullptr) return;
      jacobian->row(unknown).setZero();
      (*jacobian)(unknown, unknown) = 1;
    };
    for (std::size_t i = 0; i < mode_.size(); ++i) {
      const ContactLayout& at = problem_.layout().contact(i);
      const bool open = mode_[i] == Mode::open;
      if (open) fix(at.normal, 0.0);
      if (open || problem_.contacts()[i].law.mu == 0) {
        for (int k = 0; k < Dimension<Dim>::friction; ++k) fix(at.friction + k, 0.0);
        fix(at.slip, 1.0);
      } else if (mode_[i] == Mode::stick) {
        fix(at.slip, 0.0);
      }
    }
  }

 private:
  const StepProblem<Dim>& problem_;
  std::vector<Mode> mode_;
  Eigen::VectorXd lower_, upper_;
};

/// Velocities around that at the start and that of a free step, from near to far; points that belong to them;
/// impulses over six decades, friction in any direction.
template <int Dim, typename Random>
Eigen::VectorXd random_start(StepProblem<Dim>& problem, Random& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
  Eigen::VectorXd free = z;
  for (int b = 0; b < problem.moving_bodies(); ++b)
    z.template segment<Dimension<Dim>::velocity>(problem.layout().velocity(b)) = problem.start_velocity_of(b);
  problem.free_velocity(free);
  const Eigen::Index velocities = problem.layout().joints();
  const double part = unit(random);
  const double spread = problem.scale().velocity * std::pow(10.0, -4 * unit(random));
  for (Eigen::Index k = 0; k < velocities; ++k)
    z[k] = part * z[k] + (1 - part) * free[k] + spread * normal(random);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    const ContactLayout& at = problem.layout().contact(i);
    problem.find_points(i, z);
    z[at.normal] = std::pow(10.0, 6 * unit(random) - 4);
    FrictionVector<Dim> y;
    for (double& component : y) component = normal(random);
    z.template segment<Dimension<Dim>::friction>(at.friction) =
        y * (problem.contacts()[i].law.mu * z[at.normal] / y.norm());
    z[at.slip] = std::pow(10.0, -4 * unit(random));
  }
  return z;
}

/// Natural residual of the step's problem where a mode was solved: sigma = |w| is the projection form's own.
template <int Dim>
NaturalResidual violation(StepProblem<Dim>& problem, Eigen::VectorXd z) {
  problem.set_form(FrictionForm::projection);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) z[problem.layout().contact(i).slip] = 0;
  Eigen::VectorXd f(problem.size());
  problem.evaluate(z, f, nullptr);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    const Eigen::Index slip = problem.layout().contact(i).slip;
    z[slip] = -f[slip];
    f[slip] = 0;
  }
  NaturalResidual worst = natural_residual(problem.lower(), problem.upper(), z, f);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    if (problem.is_spurious(i))
      worst = {std::numeric_limits<double>::infinity(), problem.layout().contact(i).point_1};
  }
  problem.set_form(FrictionForm::fritz_john);
  return worst;
}

std::string in_words(const std::vector<Mode>& mode) {
  static constexpr std::array kWords = {"open", "stick", "slip"};
  std::string words;
  for (const Mode m : mode)
    words += (words.empty() ? "" : ", ") + std::string(kWords[static_cast<std::size_t>(m)]);
  return words;
}

/// Solves the equations of one mode after the other.
template <int Dim>
class Search {
 public:
  Search(StepProblem<Dim>& problem, const ModeSearchOptions& options)
      : problem_(problem),
        options_(options),
        equations_(problem),
        newton_(newton_options()),
        random_(options.seed) {}

  ModeReport run() {
    choose(0);
    return report_;
  }

 private:
  static SemismoothNewtonOptions newton_options() {
    SemismoothNewtonOptions options;
    // Friction rows are products with impulses of 1e-4 and less: solved as far as rounding allows.
    options.search.tolerance = 1e-16;
    options.search.max_iterations = 60;
    return options;
  }

  /// The modes of this contact and of those after it, given those before it.
  void choose(std::size_t contact) {
    if (contact == equations_.mode().size()) return try_mode();
    const bool held_open = contact < options_.held_open.size() && options_.held_open[contact];
    for (const Mode m : {Mode::open, Mode::stick, Mode::slip}) {
      if (m == Mode::slip && problem_.contacts()[contact].law.mu == 0) continue;
      if (m != Mode::open && held_open) continue;
      equations_.mode()[contact] = m;
      choose(contact + 1);
    }
  }

  void try_mode() {
    ++report_.modes;
    const int roots = report_.roots;
    for (const Eigen::VectorXd& start : options_.from) solve_from(start.head(problem_.size()));
    for (int k = 0; k < options_.starts; ++k) solve_from(random_start(problem_, random_));
    report_.solved_modes += report_.roots > roots ? 1 : 0;
  }

  void solve_from(Eigen::VectorXd z) {
    if (!(newton_.solve(equations_, z).residual <= kRoot)) return;
    ++report_.roots;
    const NaturalResidual missed = violation(problem_, z);
    if (!(missed.value < report_.least_violation)) return;
    report_.least_violation = missed.value;
    report_.best_mode = in_words(equations_.mode());
    report_.missed = problem_.row_name(missed.worst_row);
  }

  StepProblem<Dim>& problem_;
  const ModeSearchOptions& options_;
  ModeProblem<Dim> equations_;
  SemismoothNewton newton_;
  std::mt19937_64 random_;
  ModeReport report_;
};

}  // namespace

template <int Dim>
ModeReport search_modes(StepProblem<Dim>& problem, const ModeSearchOptions& options) {
  problem.set_form(FrictionForm::fritz_john);
  const ModeReport report = Search<Dim>(problem, options).run();
  problem.set_form(FrictionForm::projection);
  return report;
}

template ModeReport search_modes(StepProblem<2>&, const ModeSearchOptions&);
template ModeReport search_modes(StepProblem<3>&, const ModeSearchOptions&);

}  // namespace touchstone
