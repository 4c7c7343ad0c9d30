#pragma once

#include <gtest/gtest.h>

#include <string>

namespace touchstone::conformance {

/// What a test of the suite leaves for the matrix: property names of gtest's results.
inline constexpr const char* kDimensionProperty = "dimension";
inline constexpr const char* kMethodProperty = "method";
inline constexpr const char* kFeatureProperty = "feature";
inline constexpr const char* kQuestionProperty = "question";

/// Writes what the run that has just ended found, one row a method and feature, sorted:
/// dimension,method,feature,result,reason,question with result yes, no (the method says that it cannot) or
/// failed.
/// @throws IoError if the file cannot be written
void write_matrix(const testing::UnitTest& run, const std::string& file);

}  // namespace touchstone::conformance
