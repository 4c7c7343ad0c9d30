#include "experiments/scenarios/box_on_incline.h"

#include <cmath>

#include "core/model/mass_properties.h"

namespace touchstone {

namespace {

using Start = truth::BlockOnIncline::Start;

constexpr double kHeight = 1.0;  // [m]

/// Down the slope and out of it, and how a body's axes are turned with it.
template <int Dim>
struct Slope {
  Vector<Dim> down = Vector<Dim>::Zero();
  Vector<Dim> normal = Vector<Dim>::Zero();

  explicit Slope(double theta) {
    down[0] = normal[Dim - 1] = std::cos(theta);
    normal[0] = std::sin(theta);
    down[Dim - 1] = -std::sin(theta);
  }
};

PlanarRotation turned(double theta, PlanarRotation) { return PlanarRotation(-theta); }
SpatialRotation turned(double theta, SpatialRotation) {
  return SpatialRotation(exp_rotation(Vector<3>(0, theta, 0)));
}

/// Angular velocity in the sense that tips the box down the slope.
double tipping(const Angular<2>& omega) { return -omega[0]; }
double tipping(const Angular<3>& omega) { return omega.y(); }

}  // namespace

truth::BlockOnIncline InclineCell::block() const {
  return {.base = aspect * kHeight, .height = kHeight, .friction = mu, .theta = std::atan(tangent)};
}

template <int Dim>
Scene<Dim> box_on_incline_scene(const InclineCell& cell) {
  const truth::BlockOnIncline block = cell.block();
  const Slope<Dim> slope(block.theta);
  Scene<Dim> scene;
  scene.gravity[Dim - 1] = -block.gravity;
  scene.contact_law.mu = cell.mu;

  Body<Dim> box;
  box.name = "box";
  Vector<Dim> half_extents = Vector<Dim>::Constant(0.5);
  half_extents[0] = block.base / 2;
  half_extents[Dim - 1] = block.height / 2;
  box.shape.geometry = Box<Dim>{half_extents};
  box.inertia = uniform_inertia(box.shape, box.mass);
  box.pose.position = block.height / 2 * slope.normal;
  box.pose.rotation = turned(block.theta, Rotation<Dim>());

  Body<Dim> ground;
  ground.name = "slope";
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<Dim>{slope.normal, 0.0};

  scene.bodies = {box, ground};
  scene.validate();
  return scene;
}

template <int Dim>
InclineMotion incline_motion(const InclineCell& cell, const BodyState<Dim>& box) {
  const truth::BlockOnIncline block = cell.block();
  Vector<Dim> edge = Vector<Dim>::Zero();
  edge[0] = block.base / 2;
  edge[Dim - 1] = -block.height / 2;
  const Vector<Dim> velocity = point_velocity<Dim>(box.velocity, box.pose.rotation.matrix() * edge);
  const Angular<Dim> omega = box.velocity.template tail<Dimension<Dim>::angular>();
  return {velocity.dot(Slope<Dim>(block.theta).down), tipping(omega)};
}

Start incline_mode(const InclineCell& cell, const InclineMotion& motion, double t) {
  const truth::BlockOnIncline block = cell.block();
  const double unit = block.gravity * t;
  // A jitter to and fro is no rest either, hence the absolute values.
  const bool slides = std::abs(motion.slip) > kStill * unit;
  const bool tips = std::abs(motion.tip) * std::hypot(block.base, block.height) / 2 > kStill * unit;
  if (tips) return slides ? Start::tips_and_slides : Start::tips;
  return slides ? Start::slides : Start::rests;
}

std::string to_string(Start mode) {
  switch (mode) {
    case Start::rests:
      return "rests";
    case Start::slides:
      return "slides";
    case Start::tips:
      return "tips";
    case Start::tips_and_slides:
      return "tips_and_slides";
  }
  return {};
}

namespace {

/// Three places on each threshold, as far as the threshold reaches.
void add_beside_thresholds(double k, double offset, std::vector<InclineCell>& cells) {
  const double off = 1 + offset;
  for (const double share : {0.5, 0.7, 0.9}) {
    cells.push_back({k, share * k, share * k * off, "stick_slide", offset});
  }
  for (const double factor : {1.1, 1.4, 1.8}) {
    cells.push_back({k, k * off, factor * k, "tip_in_place", offset});
    cells.push_back({k, factor * k, k * off, "slide_tip", offset});
    InclineCell cell{k, factor * k, 0, "tip_slide", offset};
    cell.mu = cell.block().friction_to_tip_in_place() * off;
    cells.push_back(cell);
  }
}

}  // namespace

std::vector<InclineCell> incline_cells(const InclineGrid& grid) {
  std::vector<InclineCell> cells;
  for (const double k : grid.aspects) {
    for (const double tangent : grid.tangents) {
      for (const double mu : grid.frictions) cells.push_back({k, tangent, mu});
    }
    for (const double offset : grid.offsets) {
      add_beside_thresholds(k, offset, cells);
      add_beside_thresholds(k, -offset, cells);
    }
  }
  return cells;
}

template Scene<2> box_on_incline_scene(const InclineCell&);
template Scene<3> box_on_incline_scene(const InclineCell&);
template InclineMotion incline_motion(const InclineCell&, const BodyState<2>&);
template InclineMotion incline_motion(const InclineCell&, const BodyState<3>&);

}  // namespace touchstone
