#pragma once

#include "baselines/options.h"

namespace touchstone {

/// Which of a body's vertices a step takes into its problem. Changes the trajectory, so it is a parameter and
/// a column of the results.
struct CandidatePolicy {
  enum class Kind {
    reachable,  ///< every vertex whose linearised gap this step could close, by the bound of reach_bound.h
    nearest,    ///< the `count` vertices of least gap of each pair
    epsilon,    ///< every candidate with a gap of at most `distance`
    all         ///< every vertex
  };
  Kind kind = Kind::reachable;
  int count = 0;          ///< of `nearest`, >= 1
  double distance = 0.0;  ///< of `epsilon`, >= 0 [m]
};

/// Reads the option `candidates`: reachable | nearest:k | epsilon:e | all.
/// @throws InputError through OptionReader::fail
CandidatePolicy read_candidate_policy(OptionReader& read);

}  // namespace touchstone
