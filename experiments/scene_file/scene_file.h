#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "core/model/scene.h"

/// Scene files: a scene as TOML, SI units. experiments/scenes/ has examples that explain the format.
namespace touchstone::scene_file {

using AnyScene = std::variant<Scene<2>, Scene<3>>;

/// The scene of a file, complete and sensible: whatever Scene::validate() asks, every key known, every
/// intersection with an inside, and no two bodies that may collide deeper in each other than 1e-9 of the
/// smaller one's size.
/// @throws IoError if the file cannot be read; InputError "file:line:column: key: got value, allowed: ..."
AnyScene read_scene(const std::filesystem::path& file);

/// The same from the text of a file.
/// @param file  what messages call it
AnyScene parse_scene(std::string_view text, const std::string& file);

}  // namespace touchstone::scene_file
