#pragma once

#include <filesystem>
#include <string>

namespace touchstone::solver_comparison {

/// A line for `step` and one for `frozen_step` in the tables of this folder: how many steps elimination and
/// each of Siconos's solvers solved, and the ratio of their median times over the steps that both solved. A
/// step is the same for both if scene, number and start are; a frozen one stands for the cold start.
/// @throws InputError, IoError as read_csv()
[[nodiscard]] std::string describe_speed(const std::filesystem::path& folder);

}  // namespace touchstone::solver_comparison
