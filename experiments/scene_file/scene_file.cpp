#include "experiments/scene_file/scene_file.h"

#include <fmt/format.h>

#include <set>

#include "experiments/harness/files.h"
#include "experiments/scene_file/overlaps.h"
#include "experiments/scene_file/read_body.h"
#include "experiments/scene_file/read_couplings.h"

namespace touchstone::scene_file {

namespace {

const Keys kSceneKeys = {"dimension", "gravity", "friction", "body", "pair", "joint"};

/// The tables of a list, [[body]] say, called "body 1", "body 2" and so on.
std::vector<Value> entries(const std::optional<Value>& list) {
  std::vector<Value> named;
  if (!list) return named;
  for (const Value& entry : list->list()) {
    named.push_back(entry.named(fmt::format("{} {}", list->name(), named.size() + 1)));
  }
  return named;
}

template <int Dim>
void read_bodies(const std::vector<Value>& entries, Scene<Dim>& scene) {
  std::set<std::string> names;
  for (const Value& entry : entries) {
    Body<Dim> body = read_body<Dim>(entry);
    if (!names.insert(body.name).second) {
      entry.fail_at(" name", "'" + body.name + "' twice", "a different name for each body");
    }
    scene.bodies.push_back(std::move(body));
  }
}

/// Said of the position of the body that moves, of the later one if both do.
template <int Dim>
void refuse_overlap(const std::vector<Value>& bodies, const Scene<Dim>& scene) {
  const auto overlap = find_overlap(scene);
  if (!overlap) return;
  const auto a = static_cast<std::size_t>(overlap->body_a);
  const auto b = static_cast<std::size_t>(overlap->body_b);
  const auto [moved, other] = scene.bodies[b].fixed ? std::pair(a, b) : std::pair(b, a);
  const Value body = bodies[moved].named(fmt::format("body '{}'", scene.bodies[moved].name));
  body.fail_at(" position",
               fmt::format("an overlap of {} m with '{}'", overlap->depth, scene.bodies[other].name),
               fmt::format("at most {} m at the start, 1e-9 of the smaller body", overlap->allowed));
}

template <int Dim>
Scene<Dim> read_scene_of(const Table& root) {
  Scene<Dim> scene;
  scene.gravity = root.require("gravity", fmt::format("{} numbers [m/s^2]", Dim)).template vector<Dim>();
  if (const auto friction = root.find("friction")) scene.contact_law = read_friction<Dim>(*friction);
  const Value body = root.require("body", "at least one [[body]]");
  const std::vector<Value> bodies = entries(body);
  if (bodies.empty()) body.fail("none", "at least one [[body]]");
  read_bodies(bodies, scene);
  for (const Value& pair : entries(root.find("pair"))) scene.pair_laws.push_back(read_pair(pair, scene));
  for (const Value& joint : entries(root.find("joint"))) scene.joints.push_back(read_joint(joint, scene));
  // All of it has been asked of the parts, where the place in the file is known.
  scene.validate();
  refuse_overlap(bodies, scene);
  return scene;
}

toml::table parse(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw LocatedError(fmt::format("{}:{}:{}", file, at.line, at.column), std::string(error.description()),
                       "TOML 1.0");
  }
}

}  // namespace

AnyScene parse_scene(std::string_view text, const std::string& file) {
  const toml::table document = parse(text, file);
  const Table root(document, "", "", file, kSceneKeys);
  const Value dimension = root.require("dimension", "2 or 3");
  switch (dimension.integer()) {
    case 2:
      return read_scene_of<2>(root);
    case 3:
      return read_scene_of<3>(root);
    default:
      dimension.fail(std::to_string(dimension.integer()), "2 or 3");
  }
}

AnyScene read_scene(const std::filesystem::path& file) {
  return parse_scene(harness::read_file(file), file.string());
}

}  // namespace touchstone::scene_file
