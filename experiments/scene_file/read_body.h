#pragma once

#include "core/model/scene.h"
#include "experiments/scene_file/document.h"

namespace touchstone::scene_file {

/// A body from its [[body]] table, valid in itself.
/// @throws LocatedError
template <int Dim>
Body<Dim> read_body(const Value& value);

}  // namespace touchstone::scene_file
