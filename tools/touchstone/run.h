#pragma once

#include <filesystem>
#include <string>

#include "core/method.h"

/// `touchstone run`: one scene under one method, written down.
namespace touchstone::program {

struct RunRequest {
  std::filesystem::path scene;
  std::string method;  ///< its key
  Options options;
  double h = 0.0;      ///< step [s]
  double until = 0.0;  ///< horizon, a multiple of h [s]
  std::filesystem::path out;
  long every = 1;  ///< t = 0, every so many steps, and the end are written
};

/// Runs and writes trajectory.csv, contacts.csv and energy.csv, all or none. A step that fails ends the run;
/// what was recorded up to there is written, and the reason told on stderr.
/// @returns whether every step was solved
/// @throws InputError on a bad scene, an unknown method or option, a scene that the method cannot represent,
/// or a horizon that is no multiple of the step, before anything is written; IoError; Interrupted, with
/// nothing written
bool run(const RunRequest& request);

}  // namespace touchstone::program
