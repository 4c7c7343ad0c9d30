#pragma once

#include "core/model/shape.h"

namespace touchstone {

/// Mass properties of a solid of uniform density.
template <int Dim>
struct MassProperties {
  double measure = 0.0;                         ///< area [m^2], volume [m^3]
  Vector<Dim> center = Vector<Dim>::Zero();     ///< centre of mass, body frame [m]
  Inertia<Dim> inertia = Inertia<Dim>::Zero();  ///< about the centre of mass, body axes, of unit mass [m^2]
};

/// Placement included. By closed forms, polytopes by simplices from a point inside, an intersection by
/// quadrature with an estimated relative error below 1e-10. A cone's apex is taken as sharp.
/// @throws Unsupported for a half-space, which has no mass; InputError for an intersection that is no solid
template <int Dim>
MassProperties<Dim> mass_properties(const Shape<Dim>& shape);

/// Inertia about the centre of mass of a uniform solid of mass `mass` [kg m^2].
template <int Dim>
Inertia<Dim> uniform_inertia(const Shape<Dim>& shape, double mass) {
  return mass * mass_properties(shape).inertia;
}

}  // namespace touchstone
