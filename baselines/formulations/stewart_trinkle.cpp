#include "baselines/formulations/stewart_trinkle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "baselines/approximation.h"
#include "baselines/formulations/candidate_selection.h"
#include "baselines/formulations/lcp_step.h"
#include "baselines/options.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

struct Settings {
  CandidatePolicy policy;
  PyramidOptions pyramid;
  int edges = 0;
  Options effective;
};

template <int Dim>
Settings read_settings(const Options& options) {
  OptionReader read("stewart_trinkle", options);
  Settings settings;
  settings.policy = read_candidate_policy(read);
  settings.pyramid = read_pyramid_options<Dim>(read);
  if constexpr (Dim == 2) {
    constexpr int kMostEdges = 10'000'000;
    settings.edges = read.integer("edges", 0, 0, kMostEdges);
    if (settings.edges == 1 || settings.edges == 2) {
      read.fail("edges", std::to_string(settings.edges), "0 (keep discs) or an integer >= 3");
    }
  }
  read.finish();
  settings.effective = read.effective();
  return settings;
}

/// The scene as the method simulates it.
template <int Dim>
Scene<Dim> prepared(Scene<Dim> scene, const Settings& settings) {
  scene.validate();
  if constexpr (Dim == 2) {
    if (settings.edges > 0) return with_polygons(std::move(scene), settings.edges);
  }
  return scene;
}

template <int Dim>
std::vector<ContactLaw<Dim>> pair_laws(const ContactGeometry<Dim>& geometry) {
  if (!geometry.scene().joints.empty())
    throw Unsupported("joints: this complementarity problem has contacts only");
  std::vector<ContactLaw<Dim>> laws;
  for (const auto& pair : geometry.pairs()) {
    laws.push_back(geometry.scene().law(pair.body_a, pair.body_b));
    if (laws.back().restitution > 0) {
      throw Unsupported(fmt::format("restitution {} of '{}' and '{}': impacts are plastic here",
                                    laws.back().restitution,
                                    geometry.scene().bodies[std::size_t(pair.body_a)].name,
                                    geometry.scene().bodies[std::size_t(pair.body_b)].name));
    }
  }
  return laws;
}

template <int Dim>
std::vector<FrictionPyramid<Dim>> friction_pyramids(const std::vector<ContactLaw<Dim>>& laws,
                                                    const PyramidOptions& options) {
  std::vector<FrictionPyramid<Dim>> pyramids;
  for (const auto& law : laws) pyramids.push_back(friction_pyramid(law, options));
  return pyramids;
}

template <int Dim>
std::vector<double> largest_friction(const std::vector<FrictionPyramid<Dim>>& pyramids) {
  std::vector<double> friction;
  for (const auto& pyramid : pyramids) friction.push_back(pyramid.largest_friction());
  return friction;
}

/// p_vp / h = -omega x (I omega), zero in the plane.
Angular<2> gyroscopic_moment(const Inertia<2>&, const Angular<2>&) { return Angular<2>::Zero(); }
Angular<3> gyroscopic_moment(const Inertia<3>& inertia, const Angular<3>& omega) {
  return -omega.cross(inertia * omega);
}

std::string_view failure(LinearPathStatus status) {
  switch (status) {
    case LinearPathStatus::ray:
      return "Lemke's method ended on a ray";
    case LinearPathStatus::pivot_limit:
      return "Lemke's method used up its pivots";
    case LinearPathStatus::singular_basis:
      return "Lemke's method met a singular basis";
    case LinearPathStatus::solved:
      break;
  }
  return "";
}

template <int Dim>
class StewartTrinkle final : public Method<Dim> {
 public:
  StewartTrinkle(const Scene<Dim>& scene, Settings settings)
      : settings_(std::move(settings)),
        scene_(prepared(scene, settings_)),
        geometry_(scene_),
        laws_(pair_laws(geometry_)),
        pyramids_(friction_pyramids(laws_, settings_.pyramid)),
        selection_(geometry_, settings_.policy, largest_friction(pyramids_)),
        state_(initial_state(scene_)),
        inverse_mass_(scene_.bodies.size()),
        free_(scene_.bodies.size(), Twist<Dim>::Zero()),
        next_(free_) {
    const auto most = static_cast<std::size_t>(geometry_.candidate_count());
    candidates_.reserve(most);
    contacts_.reserve(most);
    lcp_.reserve(static_cast<int>(most), pyramids_);
  }
  StewartTrinkle(const StewartTrinkle&) = delete;  // geometry_ refers to scene_
  StewartTrinkle& operator=(const StewartTrinkle&) = delete;

  [[nodiscard]] Capabilities capabilities() const override {
    Capabilities capabilities;
    capabilities.torsional_friction = Dim == 3;
    capabilities.anisotropic_friction = true;
    return capabilities;
  }
  [[nodiscard]] const Scene<Dim>& scene() const override { return scene_; }
  [[nodiscard]] std::span<const BodyState<Dim>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<Dim>> contacts() const override { return contacts_; }
  [[nodiscard]] Options effective_options() const override { return settings_.effective; }

  [[nodiscard]] StepReport step(double h) override {
    if (!(h > 0) || !std::isfinite(h)) throw InputError("step size h", h, "a finite number > 0 [s]");
    predict_free_velocities(h);
    selection_.select(state_, free_, h, candidates_);
    const bool known = std::all_of(candidates_.begin(), candidates_.end(),
                                   [](const auto& candidate) { return candidate.points.exact; });
    if (!known) return {StepStatus::not_converged, 0, 0.0, "closest points of two bodies were not found"};
    const auto solution = lcp_.solve(data(h), candidates_, next_);
    const StepReport report = judge(solution);
    if (report.status != StepStatus::solved) return report;
    advance(h);
    read_back(h);
    return report;
  }

 private:
  void predict_free_velocities(double h);
  [[nodiscard]] double fastest() const;
  [[nodiscard]] LcpStepData<Dim> data(double h) const {
    return {geometry_.pairs(), laws_, pyramids_, state_, inverse_mass_, free_, fastest(), h};
  }
  [[nodiscard]] StepReport judge(const typename LcpStep<Dim>::Report& solution) const;
  void advance(double h);
  void read_back(double h);
  [[nodiscard]] bool worth_reporting(const ContactImpulse<Dim>& contact, double gap, double h) const;

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  Settings settings_;
  Scene<Dim> scene_;
  ContactGeometry<Dim> geometry_;
  std::vector<ContactLaw<Dim>> laws_;           // by pair
  std::vector<FrictionPyramid<Dim>> pyramids_;  // by pair
  CandidateSelection<Dim> selection_;
  LcpStep<Dim> lcp_;

  std::vector<BodyState<Dim>> state_;
  std::vector<InverseMass<Dim>> inverse_mass_;  // at the start of the step
  std::vector<Twist<Dim>> free_;                // nu_f: nu' without contact
  std::vector<Twist<Dim>> next_;                // nu'
  std::vector<ContactCandidate<Dim>> candidates_;
  std::vector<ContactImpulse<Dim>> contacts_;
};

/// nu_f = nu + h M^-1 (m g + f, -omega x I omega): Eq. 4 without contact, M at the start of the step.
template <int Dim>
void StewartTrinkle<Dim>::predict_free_velocities(double h) {
  constexpr int kAngular = Dimension<Dim>::angular;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const Body<Dim>& body = scene_.bodies[i];
    if (body.fixed) continue;
    const Inertia<Dim> inertia = world_inertia(body.inertia, state_[i].pose.rotation);
    inverse_mass_[i] = {1 / body.mass, inertia.inverse()};
    const Angular<Dim> omega = state_[i].velocity.template tail<kAngular>();
    Twist<Dim> load;
    load.template head<Dim>() = body.mass * scene_.gravity + body.force;
    load.template tail<kAngular>() = gyroscopic_moment(inertia, omega);
    free_[i] = state_[i].velocity + h * inverse_mass_[i].apply(load);
  }
}

/// sqrt(nu_f^T M nu_f / m) of the fastest body [m/s]: the scale of the step's velocities.
template <int Dim>
double StewartTrinkle<Dim>::fastest() const {
  constexpr double kLeastSpeed = 1e-30;  // of a scene in which nothing moves; only to divide by
  double square = kLeastSpeed * kLeastSpeed;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const Body<Dim>& body = scene_.bodies[i];
    if (body.fixed) continue;
    const Angular<Dim> omega = free_[i].template tail<Dimension<Dim>::angular>();
    const Inertia<Dim> inertia = world_inertia(body.inertia, state_[i].pose.rotation);
    square = std::max(square,
                      free_[i].template head<Dim>().squaredNorm() + omega.dot(inertia * omega) / body.mass);
  }
  return std::sqrt(square);
}

template <int Dim>
StepReport StewartTrinkle<Dim>::judge(const typename LcpStep<Dim>::Report& solution) const {
  constexpr double kTolerance = 1e-8;  // far above rounding, far below any effect
  const auto report = [&](StepStatus status, std::string_view reason) {
    return StepReport{status, solution.pivots, solution.residual, reason};
  };
  if (solution.status != LinearPathStatus::solved) {
    return report(StepStatus::not_converged, failure(solution.status));
  }
  const bool finite =
      std::all_of(next_.begin(), next_.end(), [](const Twist<Dim>& nu) { return nu.allFinite(); });
  if (!finite) return report(StepStatus::non_finite, "the velocity is not finite");
  if (!(solution.residual <= kTolerance)) {
    return report(StepStatus::not_converged, "rounding spoilt the solution of the LCP");
  }
  return report(StepStatus::solved, {});
}

/// q' = q (+) h nu'.
template <int Dim>
void StewartTrinkle<Dim>::advance(double h) {
  for (std::size_t i = 0; i < state_.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    state_[i].velocity = next_[i];
    state_[i].pose = advanced(state_[i].pose, next_[i], h);
  }
}

/// The candidates that carried an impulse or are within reach, each where it is at the end of the step.
/// Normal and tangents are those of the start, along which the impulse acted.
template <int Dim>
void StewartTrinkle<Dim>::read_back(double h) {
  contacts_.clear();
  for (int i = 0; i < static_cast<int>(candidates_.size()); ++i) {
    const ContactCandidate<Dim>& candidate = candidates_[index(i)];
    const ContactPair& pair = geometry_.pairs()[index(candidate.pair)];
    const ContactPoints<Dim> end = geometry_.points(pair, candidate.vertex, state_);
    ContactImpulse<Dim> contact;
    contact.body_a = pair.body_a;
    contact.body_b = pair.body_b;
    contact.point_a = end.point_a;
    contact.point_b = end.point_b;
    contact.normal = candidate.points.normal;
    contact.normal_impulse = lcp_.impulse(i)[0];
    contact.friction_impulse = lcp_.impulse(i).template tail<Dimension<Dim>::friction>();
    if (!worth_reporting(contact, end.gap, h)) continue;
    contact.tangents = contact_tangents<Dim>(contact.normal, laws_[index(candidate.pair)]);
    contacts_.push_back(contact);
  }
}

/// With an impulse, or with a gap that another such step at the same velocities would close.
template <int Dim>
bool StewartTrinkle<Dim>::worth_reporting(const ContactImpulse<Dim>& contact, double gap, double h) const {
  if (contact.normal_impulse > 0) return true;
  const auto velocity_at = [&](int body, const Vector<Dim>& point) {
    const BodyState<Dim>& state = state_[index(body)];
    return point_velocity<Dim>(state.velocity, point - state.pose.position);
  };
  const Vector<Dim> approach =
      velocity_at(contact.body_b, contact.point_b) - velocity_at(contact.body_a, contact.point_a);
  return gap <= h * std::max(contact.normal.dot(approach), 0.0);
}

}  // namespace

template <int Dim>
std::unique_ptr<Method<Dim>> make_stewart_trinkle(const Scene<Dim>& scene, const Options& options) {
  if (!scene.joints.empty()) {
    throw Unsupported(
        fmt::format("stewart_trinkle: it has no joints, the scene has {}", scene.joints.size()));
  }
  return std::make_unique<StewartTrinkle<Dim>>(scene, read_settings<Dim>(options));
}

template std::unique_ptr<Method<2>> make_stewart_trinkle(const Scene<2>&, const Options&);
template std::unique_ptr<Method<3>> make_stewart_trinkle(const Scene<3>&, const Options&);

}  // namespace touchstone
