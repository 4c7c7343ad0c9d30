#pragma once

#include <memory>
#include <string>

#include "core/model/shape.h"

namespace touchstone {

/// One convex inequality and its derivatives at a point, body frame.
template <int Dim>
struct SurfaceJet {
  double value = 0.0;                          ///< f(x) [m]
  Vector<Dim> gradient = Vector<Dim>::Zero();  ///< [-]
  Matrix<Dim> hessian = Matrix<Dim>::Zero();   ///< [1/m]
};

/// A convex body {x : f_i(x) <= 0 for all i} in its body frame.
///
/// f_i < 0 inside, 0 on the surface, > 0 outside (section IV of the paper). A shape is free to choose its
/// f_i, but every f_i here is scaled to be a length: its gradient is of order 1 at the surface, so that f_i
/// is a distance to first order and one tolerance means the same for all shapes. For a ball of radius R it is
/// the paper's f times R/2.
template <int Dim>
class ConvexSurface {
 public:
  virtual ~ConvexSurface() = default;

  /// Number of inequalities.
  [[nodiscard]] virtual int count() const { return 1; }
  /// f_i and its derivatives at `x`, i in [0, count()). Defined for every finite x.
  [[nodiscard]] virtual SurfaceJet<Dim> jet(int i, const Vector<Dim>& x) const = 0;
  /// f_i(x) alone.
  [[nodiscard]] virtual double value(int i, const Vector<Dim>& x) const { return jet(i, x).value; }

  /// The point of the body farthest along `direction` (not zero). For an unbounded body and a direction in
  /// which it has no farthest point the result is not finite.
  [[nodiscard]] virtual Vector<Dim> support(const Vector<Dim>& direction) const = 0;

  /// Centre of a ball, body frame, that contains the body, and its radius; the radius is infinite for a
  /// half-space.
  struct BoundingBall {
    Vector<Dim> center;
    double radius;
  };
  [[nodiscard]] virtual BoundingBall bounding_ball() const = 0;
  /// Whether the bounding ball is the body itself.
  [[nodiscard]] virtual bool is_ball() const { return false; }

  /// Not null if the surface is one plane: its outward unit normal and offset. A point on it then needs only
  /// Dim - 1 coordinates, as the paper drops a_2y for the table of its Example 1.
  [[nodiscard]] virtual const HalfSpace<Dim>* plane() const { return nullptr; }
};

/// The inequalities of `shape`, placement included. Intersections are flattened to one list; one of planes
/// only becomes the polytope that they bound, without the planes that do not touch it.
/// @param shape  valid (see validate())
/// @param field  what to call the shape in a message
/// @throws InputError naming `field` if an intersection is empty, flat or unbounded
template <int Dim>
std::shared_ptr<const ConvexSurface<Dim>> make_surface(const Shape<Dim>& shape,
                                                       const std::string& field = "shape");

}  // namespace touchstone
