#include "tools/touchstone/listing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "baselines/registry.h"
#include "core/model/errors.h"
#include "experiments/scenarios/table.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::program {

namespace {

using Line = std::vector<std::string>;

/// Columns as wide as their widest cell; the last is not padded. All lines have as many cells as the first.
std::string align(const std::vector<Line>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const Line& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) text += fmt::format("{:<{}}  ", line[i], widths[i]);
    text += line.back() + "\n";
  }
  return text;
}

/// What both tables of methods say of one key.
struct MethodFacts {
  std::vector<std::string> dimensions;
  std::string version;
  std::string description;
  std::optional<Capabilities> capabilities;  ///< in space if the method goes there
};

/// A ball at rest above a plane, which every method can represent: it must be loaded to tell what it can do.
template <int Dim>
Scene<Dim> probe_scene() {
  Scene<Dim> scene;
  Body<Dim> ball{.name = "ball"};
  ball.pose.position[Dim - 1] = 2;
  Body<Dim> ground{.name = "ground", .fixed = true};
  ground.shape.geometry = HalfSpace<Dim>{};
  scene.bodies = {ball, ground};
  return scene;
}

template <int Dim>
void collect(std::map<std::string, MethodFacts, std::less<>>& facts) {
  for (const MethodEntry<Dim>& entry : methods<Dim>()) {
    MethodFacts& method = facts[std::string(entry.key)];
    method.dimensions.push_back(std::to_string(Dim));
    method.version = entry.version();
    method.description = entry.description;
    try {
      method.capabilities = entry.make(probe_scene<Dim>(), {})->capabilities();
    } catch (const Unsupported&) {
      method.capabilities.reset();
    }
  }
}

std::string list_capabilities(const std::optional<Capabilities>& capabilities) {
  if (!capabilities) return "unknown";
  const std::pair<bool, std::string_view> all[] = {{capabilities->contact_impulses, "impulses"},
                                                   {capabilities->torsional_friction, "torsion"},
                                                   {capabilities->anisotropic_friction, "anisotropy"},
                                                   {capabilities->restitution, "restitution"},
                                                   {capabilities->joints, "joints"},
                                                   {!capabilities->one_run, "several-runs"}};
  std::vector<std::string_view> names;
  for (const auto& [has, name] : all) {
    if (has) names.push_back(name);
  }
  return names.empty() ? "-" : fmt::format("{}", fmt::join(names, ","));
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

template <int Dim>
std::string describe(const Scene<Dim>& scene) {
  const auto moving = static_cast<std::size_t>(
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const auto& b) { return !b.fixed; }));
  return fmt::format("{} dimensions, {} of which {}, {}, {}", Dim,
                     counted(scene.bodies.size(), "body", "bodies"), counted(moving, "moves", "move"),
                     counted(scene.pair_laws.size(), "pair law", "pair laws"),
                     counted(scene.joints.size(), "joint", "joints"));
}

}  // namespace

std::string list_methods() {
  std::map<std::string, MethodFacts, std::less<>> facts;
  collect<2>(facts);
  collect<3>(facts);
  std::vector<Line> lines = {{"key", "dimensions", "version", "capabilities", "description"}};
  for (const auto& [key, method] : facts) {
    lines.push_back({key, fmt::format("{}", fmt::join(method.dimensions, ",")),
                     method.version.empty() ? "-" : method.version, list_capabilities(method.capabilities),
                     method.description});
  }
  return align(lines);
}

std::string list_scenarios() {
  std::vector<Line> lines = {{"key", "question"}};
  for (const ScenarioEntry& entry : scenarios()) {
    lines.push_back({std::string(entry.key), std::string(entry.question)});
  }
  return align(lines);
}

std::string describe_scene(const std::filesystem::path& file) {
  const scene_file::AnyScene scene = scene_file::read_scene(file);
  const std::string about = std::visit([](const auto& any) { return describe(any); }, scene);
  return fmt::format("{}: sound: {}\n", file.string(), about);
}

}  // namespace touchstone::program
