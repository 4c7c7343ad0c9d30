#include "experiments/scenarios/ball_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/harness/contact_view.h"

namespace touchstone {

namespace {

constexpr double kOnEllipsoid = 1e-6;  // relative
constexpr double kSlides = 1e-3;       // sigma by which alone a contact counts as sliding [m/s]
constexpr double kMoves = 1e-6;        // sigma from which friction must be on the ellipsoid [m/s]

bool inside_ellipsoid(const BallContactInstant& contact) {
  return contact.friction_norm < (1.0 - kOnEllipsoid) * contact.friction_limit;
}

BallContactInstant instant(const harness::ContactView& seen, double h) {
  BallContactInstant contact;
  contact.normal = seen.normal_impulse / h;
  contact.tangential = seen.tangential_impulse.norm() / h;
  contact.torsion = seen.torsional_impulse / h;
  contact.friction_norm = seen.friction_norm / h;
  contact.friction_limit = seen.friction_limit / h;
  contact.slip = seen.slip;
  contact.spin = seen.spin;
  contact.sigma = seen.sigma;
  const bool slides = !inside_ellipsoid(contact) || contact.sigma > kSlides;
  contact.mode = slides ? BallContactMode::sliding : BallContactMode::sticking;
  return contact;
}

std::string_view verb(BallContactMode mode) {
  switch (mode) {
    case BallContactMode::sticking:
      return "rolls";
    case BallContactMode::sliding:
      return "slides";
    case BallContactMode::apart:
      break;
  }
  return "separates";
}

/// The first steps' modes and what changed after them, for a reader; not more changes than one would read.
class Story {
 public:
  explicit Story(const std::array<BallContactMode, 2>& start)
      : text_(fmt::format("1 {}, 2 {}", verb(start[0]), verb(start[1]))) {}

  void tell(std::size_t contact, BallContactMode mode) {
    constexpr int kMost = 8;
    if (++changes_ <= kMost) text_ += fmt::format("; {} {}", contact + 1, verb(mode));
  }
  [[nodiscard]] std::string text() const {
    constexpr int kMost = 8;
    return changes_ <= kMost ? text_ : fmt::format("{}; and {} more changes", text_, changes_ - kMost);
  }

 private:
  std::string text_;
  int changes_ = 0;
};

/// The time of the first instant after the last one for which `holds`; none if that is the end, or if it
/// never holds.
template <class Holds>
std::optional<double> end_of(const BallHistory& history, std::size_t first, Holds&& holds) {
  std::optional<std::size_t> last;
  for (std::size_t k = first; k < history.size(); ++k) {
    if (holds(history[k])) last = k;
  }
  if (!last || *last + 1 >= history.size()) return std::nullopt;
  return history[*last + 1].t;
}

/// Index of the first instant with contacts; the length if there is none.
std::size_t first_step(const BallHistory& history) {
  const auto at = std::find_if(history.begin(), history.end(),
                               [](const BallInstant& instant) { return instant.contacts.has_value(); });
  return static_cast<std::size_t>(at - history.begin());
}

/// By how much the change of velocity in step k lies outside those of the steps beside it, component by
/// component, over the largest of the latter; none at the ends.
std::optional<double> jump(const BallHistory& history, std::size_t k) {
  if (k < 2 || k + 1 >= history.size()) return std::nullopt;
  const Twist<3> before = history[k - 1].velocity - history[k - 2].velocity;
  const Twist<3> change = history[k].velocity - history[k - 1].velocity;
  const Twist<3> after = history[k + 1].velocity - history[k].velocity;
  const Twist<3> above = change - before.cwiseMax(after);
  const Twist<3> below = before.cwiseMin(after) - change;
  const double largest = std::max(before.cwiseAbs().maxCoeff(), after.cwiseAbs().maxCoeff());
  return largest > 0.0 ? std::optional(std::max(0.0, above.cwiseMax(below).maxCoeff()) / largest)
                       : std::nullopt;
}

}  // namespace

BallHistory ball_history(const harness::CaseRun<3>& run, const Scene<3>& scene, double h) {
  const int ball = scene.body("ball");
  BallHistory history;
  for (const auto& step : run.kept) {
    BallInstant instant_{step.t_s, step.state[static_cast<std::size_t>(ball)].velocity, std::nullopt};
    if (!history.empty()) {
      instant_.contacts.emplace();
      for (std::size_t i = 0; i < 2; ++i) {
        const int support = scene.body(fmt::format("support {}", i + 1));
        const auto seen = harness::strongest_contact(scene, step.state, step.contacts, ball, support);
        if (seen) (*instant_.contacts)[i] = instant(*seen, h);
      }
    }
    history.push_back(instant_);
  }
  return history;
}

BallHistory ball_history(const truth::SphereOnSpheres& scene, const truth::SphereOnSpheresResult& result) {
  BallHistory history;
  for (const truth::SphereOnSpheresSample& sample : result.samples) {
    BallInstant instant;
    instant.t = sample.t;
    instant.velocity << sample.velocity, sample.omega;
    instant.contacts.emplace();
    for (std::size_t i = 0; i < 2; ++i) {
      const truth::BallContactSample& c = sample.contacts[i];
      if (c.mode == BallContactMode::apart) continue;
      (*instant.contacts)[i] = {c.mode,        c.normal,        c.friction.norm(),
                                c.torsion,     c.friction_norm, scene.mu * c.normal,
                                c.slip.norm(), c.spin,          c.sigma};
    }
    history.push_back(instant);
  }
  return history;
}

std::string_view to_string(BallContactMode mode) {
  switch (mode) {
    case BallContactMode::sticking:
      return "rolling";
    case BallContactMode::sliding:
      return "sliding";
    case BallContactMode::apart:
      break;
  }
  return "apart";
}

BallEvents ball_events(const BallHistory& history) {
  const std::size_t first = first_step(history);
  if (first == history.size()) return {};
  const auto mode = [&](std::size_t k, std::size_t i) { return (*history[k].contacts)[i].mode; };
  Story story({mode(first, 0), mode(first, 1)});
  for (std::size_t k = first + 1; k < history.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (mode(k, i) != mode(k - 1, i)) story.tell(i, mode(k, i));
    }
  }
  BallEvents events;
  events.story = story.text();
  for (std::size_t i = 0; i < 2; ++i) {
    events.slides[i] = end_of(history, first, [i](const BallInstant& instant) {
      return (*instant.contacts)[i].mode == BallContactMode::sticking;
    });
    events.separates[i] = end_of(history, first, [i](const BallInstant& instant) {
      return (*instant.contacts)[i].mode != BallContactMode::apart;
    });
  }
  return events;
}

BallEvents ball_events(const truth::SphereOnSpheresResult& result) {
  Story story(result.start_modes);
  BallEvents events;
  for (const truth::BallEvent& event : result.events) {
    const auto i = static_cast<std::size_t>(event.contact);
    const bool separates = event.kind == truth::BallEventKind::separates;
    (separates ? events.separates : events.slides)[i] = event.t;
    story.tell(i, separates ? BallContactMode::apart : BallContactMode::sliding);
  }
  events.story = story.text();
  return events;
}

BallLaws ball_laws(const BallHistory& history, double h) {
  BallLaws laws;
  for (std::size_t k = first_step(history); k < history.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) {
      const BallContactInstant& contact = (*history[k].contacts)[i];
      if (contact.mode != BallContactMode::apart) {
        if (inside_ellipsoid(contact)) laws.rolling_slip = std::max(laws.rolling_slip, contact.sigma);
        if (contact.sigma > kMoves) {
          laws.sliding_friction_gap = std::max(laws.sliding_friction_gap,
                                               h * std::abs(contact.friction_norm - contact.friction_limit));
        }
        continue;
      }
      const bool separates =
          history[k - 1].contacts && (*history[k - 1].contacts)[i].mode != BallContactMode::apart;
      if (!separates) continue;
      if (const auto found = jump(history, k)) {
        laws.separation_jump = std::max(laws.separation_jump.value_or(0.0), *found);
      }
    }
  }
  return laws;
}

}  // namespace touchstone
