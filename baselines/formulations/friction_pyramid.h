#pragma once

#include <string>
#include <vector>

#include "baselines/options.h"
#include "core/model/scene.h"

namespace touchstone {

/// The friction ellipsoid of Eq. 5 as the convex hull of finitely many points  mu p_n E d_j  (Stewart &
/// Trinkle 1996). Between two directions the bound differs from the ellipsoid's.
template <int Dim>
struct FrictionPyramid {
  double mu = 0.0;
  /// Columns E d_j (t, o, r); with every column its opposite. None if mu = 0: a frictionless contact.
  Eigen::Matrix<double, Dimension<Dim>::friction, Eigen::Dynamic> directions;

  [[nodiscard]] Eigen::Index size() const { return directions.cols(); }
  /// Largest |(p_t, p_o)| / p_n.
  [[nodiscard]] double largest_friction() const;
};

/// How the ellipsoid is cut to a pyramid.
struct PyramidOptions {
  /// d: directions in the contact plane, even, >= 4. Not read in the plane.
  int sides = 8;
  /// The polygon's edges touch the ellipse and its corners lie 1 / cos(pi / d) outside; otherwise its corners
  /// lie on the ellipse and its edges cos(pi / d) inside.
  bool circumscribed = false;
};

/// Reads `pyramid` and `pyramid_fit` (in space; the plane has +-t, which is exact, and no option).
/// @throws InputError through OptionReader::fail
template <int Dim>
PyramidOptions read_pyramid_options(OptionReader& read);

/// In the plane: +-e_t. In space: d directions around the contact plane, the first along t, and +-e_r unless
/// it is 0.
template <int Dim>
FrictionPyramid<Dim> friction_pyramid(const ContactLaw<Dim>& law, const PyramidOptions& options);

}  // namespace touchstone
