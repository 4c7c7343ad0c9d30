#include "baselines/engines/engine_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchstone::engines {

namespace {

/// @param scale  size of the quantity, so that the test is relative for large values and absolute for small
/// ones
void require_echo(double difference, double scale, double precision, const std::string& body,
                  const char* what) {
  if (difference <= precision * std::max(1.0, scale)) return;
  throw std::logic_error(fmt::format("echo of body '{}': the engine's {} differs from the scene's by {}",
                                     body, what, difference));
}

double angle_between(const PlanarRotation& a, const PlanarRotation& b) {
  return std::abs(a.angle() - b.angle());
}
double angle_between(const SpatialRotation& a, const SpatialRotation& b) {
  // Differences of matrices, because a quaternion and its negative are the same rotation.
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

template <int Dim>
bool is_finite(const std::vector<BodyState<Dim>>& state) {
  return std::all_of(state.begin(), state.end(),
                     [](const auto& s) { return s.pose.is_finite() && s.velocity.allFinite(); });
}

}  // namespace

template <int Dim>
EngineMethod<Dim>::EngineMethod(Scene<Dim> scene, Options effective, Capabilities capabilities,
                                double precision, std::unique_ptr<Engine<Dim>> engine)
    : scene_(std::move(scene)),
      effective_(std::move(effective)),
      capabilities_(capabilities),
      engine_(std::move(engine)),
      state_(scene_.bodies.size()),
      next_state_(scene_.bodies.size()) {
  read_state(state_);
  check_echo(precision);
}

template <int Dim>
void EngineMethod<Dim>::read_state(std::vector<BodyState<Dim>>& state) const {
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = engine_->body(static_cast<int>(i));
}

template <int Dim>
void EngineMethod<Dim>::check_echo(double precision) const {
  const auto expected = initial_state(scene_);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& body = scene_.bodies[i];
    const auto require = [&](double difference, double scale, const char* what) {
      require_echo(difference, scale, precision, body.name, what);
    };
    const auto& position = expected[i].pose.position;
    require((state_[i].pose.position - position).norm(), position.norm(), "position");
    require(angle_between(state_[i].pose.rotation, expected[i].pose.rotation), 1.0, "orientation");
    const auto& nu = expected[i].velocity;
    require((state_[i].velocity - nu).norm(), nu.norm(), "velocity");
    if (body.fixed) continue;
    const auto loaded = engine_->mass_properties(static_cast<int>(i));
    require(std::abs(loaded.mass - body.mass) / body.mass, 1.0, "mass");
    require((loaded.inertia - body.inertia).norm() / body.inertia.norm(), 1.0, "inertia");
  }
}

template <int Dim>
StepReport EngineMethod<Dim>::guarded_advance(double h) {
  try {
    return engine_->advance(h);
  } catch (const std::exception&) {
    return {.status = StepStatus::not_converged, .reason = "the engine threw an exception"};
  }
}

template <int Dim>
StepReport EngineMethod<Dim>::step(double h) {
  if (failure_.status != StepStatus::solved) return failure_;
  StepReport report = guarded_advance(h);
  if (report.status == StepStatus::solved) {
    read_state(next_state_);
    if (!is_finite(next_state_)) {
      report.status = StepStatus::non_finite;
      report.reason = "the engine's state is not finite";
    }
  }
  if (report.status != StepStatus::solved) {
    failure_ = report;
    return report;
  }
  std::swap(state_, next_state_);
  contacts_.clear();
  engine_->read_contacts(contacts_);
  return report;
}

template class EngineMethod<2>;
template class EngineMethod<3>;

}  // namespace touchstone::engines
