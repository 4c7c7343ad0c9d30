#include "baselines/engines/engines.h"
#include "baselines/engines/spatial_engine.h"
#include "core/model/errors.h"

/// An engine of one file, as small as they get: it moves bodies that touch nothing. It shows that adding an
/// engine takes its .cpp and its row, no more: given to CMake as -D TOUCHSTONE_EXTRA_ENGINES=<this file>.
namespace touchstone::engines {

namespace {

/// v' = v + h (g + f/m), omega' by Euler's equations at the start of the step, q' = q (+) h nu'.
class Ballistic final : public Engine<3> {
 public:
  explicit Ballistic(const Scene<3>& scene) : scene_(scene), state_(initial_state(scene)) {
    if (scene.bodies.size() > 1) throw Unsupported("ballistic: more than one body; it has no contacts");
  }

  StepReport advance(double h) override {
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto& body = scene_.bodies[i];
      if (body.fixed) continue;
      const Inertia<3> inertia = world_inertia(body.inertia, state_[i].pose.rotation);
      const Vector<3> omega = state_[i].velocity.tail<3>();
      state_[i].velocity.head<3>() += h * (scene_.gravity + body.force / body.mass);
      state_[i].velocity.tail<3>() -= h * inertia.inverse() * omega.cross(inertia * omega);
      state_[i].pose = advanced(state_[i].pose, state_[i].velocity, h);
    }
    return {};
  }
  [[nodiscard]] BodyState<3> body(int index) const override {
    return state_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const auto& body = scene_.bodies[static_cast<std::size_t>(index)];
    return {body.mass, body.inertia};
  }
  void read_contacts(std::vector<ContactImpulse<3>>&) const override {}

 private:
  const Scene<3> scene_;
  std::vector<BodyState<3>> state_;
};

std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion) {
  read.finish();
  return std::make_unique<Ballistic>(scene);
}

std::string version() { return "1"; }

constexpr SpatialEngine kEngine{"ballistic", {.contact_impulses = false}, kDoublePrecision, &load};
constexpr const char* kText = "Free flight, for tests";
constexpr MethodEntry<2> kPlanar[] = {{kEngine.key, kText, &make_planar<kEngine>, &version}};
constexpr MethodEntry<3> kSpatial[] = {{kEngine.key, kText, &make_spatial<kEngine>, &version}};

}  // namespace

Rows ballistic_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
