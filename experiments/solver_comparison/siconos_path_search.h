#pragma once

#include <Eigen/Core>

struct SolverOptions;

namespace touchstone::solver_comparison {

/// Writes what Siconos's path search reads before anybody has written it, so that it does not go by what the
/// process left in storage before. Its stabilisation (NMS.c: "F should be up-to-date") reads F at the iterate
/// from a workspace of its own, which holds that from the second iteration on; at the first, F was evaluated
/// into the caller's array (NCP_PathSearch.c), and the workspace is as malloc() gave it. So the outcome hung
/// on heap addresses, and they on the length of a path on the command line. Nothing else in Siconos is
/// changed.
/// @param options  of a path search that has made its workspace, and done no iteration with it
/// @param start    the iterate that it was given
/// @param f        F there, as it returned it; as many entries
/// @throws Unsupported if the workspace is not laid out as in Siconos 4.4
void write_first_f(const SolverOptions& options, const Eigen::VectorXd& start, const Eigen::VectorXd& f);

}  // namespace touchstone::solver_comparison
