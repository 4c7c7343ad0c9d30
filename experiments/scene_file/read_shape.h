#pragma once

#include "core/model/shape.h"
#include "experiments/scene_file/document.h"

namespace touchstone::scene_file {

/// An orientation: in the plane an angle [rad], in space a unit quaternion w, x, y, z.
template <int Dim>
Rotation<Dim> read_rotation(const Value& value);

/// A shape from its table: `type`, the keys of that type, and optionally `center` and `rotation`, where the
/// shape's own frame stands in the body's. Valid, and with an inside.
/// @throws LocatedError
template <int Dim>
Shape<Dim> read_shape(const Value& value);

}  // namespace touchstone::scene_file
