#include "baselines/formulations/friction_pyramid.h"

#include <cmath>
#include <numbers>

namespace touchstone {

template <int Dim>
double FrictionPyramid<Dim>::largest_friction() const {
  if (size() == 0) return 0.0;
  return mu * directions.template topRows<Dimension<Dim>::tangent>().colwise().norm().maxCoeff();
}

template <>
PyramidOptions read_pyramid_options<2>(OptionReader&) {
  return {2, false};
}

template <>
PyramidOptions read_pyramid_options<3>(OptionReader& read) {
  constexpr int kMostSides = 1000;
  PyramidOptions options;
  options.sides = read.integer("pyramid", options.sides, 4, kMostSides);
  if (options.sides % 2 != 0) read.fail("pyramid", std::to_string(options.sides), "an even number of sides");
  options.circumscribed =
      read.choice("pyramid_fit", "inscribed", {"circumscribed", "inscribed"}) == "circumscribed";
  return options;
}

template <>
FrictionPyramid<2> friction_pyramid(const ContactLaw<2>& law, const PyramidOptions&) {
  FrictionPyramid<2> pyramid;
  pyramid.mu = law.mu;
  if (law.mu > 0) {
    pyramid.directions.resize(1, 2);
    pyramid.directions << law.e_t, -law.e_t;
  }
  return pyramid;
}

template <>
FrictionPyramid<3> friction_pyramid(const ContactLaw<3>& law, const PyramidOptions& options) {
  FrictionPyramid<3> pyramid;
  pyramid.mu = law.mu;
  if (law.mu == 0) return pyramid;
  const int torsion = law.e_r > 0 ? 2 : 0;
  const double step = 2 * std::numbers::pi / options.sides;
  const double size = options.circumscribed ? 1 / std::cos(step / 2) : 1.0;
  pyramid.directions.setZero(3, options.sides + torsion);
  for (int j = 0; j < options.sides / 2; ++j) {
    const Vector<3> direction =
        size * Vector<3>(law.e_t * std::cos(step * j), law.e_o * std::sin(step * j), 0);
    pyramid.directions.col(j) = direction;
    pyramid.directions.col(j + options.sides / 2) =
        -direction;  // exactly opposite, whatever cos and sin round to
  }
  if (torsion > 0) {
    pyramid.directions(2, options.sides) = law.e_r;
    pyramid.directions(2, options.sides + 1) = -law.e_r;
  }
  return pyramid;
}

template struct FrictionPyramid<2>;
template struct FrictionPyramid<3>;

}  // namespace touchstone
