#include "core/complementarity/ratio_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

using Eigen::Index;
using Kind = PathVariable::Kind;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Keys of tied variables are sums of a few products of numbers of order one.
constexpr double equal_keys = 1e-10;

}  // namespace

void RatioTest::begin(const ComplementaryBasis& basis) {
  const Index n = basis.size();
  start_.clear();
  for (Index i = 0; i < n; ++i) {
    const PathVariable slack{Kind::slack, i};
    const PathVariable unknown{Kind::unknown, i};
    const SlackDomain domain = basis.slack_domain(i);
    // The slack of a dependent row is held at zero, and that of a fixed unknown never stops anything.
    const bool perturb = domain == SlackDomain::nonnegative || domain == SlackDomain::nonpositive;
    if (basis.slack_is_basic(i) && perturb)
      start_.push_back({slack, domain == SlackDomain::nonnegative ? 1.0 : -1.0});
    if (basis.is_basic(unknown))
      start_.push_back({unknown, basis.unknowns()[i] >= basis.upper()[i] ? -1.0 : 1.0});
  }
}

RatioTest::Leaving RatioTest::choose(ComplementaryBasis& basis, PathVariable entering) {
  collect(basis, entering);
  keep_nearest();
  Leaving leaving;
  if (candidates_.empty()) return leaving;
  const auto parameter = std::find_if(candidates_.begin(), candidates_.end(), [](const Candidate& candidate) {
    return candidate.variable.kind == Kind::parameter;
  });
  if (parameter != candidates_.end()) {
    candidates_.front() = *parameter;
  } else if (candidates_.size() > 1) {
    break_tie(basis);
  }
  const Candidate& chosen = candidates_.front();
  leaving.variable = chosen.variable;
  leaving.step = std::max(chosen.distance, 0.0) / std::abs(chosen.rate);
  leaving.unblocked = false;
  leaving.at_upper = chosen.rate > 0.0;
  return leaving;
}

void RatioTest::collect(const ComplementaryBasis& basis, PathVariable entering) {
  candidates_.clear();
  const Eigen::VectorXd& rates = basis.unknown_rates();
  const double largest =
      std::max({rates.lpNorm<Eigen::Infinity>(), basis.slack_rates().lpNorm<Eigen::Infinity>(),
                std::abs(basis.parameter_rate())});
  smallest_rate_ = pivot_tolerance_ * std::max(1.0, largest);
  const auto add_structural = [&](Index j) {
    if (j == basis.size()) {
      add({Kind::parameter, 0}, basis.parameter(), basis.parameter_rate(), 0.0, infinity);
    } else {
      add({Kind::unknown, j}, basis.unknowns()[j], rates[j], basis.lower()[j], basis.upper()[j]);
    }
  };
  for (const Index j : basis.basic_columns()) add_structural(j);
  if (entering.kind != Kind::slack)
    add_structural(entering.kind == Kind::parameter ? basis.size() : entering.index);
  for (Index i = 0; i < basis.size(); ++i) {
    if (basis.slack_rates()[i] != 0.0 && basis.slack_is_basic(i)) add_slack(basis, i);
  }
}

void RatioTest::add_slack(const ComplementaryBasis& basis, Index i) {
  const PathVariable slack{Kind::slack, i};
  const double value = basis.slacks()[i];
  const double rate = basis.slack_rates()[i];
  switch (basis.slack_domain(i)) {
    case SlackDomain::nonnegative:
      return add(slack, value, rate, 0.0, infinity);
    case SlackDomain::nonpositive:
      return add(slack, value, rate, -infinity, 0.0);
    case SlackDomain::zero:
      return add(slack, 0.0, rate, 0.0, 0.0);
    case SlackDomain::any:
      return;
  }
}

void RatioTest::add(PathVariable variable, double value, double rate, double lower, double upper) {
  if (std::abs(rate) <= smallest_rate_) return;
  const double distance = rate < 0.0 ? value - lower : upper - value;
  if (distance < infinity) candidates_.push_back({variable, distance, rate, 0.0});
}

// Two passes as in Harris's test: the step that everyone allows if bounds may be missed by the tie tolerance,
// then all that stop within it.
void RatioTest::keep_nearest() {
  double allowed = infinity;
  for (const Candidate& candidate : candidates_) {
    allowed =
        std::min(allowed, (std::max(candidate.distance, 0.0) + tie_tolerance_) / std::abs(candidate.rate));
  }
  std::erase_if(candidates_, [allowed](const Candidate& candidate) {
    return std::max(candidate.distance, 0.0) / std::abs(candidate.rate) > allowed;
  });
}

// With the start variables p moved by sign_p eps^p, a tied variable i is moved by
//   pert_i = sum_p T_ip sign_p eps^p,   T_ip = 1 if i is p, else minus the rate of i in p if p is nonbasic,
// and stops the move after theta - pert_i / rate_i. The least in lexicographic order leaves.
void RatioTest::break_tie(ComplementaryBasis& basis) {
  ++ties_broken_;
  for (const Perturbed& start : start_) {
    if (candidates_.size() == 1) return;
    const bool basic = basis.is_basic(start.variable);
    if (!basic && !basis.probe(start.variable)) break;
    for (Candidate& candidate : candidates_) {
      double perturbation = 0.0;
      if (basic) {
        perturbation = candidate.variable == start.variable ? start.sign : 0.0;
      } else if (basis.is_basic(candidate.variable)) {
        perturbation = -start.sign * basis.probed_rate(candidate.variable);
      }
      candidate.key = -perturbation / candidate.rate;
    }
    keep_smallest_keys();
  }
}

void RatioTest::keep_smallest_keys() {
  double smallest = infinity;
  for (const Candidate& candidate : candidates_) smallest = std::min(smallest, candidate.key);
  const double allowed = smallest + equal_keys * std::max(1.0, std::abs(smallest));
  std::erase_if(candidates_, [allowed](const Candidate& candidate) { return candidate.key > allowed; });
}

}  // namespace touchstone
