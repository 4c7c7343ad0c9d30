#include <box2d/box2d.h>
#include <fmt/format.h>

#include <cmath>

#include "baselines/engines/engine_method.h"
#include "baselines/engines/engines.h"
#include "baselines/engines/laws.h"
#include "baselines/engines/planar_options.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"

/// Box2D 2.4: planar, single precision, sequential impulses with warm starting, position correction apart.
namespace touchstone::engines {

namespace {

constexpr const char* kKey = "box2d";

/// A half-space becomes a rectangle of this size [m]: large beside any scene, small enough for single
/// precision.
constexpr float kGroundHalfLength = 500.0F;
constexpr float kGroundHalfDepth = 10.0F;

/// Box2D leaves contacts alone whose separation, skins included, is in [-slop, 0]. Each shape gets a quarter
/// of the slop as its skin, so that a pair that touches (psi = 0) stands in the middle of that band: it is in
/// contact in the first step and is not pushed. The friction's lever arm, to the middle of the overlap, is
/// then exact too.
constexpr float kSkin = b2_linearSlop / 4;

struct Settings {
  int velocity_iterations;
  int position_iterations;
  bool warm_starting;
  bool continuous;
  float restitution_threshold;  ///< approach speed below which nothing bounces [m/s]
  bool centred_skin;            ///< kSkin as above; if not, Box2D's own skins around the scene's exact shapes
};

Settings read_settings(OptionReader& read) {
  Settings s{};
  s.velocity_iterations = read.integer("velocity_iterations", 8, 1, 100000);
  s.position_iterations = read.integer("position_iterations", 3, 0, 100000);
  s.warm_starting = read.flag("warm_starting", true);
  s.continuous = read.flag("continuous", true);
  s.restitution_threshold = static_cast<float>(read.number("restitution_threshold", 0.0, 0.0, 1e6));
  s.centred_skin = read.choice("skin", "centred", {"centred", "engine"}) == "centred";
  return s;
}

b2Vec2 to_box2d(const Vector<2>& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }
Vector<2> from_box2d(const b2Vec2& v) { return {v.x, v.y}; }
int index_of(b2Body* body) { return static_cast<int>(body->GetUserData().pointer); }

/// Sets each pair's own law before it is solved, and keeps what acted after.
class Listener final : public b2ContactListener {
 public:
  Listener(const Scene<2>& scene, const Settings& settings) : scene_(scene), settings_(settings) {}

  void PreSolve(b2Contact* contact, const b2Manifold*) override {
    const auto& law =
        scene_.law(index_of(contact->GetFixtureA()->GetBody()), index_of(contact->GetFixtureB()->GetBody()));
    contact->SetFriction(static_cast<float>(law.mu * law.e_t));
    contact->SetRestitution(static_cast<float>(law.restitution));
    contact->SetRestitutionThreshold(settings_.restitution_threshold);
  }

  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override {
    b2WorldManifold manifold;
    contact->GetWorldManifold(&manifold);
    const b2Vec2 tangent = b2Cross(manifold.normal, 1.0F);
    const double skin = settings_.centred_skin ? kSkin : 0.0;
    for (int i = 0; i < impulse->count; ++i) {
      // Box2D's normal points from its A to its B, and its impulse acts on B.
      const Vector<2> normal = from_box2d(manifold.normal).normalized();
      const Vector<2> middle = from_box2d(manifold.points[i]);
      const double gap = manifold.separations[i] + 2 * skin;
      const ContactPlace<2> place{index_of(contact->GetFixtureB()->GetBody()),
                                  index_of(contact->GetFixtureA()->GetBody()), middle + gap / 2 * normal,
                                  middle - gap / 2 * normal, normal};
      const b2Vec2 p = impulse->normalImpulses[i] * manifold.normal + impulse->tangentImpulses[i] * tangent;
      contacts.push_back(contact_impulse(scene_, place, from_box2d(p)));
    }
  }

  std::vector<ContactImpulse<2>> contacts;

 private:
  const Scene<2>& scene_;
  const Settings& settings_;
};

class Box2dWorld final : public Engine<2> {
 public:
  Box2dWorld(const Scene<2>& scene, const Settings& settings)
      : scene_(scene), settings_(settings), listener_(scene_, settings_), world_(to_box2d(scene.gravity)) {
    refuse_moving_half_spaces(kKey, scene_);
    world_.SetContactListener(&listener_);
    world_.SetAllowSleeping(false);
    world_.SetWarmStarting(settings_.warm_starting);
    world_.SetContinuousPhysics(settings_.continuous);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i);
  }

  StepReport advance(double h) override {
    listener_.contacts.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i]->ApplyForceToCenter(to_box2d(scene_.bodies[i].force), true);
    }
    world_.Step(static_cast<float>(h), settings_.velocity_iterations, settings_.position_iterations);
    return {};
  }

  [[nodiscard]] BodyState<2> body(int index) const override {
    const b2Body& b = *bodies_[static_cast<std::size_t>(index)];
    const Vector<2> v = from_box2d(b.GetLinearVelocity());
    return {{from_box2d(b.GetWorldCenter()), PlanarRotation(b.GetAngle())},
            {v.x(), v.y(), b.GetAngularVelocity()}};
  }

  [[nodiscard]] MassProperties<2> mass_properties(int index) const override {
    const b2Body& b = *bodies_[static_cast<std::size_t>(index)];
    return {b.GetMass(), Inertia<2>(b.GetInertia())};
  }

  void read_contacts(std::vector<ContactImpulse<2>>& contacts) const override {
    contacts = listener_.contacts;
  }

 private:
  void add_body(std::size_t i) {
    const auto& body = scene_.bodies[i];
    b2BodyDef def;
    def.type = body.fixed ? b2_staticBody : b2_dynamicBody;
    def.position = to_box2d(body.pose.position);
    def.angle = static_cast<float>(body.pose.rotation.angle());
    def.allowSleep = false;
    def.userData.pointer = i;
    if (!body.fixed) {
      def.linearVelocity = to_box2d(body.velocity.head<2>());
      def.angularVelocity = static_cast<float>(body.velocity[2]);
    }
    bodies_.push_back(world_.CreateBody(&def));
    add_shape(body);
    if (body.fixed) return;
    b2MassData mass;  // its vector's constructor leaves it unset, so every field is set here
    mass.center.SetZero();
    mass.mass = static_cast<float>(body.mass);
    mass.I = static_cast<float>(body.inertia(0, 0));
    bodies_.back()->SetMassData(&mass);
  }

  void add_shape(const Body<2>& body) {
    if (const auto* disc = std::get_if<Sphere<2>>(&body.shape.geometry)) {
      b2CircleShape circle;
      circle.m_p = to_box2d(body.shape.placement.position);
      circle.m_radius = static_cast<float>(disc->radius) + (settings_.centred_skin ? kSkin : 0.0F);
      bodies_.back()->CreateFixture(&circle, 0.0F);
    } else if (const auto* half_space = std::get_if<HalfSpace<2>>(&body.shape.geometry)) {
      add_half_space(body, *half_space);
    } else if (const auto vertices = polygon_vertices(body.shape); !vertices.empty()) {
      add_polygon(body, vertices);
    } else {
      refuse_shape(kKey, body, "Box2D has circles and convex polygons");
    }
  }

  /// A rectangle with Box2D's own skin, which continuous collision needs, sunk so that the skin's surface
  /// stands kSkin above the half-space's.
  void add_half_space(const Body<2>& body, const HalfSpace<2>& half_space) {
    const Vector<2> normal = body.shape.placement.rotation.matrix() * half_space.normal;
    const double offset = half_space.offset + normal.dot(body.shape.placement.position);
    const float sunk = settings_.centred_skin ? b2_polygonRadius - kSkin : 0.0F;
    const Vector<2> centre = (offset - static_cast<double>(sunk + kGroundHalfDepth)) * normal;
    b2PolygonShape rectangle;
    rectangle.SetAsBox(kGroundHalfLength, kGroundHalfDepth, to_box2d(centre),
                       static_cast<float>(std::atan2(-normal.x(), normal.y())));
    bodies_.back()->CreateFixture(&rectangle, 0.0F);
  }

  /// As users build polygons of more corners than Box2D allows: a fan of pieces around the middle.
  void add_polygon(const Body<2>& body, const std::vector<Vector<2>>& vertices) {
    refuse_short_edges(body, vertices);
    if (vertices.size() <= b2_maxPolygonVertices) {
      add_piece(vertices);
      return;
    }
    Vector<2> middle = Vector<2>::Zero();
    for (const auto& v : vertices) middle += v / static_cast<double>(vertices.size());
    constexpr std::size_t kEdgesPerPiece = b2_maxPolygonVertices - 2;
    for (std::size_t first = 0; first < vertices.size(); first += kEdgesPerPiece) {
      std::vector<Vector<2>> piece{middle};
      for (std::size_t k = first; k <= std::min(first + kEdgesPerPiece, vertices.size()); ++k) {
        piece.push_back(vertices[k % vertices.size()]);
      }
      add_piece(piece);
    }
  }

  void add_piece(const std::vector<Vector<2>>& vertices) {
    b2Vec2 points[b2_maxPolygonVertices];
    for (std::size_t k = 0; k < vertices.size(); ++k) points[k] = to_box2d(vertices[k]);
    b2PolygonShape piece;
    piece.Set(points, static_cast<int>(vertices.size()));
    if (settings_.centred_skin) piece.m_radius = kSkin;
    bodies_.back()->CreateFixture(&piece, 0.0F);
  }

  static void refuse_short_edges(const Body<2>& body, const std::vector<Vector<2>>& vertices) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const double length = (vertices[(k + 1) % vertices.size()] - vertices[k]).norm();
      constexpr double kWeld = 0.5 * static_cast<double>(b2_linearSlop);
      if (length > kWeld) continue;
      refuse_shape(kKey, body,
                   fmt::format("Box2D welds corners nearer than {} m, an edge has {} m", kWeld, length));
    }
  }

  const Scene<2> scene_;
  const Settings settings_;
  Listener listener_;
  b2World world_;
  std::vector<b2Body*> bodies_;
};

std::unique_ptr<Method<2>> make(const Scene<2>& given, const Options& options) {
  constexpr Capabilities capabilities{.contact_impulses = true, .restitution = true};
  refuse_unsupported(kKey, given, capabilities);
  OptionReader read(kKey, options);
  const Settings settings = read_settings(read);
  Scene<2> scene = with_edges_option(given, read);
  read.finish();
  auto world = std::make_unique<Box2dWorld>(scene, settings);
  return std::make_unique<EngineMethod<2>>(std::move(scene), read.effective(), capabilities, kSinglePrecision,
                                           std::move(world));
}

std::string version() {
  return fmt::format("{}.{}.{}", b2_version.major, b2_version.minor, b2_version.revision);
}

constexpr MethodEntry<2> kRows[] = {
    {kKey, "Box2D: sequential impulses, single precision", &make, &version},
};

}  // namespace

Rows box2d_rows() { return {kRows, {}}; }

}  // namespace touchstone::engines
