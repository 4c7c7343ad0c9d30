#pragma once

#include <string>
#include <vector>

#include "baselines/registry.h"
#include "tests/conformance/traits.h"

/// What every method, ours and the engines', is held to. A feature is one question with a check; each method
/// meets each feature in one test, and the results are the capability matrix.
namespace touchstone::conformance {

template <int Dim>
struct Subject {
  const MethodEntry<Dim>& entry;
  Traits traits;
};

template <int Dim>
struct Feature {
  const char* name;
  const char* question;  ///< for the matrix
  /// Fails by gtest's EXPECTs or an exception. Unsupported means that the method says it cannot: the test is
  /// skipped with that reason.
  void (*check)(const Subject<Dim>& subject);
};

// One table a file, both dimensions.
template <int Dim>
std::vector<Feature<Dim>> loading_features();
template <int Dim>
std::vector<Feature<Dim>> motion_features();
template <int Dim>
std::vector<Feature<Dim>> contact_features();
template <int Dim>
std::vector<Feature<Dim>> friction_features();
template <int Dim>
std::vector<Feature<Dim>> repeat_features();
template <int Dim>
std::vector<Feature<Dim>> shape_features();

}  // namespace touchstone::conformance
