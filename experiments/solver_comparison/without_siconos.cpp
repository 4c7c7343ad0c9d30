#include "core/model/errors.h"
#include "experiments/solver_comparison/answer.h"

namespace touchstone::solver_comparison {

std::string siconos_version() { return {}; }

Answer solve_by_siconos(const std::string&, const Task&) {
  throw Unsupported("the program was built without Siconos");
}

}  // namespace touchstone::solver_comparison
