#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>

#include <mutex>

#include "baselines/engines/engine_method.h"
#include "baselines/engines/engines.h"
#include "baselines/engines/laws.h"
#include "baselines/engines/planar_options.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/silence.h"

/// Chipmunk 7: planar, double precision, sequential impulses with warm starting, position correction apart.
/// A step moves positions first, then finds contacts, then changes velocities.
namespace touchstone::engines {

namespace {

constexpr const char* kKey = "chipmunk";

/// A half-space becomes a thick segment: its core is this far below the surface [m], so that polygons meet it
/// as shapes apart, where Chipmunk's distance is exact, and nothing falls through.
constexpr double kGroundThickness = 10.0;
constexpr double kGroundHalfLength = 1000.0;

struct Settings {
  int iterations;
  double slop;                ///< overlap that is left alone [m]; Chipmunk's 0.1 is meant for pixels
  double overlap_per_second;  ///< share of an overlap that is left after 1 s; Chipmunk's own default
};

Settings read_settings(OptionReader& read) {
  Settings s{};
  s.iterations = read.integer("iterations", 50, 1, 100000);
  s.slop = read.number("slop", 1e-5, 0.0, 1e3);
  s.overlap_per_second = read.number("overlap_per_second", std::pow(0.9, 60), 0.0, 1.0);
  return s;
}

cpVect to_chipmunk(const Vector<2>& v) { return cpv(v.x(), v.y()); }
Vector<2> from_chipmunk(cpVect v) { return {v.x, v.y}; }
int index_of(const cpBody* body) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(cpBodyGetUserData(body)));
}

struct FreeSpace {
  void operator()(cpSpace* space) const { cpSpaceFree(space); }
};
struct FreeBody {
  void operator()(cpBody* body) const { cpBodyFree(body); }
};
struct FreeShape {
  void operator()(cpShape* shape) const { cpShapeFree(shape); }
};

/// Debian's build prints two lines when the first space of a process is made.
cpSpace* new_space() {
  static std::once_flag first;
  std::call_once(first, [] {
    const SilencedStdout silence;
    cpSpaceFree(cpSpaceNew());
  });
  return cpSpaceNew();
}

class ChipmunkWorld final : public Engine<2> {
 public:
  ChipmunkWorld(const Scene<2>& scene, const Settings& settings)
      : scene_(scene), skin_(settings.slop / 4), space_(new_space()) {
    refuse_moving_half_spaces(kKey, scene_);
    cpSpaceSetGravity(space_.get(), to_chipmunk(scene_.gravity));
    cpSpaceSetIterations(space_.get(), settings.iterations);
    cpSpaceSetCollisionSlop(space_.get(), settings.slop);
    cpSpaceSetCollisionBias(space_.get(), settings.overlap_per_second);
    install_handlers();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i);
  }

  ~ChipmunkWorld() override {
    for (auto& shape : shapes_) cpSpaceRemoveShape(space_.get(), shape.get());
    for (auto& body : bodies_) cpSpaceRemoveBody(space_.get(), body.get());
  }

  StepReport advance(double h) override {
    contacts_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!scene_.bodies[i].fixed) cpBodySetForce(bodies_[i].get(), to_chipmunk(scene_.bodies[i].force));
    }
    cpSpaceStep(space_.get(), h);
    return {};
  }

  [[nodiscard]] BodyState<2> body(int index) const override {
    const cpBody* b = bodies_[static_cast<std::size_t>(index)].get();
    const Vector<2> v = from_chipmunk(cpBodyGetVelocity(b));
    return {{from_chipmunk(cpBodyGetPosition(b)), PlanarRotation(cpBodyGetAngle(b))},
            {v.x(), v.y(), cpBodyGetAngularVelocity(b)}};
  }

  [[nodiscard]] MassProperties<2> mass_properties(int index) const override {
    const cpBody* b = bodies_[static_cast<std::size_t>(index)].get();
    return {cpBodyGetMass(b), Inertia<2>(cpBodyGetMoment(b))};
  }

  void read_contacts(std::vector<ContactImpulse<2>>& contacts) const override { contacts = contacts_; }

 private:
  void install_handlers() {
    cpCollisionHandler* handler = cpSpaceAddDefaultCollisionHandler(space_.get());
    handler->userData = this;
    handler->preSolveFunc = [](cpArbiter* arbiter, cpSpace*, cpDataPointer self) -> cpBool {
      static_cast<const ChipmunkWorld*>(self)->set_law(arbiter);
      return cpTrue;
    };
    handler->postSolveFunc = [](cpArbiter* arbiter, cpSpace*, cpDataPointer self) {
      static_cast<ChipmunkWorld*>(self)->note_contacts(arbiter);
    };
  }

  void set_law(cpArbiter* arbiter) const {
    const auto& law = scene_.law(index_of(arbiter->body_a), index_of(arbiter->body_b));
    cpArbiterSetFriction(arbiter, law.mu * law.e_t);
    cpArbiterSetRestitution(arbiter, law.restitution);
  }

  /// Chipmunk's normal points from its a to its b, and its impulse acts on b. The impulses of single points
  /// are in its structures only; its functions give their sum.
  void note_contacts(const cpArbiter* arbiter) {
    const cpBody* a = arbiter->body_a;
    const cpBody* b = arbiter->body_b;
    for (int k = 0; k < arbiter->count; ++k) {
      const cpContact& c = arbiter->contacts[k];
      const Vector<2> normal = from_chipmunk(arbiter->n);
      const ContactPlace<2> place{index_of(b), index_of(a),
                                  from_chipmunk(cpvadd(b->p, c.r2)) + skin_ * normal,
                                  from_chipmunk(cpvadd(a->p, c.r1)) - skin_ * normal, normal};
      const cpVect impulse = cpvrotate(arbiter->n, cpv(c.jnAcc, c.jtAcc));
      contacts_.push_back(contact_impulse(scene_, place, from_chipmunk(impulse)));
    }
  }

  void add_body(std::size_t i) {
    const auto& body = scene_.bodies[i];
    cpBody* b = body.fixed ? cpBodyNewStatic() : cpBodyNew(body.mass, body.inertia(0, 0));
    bodies_.emplace_back(b);
    cpBodySetUserData(b, reinterpret_cast<void*>(static_cast<std::intptr_t>(i)));
    cpBodySetPosition(b, to_chipmunk(body.pose.position));
    cpBodySetAngle(b, body.pose.rotation.angle());
    if (!body.fixed) {
      cpBodySetVelocity(b, to_chipmunk(body.velocity.head<2>()));
      cpBodySetAngularVelocity(b, body.velocity[2]);
    }
    cpSpaceAddBody(space_.get(), b);
    shapes_.emplace_back(new_shape(body, b));
    cpSpaceAddShape(space_.get(), shapes_.back().get());
  }

  /// With a quarter of the slop around each shape, so that a pair that touches overlaps by half the slop: the
  /// contact is there in the first step and is not pushed.
  cpShape* new_shape(const Body<2>& body, cpBody* b) const {
    const Pose<2>& placement = body.shape.placement;
    if (const auto* disc = std::get_if<Sphere<2>>(&body.shape.geometry)) {
      return cpCircleShapeNew(b, disc->radius + skin_, to_chipmunk(placement.position));
    }
    if (const auto* half_space = std::get_if<HalfSpace<2>>(&body.shape.geometry)) {
      const Vector<2> normal = placement.rotation.matrix() * half_space->normal;
      const Vector<2> along(-normal.y(), normal.x());
      const double offset = half_space->offset + normal.dot(placement.position);
      const Vector<2> core = (offset - kGroundThickness) * normal;
      return cpSegmentShapeNew(b, to_chipmunk(core - kGroundHalfLength * along),
                               to_chipmunk(core + kGroundHalfLength * along), kGroundThickness + skin_);
    }
    std::vector<cpVect> vertices;
    for (const auto& v : polygon_vertices(body.shape)) vertices.push_back(to_chipmunk(v));
    if (vertices.empty()) refuse_shape(kKey, body, "Chipmunk has circles, segments and convex polygons");
    return cpPolyShapeNew(b, static_cast<int>(vertices.size()), vertices.data(), cpTransformIdentity, skin_);
  }

  const Scene<2> scene_;
  const double skin_;  ///< around each shape [m]
  std::unique_ptr<cpSpace, FreeSpace> space_;
  std::vector<std::unique_ptr<cpBody, FreeBody>> bodies_;
  std::vector<std::unique_ptr<cpShape, FreeShape>> shapes_;
  std::vector<ContactImpulse<2>> contacts_;
};

std::unique_ptr<Method<2>> make(const Scene<2>& given, const Options& options) {
  constexpr Capabilities capabilities{.contact_impulses = true, .restitution = true};
  refuse_unsupported(kKey, given, capabilities);
  OptionReader read(kKey, options);
  const Settings settings = read_settings(read);
  Scene<2> scene = with_edges_option(given, read);
  read.finish();
  auto world = std::make_unique<ChipmunkWorld>(scene, settings);
  return std::make_unique<EngineMethod<2>>(std::move(scene), read.effective(), capabilities, kDoublePrecision,
                                           std::move(world));
}

std::string version() { return cpVersionString; }

constexpr MethodEntry<2> kRows[] = {
    {kKey, "Chipmunk: sequential impulses, double precision", &make, &version},
};

}  // namespace

Rows chipmunk_rows() { return {kRows, {}}; }

}  // namespace touchstone::engines
