#pragma once

#include <cstdint>
#include <string>

#include "core/model/scene.h"

/// Contact steps at random, made to be hard: for solvers and for what certifies their answers.
namespace touchstone::random_steps {

template <int Dim>
struct RandomStep {
  Scene<Dim> scene;
  double h = 0.0;  ///< [s]
};

/// The step number `seed`, the same whatever was made before.
///
/// 1 to 8 moving bodies of all shapes, some fixed ones and mostly a ground, each put against another at a gap
/// that is nothing, next to nothing, or what the step closes; faces parallel but for a turn from 1e-12 to
/// 1e-2; sizes over a decade, mass ratios to 1e4; friction 0 to 2, anisotropic and with torsion; at rest,
/// slow or fast; steps from 1e-4 to 0.05 s; with and without gravity. Bodies do not overlap at the start by
/// more than rounding.
template <int Dim>
RandomStep<Dim> random_step(std::uint64_t seed);

/// A scene as the text that experiments/scene_file reads, to the last digit of every number.
template <int Dim>
std::string write_scene(const Scene<Dim>& scene);

/// The kinds of shapes of a scene, "ball,box,plane": sorted, each once.
template <int Dim>
std::string shapes_of(const Scene<Dim>& scene);

}  // namespace touchstone::random_steps
