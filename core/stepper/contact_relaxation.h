#pragma once

#include <span>
#include <vector>

#include "core/stepper/accelerated_sweeps.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// Solves a step of many contacts by rounds: sweeps on frozen geometry (accelerated_sweeps.h), and the
/// geometry anew. No matrix is factorised, so that work and memory of a round go with the contacts.
///
/// A round works where the problem is not solved yet: on the bodies whose residual is near the largest, and
/// their neighbours; and its sweeps go on where impulses still change. Contacts are solved here in a few
/// sweeps and there, where they wedge, in thousands, which then cost what those few contacts cost.
///
/// Of problems without joints. Not every problem is solved: near rest, where impulses are not unique, rounds
/// may gain nothing any more.
template <int Dim>
class ContactRelaxation {
 public:
  /// @param tolerance  of the natural residual of the step's rows, sigma eliminated
  /// @param z  start on entry, in the projection form of friction; on return where the rounds ended
  /// @return  rounds
  int run(StepProblem<Dim>& problem, double tolerance, Eigen::VectorXd& z);
  /// Natural residual where the rounds ended.
  [[nodiscard]] double residual() const { return residual_; }

 private:
  struct Contact {
    std::array<int, 2> place{-1, -1};
    std::array<Twist<Dim>, 2> wrench{};  ///< in the momentum rows of its bodies
    double residual = 0.0;               ///< of its own rows
    bool loaded = false;
    /// psi / (h V) where it has no load: by how much more it could close, and stay open; else 0.
    double slack = 0.0;
    bool left = false;  ///< out of rounds, as its slack is large, and not evaluated since
  };
  struct Body {
    double residual = 0.0;  ///< of its momentum and of its contacts
    bool chosen = false;    ///< for this round
    bool swept = false;     ///< still, in this round
    bool judged = false;    ///< after it
  };

  /// How rounds go.
  struct Pace {
    int sweeps = 0;            ///< of the next round, at most
    double part = 1.0;         ///< of the next round's change that is taken; less where rounds go to and fro
    double reference = 0.0;    ///< residual of the last gain
    double effort = 0.0;       ///< rounds over all contacts so far
    double idle_effort = 0.0;  ///< of them since the last gain
    int idle = 0;              ///< rounds since the last gain
    int falls = 0;             ///< rounds in a row that brought the residual down
  };

  void bind(const StepProblem<Dim>& problem, Eigen::VectorXd& z);
  void take_up(StepProblem<Dim>& problem, Eigen::VectorXd& z);
  void relax(StepProblem<Dim>& problem, const Pace& pace, Eigen::VectorXd& z);
  void sweep(int limit, double tolerance);
  void narrow(double tolerance);
  void evaluate_anew(StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z);
  void clear(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) const;
  void evaluate(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z);
  void judge_all(const StepProblem<Dim>& problem, const Eigen::VectorXd& z);
  void judge(const StepProblem<Dim>& problem, std::size_t b, const Eigen::VectorXd& z);
  [[nodiscard]] Twist<Dim> momentum(const StepProblem<Dim>& problem, std::size_t b,
                                    const Eigen::VectorXd& z) const;
  void find_residual();
  void choose(double threshold);
  void spread(bool Body::*mark, std::vector<std::size_t>& bodies);
  /// Whether a body is marked; false of a fixed one.
  [[nodiscard]] bool has(bool Body::*mark, int place) const {
    return place >= 0 && bodies_[static_cast<std::size_t>(place)].*mark;
  }
  /// Whether all bodies of a contact that move are marked.
  [[nodiscard]] bool have(bool Body::*mark, const Contact& contact) const {
    return (contact.place[0] < 0 || has(mark, contact.place[0])) &&
           (contact.place[1] < 0 || has(mark, contact.place[1]));
  }
  [[nodiscard]] std::span<const std::size_t> contacts_of(std::size_t body) const {
    return {neighbours_.data() + first_[body], first_[body + 1] - first_[body]};
  }

  AcceleratedSweeps<Dim> sweeps_;
  ContactState<Dim> state_;  ///< of one contact after the other
  StepBlock<Dim> block_;
  std::vector<Contact> contacts_;
  std::vector<Body> bodies_;
  std::vector<std::size_t> first_, neighbours_;  ///< contacts of each body, body after body
  std::vector<std::size_t> chosen_;              ///< bodies of this round
  std::vector<std::size_t> swept_;    ///< contacts all of whose bodies are chosen; later, of those,
                                      ///< the ones near impulses that still change
  std::vector<std::size_t> written_;  ///< the former
  std::vector<std::size_t> moving_;   ///< bodies of those whose impulses still change
  std::vector<std::size_t> touched_;  ///< contacts of which a body is chosen
  std::vector<std::size_t> judged_;   ///< their bodies
  double residual_ = 0.0;
  Eigen::VectorXd start_;  ///< of the round
};

}  // namespace touchstone
