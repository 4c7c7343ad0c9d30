#include "baselines/formulations/implicit_ncp.h"

#include "baselines/options.h"
#include "core/stepper/implicit_stepper.h"

namespace touchstone {

template <int Dim>
std::unique_ptr<Method<Dim>> make_implicit_ncp(const Scene<Dim>& scene, const Options& options) {
  OptionReader read("implicit_ncp", options);
  ImplicitOptions implicit;
  using Solver = ImplicitOptions::Solver;
  const std::string solver = read.choice("solver", "condensed", {"condensed", "path", "semismooth"});
  implicit.solver = solver == "condensed" ? Solver::condensed
                    : solver == "path"    ? Solver::path
                                          : Solver::semismooth;
  implicit.gap = read.choice("gap", "distance", {"workspace", "distance"}) == "workspace"
                     ? GapFunction::workspace
                     : GapFunction::distance;
  implicit.tolerance = read.number("tolerance", implicit.tolerance, 1e-15, 1e-3);
  implicit.max_iterations = read.integer("max_iterations", implicit.max_iterations, 1, 1000000);
  read.finish();
  return std::make_unique<ImplicitStepper<Dim>>(scene, implicit);
}

template std::unique_ptr<Method<2>> make_implicit_ncp(const Scene<2>&, const Options&);
template std::unique_ptr<Method<3>> make_implicit_ncp(const Scene<3>&, const Options&);

}  // namespace touchstone
