#pragma once

#include <string>

#include "baselines/registry.h"
#include "tests/conformance/scenes.h"

/// What a method makes of a small scene, to the last bit, for comparing runs and processes.
namespace touchstone::conformance {

/// Two balls that land sliding, one of them on the other.
template <int Dim>
Scene<Dim> busy_scene();

inline constexpr int kTraceSteps = 60;

/// Appends the state and the normal impulses, in hexadecimal.
template <int Dim>
void append(std::string& text, const Method<Dim>& method);

/// `entry` on busy_scene, for kTraceSteps steps of kStep.
template <int Dim>
std::string trace(const MethodEntry<Dim>& entry);

/// Standard output of a process that does nothing but trace the method `key`.
/// @throws std::runtime_error if there is no such process
template <int Dim>
std::string trace_of_fresh_process(std::string_view key);

}  // namespace touchstone::conformance
