#pragma once

#include <string>
#include <vector>

#include "core/model/scene.h"

/// Readings of a shape that adapters share.
namespace touchstone::engines {

/// The corners of a box, polytope or regular polygon, body frame, counter-clockwise; empty for any other
/// shape.
std::vector<Vector<2>> polygon_vertices(const Shape<2>& shape);

/// The corners of a box or a polytope in its own frame; none for any other shape.
std::vector<Vector<3>> convex_corners(const Geometry<3>::Variant& geometry);

/// Moves the points into z = 0 and keeps one of each: what the corners of a prism are to planar motion.
void keep_one_of_each_in_plane(std::vector<Vector<3>>& points);

/// For each plane of the polytope the indices of its corners, counter-clockwise seen from outside.
std::vector<std::vector<int>> face_corners(const Polytope<3>& polytope);

/// The shape with its surface moved outward by `distance` [m]: exact for faces, and for corners where as many
/// faces meet as can be moved at once; semi-axes are lengthened, which is exact at their ends. Used by
/// adapters that keep bodies apart by a thin skin; a shape that has no such form comes back as it is.
Geometry<3>::Variant inflated(const Geometry<3>::Variant& geometry, double distance);

/// @throws Unsupported saying that `engine` has no such shape, and why
template <int Dim>
[[noreturn]] void refuse_shape(const std::string& engine, const Body<Dim>& body, const std::string& why);

/// A half-space has no centre of mass and no engine moves one.
/// @throws Unsupported if a moving body is one
template <int Dim>
void refuse_moving_half_spaces(const std::string& engine, const Scene<Dim>& scene);

}  // namespace touchstone::engines
