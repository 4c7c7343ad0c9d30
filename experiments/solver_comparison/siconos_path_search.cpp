#include "experiments/solver_comparison/siconos_path_search.h"

#include <SolverOptions.h>

#include <algorithm>
#include <cstddef>

#include "core/model/errors.h"

namespace touchstone::solver_comparison {

namespace {

/// The beginning of NMS_data, whose header Debian's package leaves out (numerics/src/tools/NMS.h).
struct StabilisationData {
  unsigned size;
  int search_types[2];
  double parameters[5];
  int steps[2];
  double merits[2];
  void* reference;
  double* checkpoints;  ///< the last two, 2 x size
  double delta_checkpoint;
  double* best_point;  ///< at first the start
  double merit_best_point;
  double delta_best_point;
  double* workspace;  ///< 5 x size, of which F is the first
};
static_assert(sizeof(void*) != 8 || offsetof(StabilisationData, workspace) == 128);

/// The beginning of pathsearch_data (numerics/src/tools/PathSearch.h).
struct PathSearchData {
  StabilisationData* stabilisation;
};

}  // namespace

void write_first_f(const SolverOptions& options, const Eigen::VectorXd& start, const Eigen::VectorXd& f) {
  const auto* const data = static_cast<const PathSearchData*>(options.solverData);
  // Of another layout these would hardly be size and start.
  if (data == nullptr || data->stabilisation->size != static_cast<unsigned>(start.size()) ||
      !std::equal(start.begin(), start.end(), data->stabilisation->best_point))
    throw Unsupported("the path search of this Siconos keeps its data otherwise than that of Siconos 4.4");
  std::ranges::copy(f, data->stabilisation->workspace);
}

}  // namespace touchstone::solver_comparison
