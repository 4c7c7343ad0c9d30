#pragma once

#include <filesystem>
#include <string>

/// What `touchstone methods`, `scenarios` and `validate` print.
namespace touchstone::program {

/// Every method of this build: key, dimensions, version of the library behind it, what it can represent, and
/// a description.
std::string list_methods();

/// Every scenario: key and question.
std::string list_scenarios();

/// A line on a scene file that is sound. @throws as scene_file::read_scene
std::string describe_scene(const std::filesystem::path& file);

}  // namespace touchstone::program
