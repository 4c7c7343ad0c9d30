#include <algorithm>

#include "baselines/engines/bullet_float.h"
#include "baselines/engines/bullet_world.h"
#include "baselines/engines/engines.h"
#include "baselines/engines/spatial_engine.h"

/// Bullet 3.24: spatial, persistent manifolds, speculative contacts, four solvers in double precision and one
/// in single.
namespace touchstone::engines {

namespace {

using Solver = BulletSolver;

/// Bullet lets a contact act before the bodies touch, so that they do not overlap: psi + h psi' >= 0. But the
/// speed after an impact is then e |v| - psi / h, which is anything. Where a pair bounces, contacts therefore
/// act on touch, which is within rounding, and the overlap of the impact is removed without adding to the
/// speed.
constexpr double kSpeculative = 1e6;
constexpr double kTouching = 1e-6;
constexpr double kBulletsSplitImpulse = -0.04;

bool bounces(const Scene<3>& scene) {
  return scene.contact_law.restitution > 0 ||
         std::any_of(scene.pair_laws.begin(), scene.pair_laws.end(),
                     [](const auto& pair) { return pair.law.restitution > 0; });
}

BulletSettings read_settings(OptionReader& read, const Scene<3>& scene, Solver solver) {
  BulletSettings s{};
  s.solver = solver;
  s.iterations = read.integer("iterations", 50, 1, 100000);
  s.erp = read.number("erp", 0.2, 0.0, 1.0);
  s.restitution_threshold = read.number("restitution_threshold", 0.0, 0.0, 1e6);
  s.hull_margin = read.number("hull_margin", 0.0, 0.0, 1.0);
  const bool bounce = bounces(scene);
  s.contact_below = read.number("contact_below", bounce ? kTouching : kSpeculative, 0.0, kSpeculative);
  s.split_impulse_below = read.number("split_impulse_below", bounce ? 0.0 : kBulletsSplitImpulse, -1e6, 0.0);
  return s;
}

template <Solver solver>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const BulletSettings settings = read_settings(read, scene, solver);
  read.finish();
  return make_bullet_world(scene, settings, motion);
}

/// The same in single precision.
std::unique_ptr<Engine<3>> load_float(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const BulletSettings settings = read_settings(read, scene, Solver::sequential_impulse);
  read.finish();
  return make_bullet_float_world(scene, settings, motion);
}

std::string version() { return bullet_version(); }
std::string float_version() { return bullet_float_version(); }

constexpr Capabilities kIterative{.contact_impulses = true, .torsional_friction = true, .restitution = true};
constexpr Capabilities kMlcp{.contact_impulses = true, .torsional_friction = false, .restitution = true};
constexpr SpatialEngine kDantzig{"bullet_dantzig", kMlcp, kDoublePrecision, &load<Solver::dantzig>};
constexpr SpatialEngine kNncg{"bullet_nncg", kIterative, kDoublePrecision, &load<Solver::nncg>};
constexpr SpatialEngine kPgs{"bullet_pgs", kMlcp, kDoublePrecision, &load<Solver::pgs>};
constexpr SpatialEngine kFloat{"bullet_si_float", kIterative, kSinglePrecision, &load_float};
constexpr SpatialEngine kSi{"bullet_si", kIterative, kDoublePrecision, &load<Solver::sequential_impulse>};
constexpr const char* kDantzigText = "Bullet, double: mixed LCP by Dantzig's method, friction boxes";
constexpr const char* kNncgText = "Bullet, double: nonsmooth nonlinear conjugate gradients, friction boxes";
constexpr const char* kPgsText = "Bullet, double: mixed LCP by projected Gauss-Seidel, friction boxes";
constexpr const char* kFloatText = "Bullet, single precision: sequential impulses, friction boxes";
constexpr const char* kSiText = "Bullet, double: sequential impulses, friction boxes";

constexpr MethodEntry<2> kPlanar[] = {
    {kDantzig.key, kDantzigText, &make_planar<kDantzig>, &version},
    {kNncg.key, kNncgText, &make_planar<kNncg>, &version},
    {kPgs.key, kPgsText, &make_planar<kPgs>, &version},
    {kSi.key, kSiText, &make_planar<kSi>, &version},
    {kFloat.key, kFloatText, &make_planar<kFloat>, &float_version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kDantzig.key, kDantzigText, &make_spatial<kDantzig>, &version},
    {kNncg.key, kNncgText, &make_spatial<kNncg>, &version},
    {kPgs.key, kPgsText, &make_spatial<kPgs>, &version},
    {kSi.key, kSiText, &make_spatial<kSi>, &version},
    {kFloat.key, kFloatText, &make_spatial<kFloat>, &float_version},
};

}  // namespace

Rows bullet_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
