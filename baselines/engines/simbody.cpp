#include "baselines/engines/engines.h"
#include "baselines/engines/simbody_world.h"
#include "baselines/engines/spatial_engine.h"

/// Simbody 3.7: spatial, double precision, two ways of contact: rigid unilateral constraints in a
/// semi-explicit Euler stepper, and compliant Hunt-Crossley forces under an integrator with error control.
/// Neither tells impulses.
namespace touchstone::engines {

namespace {

class SimbodyEngine final : public Engine<3> {
 public:
  explicit SimbodyEngine(std::unique_ptr<SimbodyWorld> world) : world_(std::move(world)) {}

  StepReport advance(double h) override { return {.iterations = world_->advance(h)}; }
  [[nodiscard]] BodyState<3> body(int index) const override { return world_->body(index); }
  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    return {world_->mass(index), world_->inertia(index)};
  }
  void read_contacts(std::vector<ContactImpulse<3>>&) const override {}

 private:
  std::unique_ptr<SimbodyWorld> world_;
};

std::unique_ptr<Engine<3>> load_rigid(const Scene<3>& scene, OptionReader& read, Motion motion) {
  SimbodyRigidSettings s{};
  s.iterations = read.integer("iterations", 1000, 1, 100000000);
  s.tolerance = read.number("tolerance", 1e-10, 1e-16, 1.0);
  s.proximity = read.number("proximity", 1e-6, 1e-12, 1.0);
  read.finish();
  return std::make_unique<SimbodyEngine>(make_simbody_world(scene, s, motion));
}

std::unique_ptr<Engine<3>> load_compliant(const Scene<3>& scene, OptionReader& read, Motion motion) {
  SimbodyCompliantSettings s{};
  s.stiffness = read.number("stiffness", 1e8, 1.0, 1e15);
  s.dissipation = read.number("dissipation", 10.0, 0.0, 1e6);
  s.transition_velocity = read.number("transition_velocity", 1e-3, 1e-12, 1e3);
  s.accuracy = read.number("accuracy", 1e-6, 1e-15, 0.1);
  read.finish();
  return std::make_unique<SimbodyEngine>(make_simbody_world(scene, s, motion));
}

std::string version() { return simbody_version(); }

constexpr Capabilities kRigidCapabilities{.contact_impulses = false, .restitution = true};
constexpr Capabilities kCompliantCapabilities{.contact_impulses = false};
constexpr SpatialEngine kCompliant{"simbody_hunt_crossley", kCompliantCapabilities, kDoublePrecision,
                                   &load_compliant};
constexpr SpatialEngine kRigid{"simbody_pgs", kRigidCapabilities, kDoublePrecision, &load_rigid};
constexpr const char* kCompliantText = "Simbody: Hunt-Crossley forces, Runge-Kutta-Merson with error control";
constexpr const char* kRigidText = "Simbody: rigid contacts, semi-explicit Euler, projected Gauss-Seidel";

constexpr MethodEntry<2> kPlanar[] = {
    {kCompliant.key, kCompliantText, &make_planar<kCompliant>, &version},
    {kRigid.key, kRigidText, &make_planar<kRigid>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kCompliant.key, kCompliantText, &make_spatial<kCompliant>, &version},
    {kRigid.key, kRigidText, &make_spatial<kRigid>, &version},
};

}  // namespace

Rows simbody_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
