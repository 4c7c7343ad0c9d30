#include "experiments/scene_file/read_couplings.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace touchstone::scene_file {

namespace {

const Keys kLawKeys = {"mu", "e_t", "e_o", "e_r", "restitution", "tangent"};

/// The index of the body that `value` names.
template <int Dim>
int read_body_name(const Value& value, const Scene<Dim>& scene) {
  std::vector<std::string_view> names;
  for (const auto& body : scene.bodies) names.push_back(body.name);
  return static_cast<int>(value.choice(names));
}

/// Two bodies by name, at least one of which moves.
template <int Dim>
std::pair<int, int> read_two_bodies(const Table& table, const Scene<Dim>& scene) {
  const Value value = table.require("bodies", "the names of two bodies");
  const std::vector<Value> names = value.list();
  if (names.size() != 2) value.fail(fmt::format("{} entries", names.size()), "the names of two bodies");
  const std::pair bodies = {read_body_name(names[0], scene), read_body_name(names[1], scene)};
  if (bodies.first == bodies.second) names[1].fail("one body twice", "two different bodies");
  const auto is_fixed = [&](int body) { return scene.bodies[static_cast<std::size_t>(body)].fixed; };
  if (is_fixed(bodies.first) && is_fixed(bodies.second)) {
    value.fail("two fixed bodies", "at least one body that moves");
  }
  return bodies;
}

/// Replaces what the table gives of `law`. What the scene has to say against it is asked of a scene with this
/// law alone.
template <int Dim>
void read_law(const Value& value, const Table& table, ContactLaw<Dim>& law) {
  table.read("mu", law.mu);
  table.read("e_t", law.e_t);
  table.read("e_o", law.e_o);
  table.read("e_r", law.e_r);
  table.read("restitution", law.restitution);
  if (const auto tangent = table.find("tangent")) law.tangent = tangent->vector<Dim>();
  Scene<Dim> alone;
  alone.contact_law = law;
  alone.bodies.emplace_back();
  value.checked("friction", [&] { alone.validate(); });
}

constexpr std::array<std::string_view, 4> kJointTypes = {"ball", "fixed", "hinge", "slider"};
constexpr std::array<JointType, 4> kJointTypeValues = {JointType::ball, JointType::fixed, JointType::hinge,
                                                       JointType::slider};

/// A slider has an axis, and so has a hinge in space; in the plane it is square to the plane.
template <int Dim>
bool has_axis(JointType type) {
  return type == JointType::slider || (Dim == 3 && type == JointType::hinge);
}

}  // namespace

template <int Dim>
ContactLaw<Dim> read_friction(const Value& value) {
  const Table table = value.table(kLawKeys);
  ContactLaw<Dim> law;
  law.mu = table.require("mu", "a number >= 0").number();
  read_law(value, table, law);
  return law;
}

template <int Dim>
PairLaw<Dim> read_pair(const Value& value, const Scene<Dim>& scene) {
  Keys keys = kLawKeys;
  keys.emplace_back("bodies");
  const Table table = value.table(keys, " ");
  PairLaw<Dim> pair{0, 0, scene.contact_law};
  std::tie(pair.body_a, pair.body_b) = read_two_bodies(table, scene);
  for (const auto& other : scene.pair_laws) {
    if (std::minmax(other.body_a, other.body_b) == std::minmax(pair.body_a, pair.body_b)) {
      value.fail("two bodies that an earlier pair has too", "each pair of bodies once");
    }
  }
  read_law(value, table, pair.law);
  return pair;
}

template <int Dim>
Joint<Dim> read_joint(const Value& value, const Scene<Dim>& scene) {
  const Table table = value.table({"type", "bodies", "anchor", "axis"}, " ");
  Joint<Dim> joint;
  joint.type = kJointTypeValues[table.require("type", "ball, fixed, hinge, slider").choice(kJointTypes)];
  std::tie(joint.body_a, joint.body_b) = read_two_bodies(table, scene);
  joint.anchor =
      table.require("anchor", fmt::format("{} numbers [m], world frame", Dim)).template vector<Dim>();
  const auto axis = table.find("axis");
  if (has_axis<Dim>(joint.type)) {
    joint.axis = table.require("axis", "a unit vector, world frame").template unit_vector<Dim>();
  } else if (axis) {
    axis->fail("a value", "none, because this joint has no axis");
  }
  return joint;
}

template ContactLaw<2> read_friction(const Value&);
template ContactLaw<3> read_friction(const Value&);
template PairLaw<2> read_pair(const Value&, const Scene<2>&);
template PairLaw<3> read_pair(const Value&, const Scene<3>&);
template Joint<2> read_joint(const Value&, const Scene<2>&);
template Joint<3> read_joint(const Value&, const Scene<3>&);

}  // namespace touchstone::scene_file
