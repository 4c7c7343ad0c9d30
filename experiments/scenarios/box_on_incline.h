#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/scene.h"
#include "experiments/scenarios/truths/box_on_incline.h"

/// A uniform box put at rest on an incline: does it stay, slide, or tip over its lower edge?
namespace touchstone {

/// One place in the map of thresholds. The box is `aspect` m long down the slope, 1 m across it (and in space
/// 1 m wide), and weighs 1 kg.
struct InclineCell {
  double aspect = 1.0;   ///< k = length / height, > 0
  double tangent = 0.5;  ///< of the slope's angle, > 0
  double mu = 0.5;       ///< coefficient of friction, > 0
  /// Which threshold it lies beside, and how far off: empty for a cell of the regular grid.
  std::string threshold = {};
  double offset = 0.0;  ///< relative distance from that threshold

  [[nodiscard]] truth::BlockOnIncline block() const;
};

/// The slope falls along +x, with its normal (sin, 0, cos), in the plane (sin, cos). Bodies "box" and
/// "slope".
template <int Dim>
Scene<Dim> box_on_incline_scene(const InclineCell& cell);

/// How the box moves, read from its state.
struct InclineMotion {
  double slip = 0.0;  ///< speed of the lower edge down the slope [m/s]; > 0: it slides down
  double tip = 0.0;   ///< angular velocity over the lower edge [rad/s]; > 0: it tips
};
template <int Dim>
InclineMotion incline_motion(const InclineCell& cell, const BodyState<Dim>& box);

/// What a person would call a motion `t` [s] after the release: it slides if the lower edge's mean
/// acceleration is more than kStill of g, it tips if the half diagonal's is.
constexpr double kStill = 2e-5;
truth::BlockOnIncline::Start incline_mode(const InclineCell& cell, const InclineMotion& motion, double t);

/// "rests", "slides", "tips", "tips_and_slides".
std::string to_string(truth::BlockOnIncline::Start mode);

/// Cells of a regular grid of `tangents` by `frictions` for every aspect ratio, and cells beside each of the
/// four thresholds at the relative distances +-`offsets`:
///   stick_slide  mu = T, where mu < k          tip_in_place  T = k, where mu > k
///   slide_tip    mu = k, where T > k           tip_slide     mu = friction_to_tip_in_place(), where T > k
struct InclineGrid {
  std::vector<double> aspects, tangents, frictions, offsets;
};
std::vector<InclineCell> incline_cells(const InclineGrid& grid);

}  // namespace touchstone
