#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/method.h"

/// The one sorted table of methods. To add a method: one .cpp with a factory, one row in registry.cpp.
namespace touchstone {

template <int Dim>
struct MethodEntry {
  std::string_view key;          ///< "stewart_trinkle", "ode_step": what --methods takes
  std::string_view description;  ///< one line
  /// Loads `scene`. @throws InputError on an unknown or bad option, Unsupported if the scene cannot be
  /// represented
  std::unique_ptr<Method<Dim>> (*make)(const Scene<Dim>& scene, const Options& options);
  /// Version of the library behind it, as the library tells; empty for our own formulations.
  std::string (*version)();
};

/// Every method of this build, sorted by key.
template <int Dim>
std::span<const MethodEntry<Dim>> methods();

/// @param table  this build's methods, or those of a test
/// @throws InputError listing the known keys if there is no method `key`
template <int Dim>
const MethodEntry<Dim>& find_method(std::string_view key,
                                    std::span<const MethodEntry<Dim>> table = methods<Dim>());

}  // namespace touchstone
