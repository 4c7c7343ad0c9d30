#pragma once

#include "core/model/scene.h"
#include "experiments/scene_file/document.h"

/// What acts between bodies: contact laws and joints.
namespace touchstone::scene_file {

/// The default contact law from the [friction] table.
/// @throws LocatedError, as do all of these
template <int Dim>
ContactLaw<Dim> read_friction(const Value& value);

/// A [[pair]]: what it does not say is as in the scene's default law.
/// @param scene  with its default law and all its bodies
template <int Dim>
PairLaw<Dim> read_pair(const Value& value, const Scene<Dim>& scene);

/// A [[joint]].
/// @param scene  with all its bodies
template <int Dim>
Joint<Dim> read_joint(const Value& value, const Scene<Dim>& scene);

}  // namespace touchstone::scene_file
