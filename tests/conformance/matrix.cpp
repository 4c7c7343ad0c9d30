#include "tests/conformance/matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/model/errors.h"

namespace touchstone::conformance {

namespace {

std::string property(const testing::TestResult& result, const char* name) {
  for (int i = 0; i < result.test_property_count(); ++i) {
    if (std::string(result.GetTestProperty(i).key()) == name) return result.GetTestProperty(i).value();
  }
  return {};
}

/// The first line of what a skip or a failure said.
std::string reason(const testing::TestResult& result) {
  for (int i = 0; i < result.total_part_count(); ++i) {
    const auto& part = result.GetTestPartResult(i);
    if (part.passed()) continue;
    const std::string message = part.message();
    return message.substr(0, message.find('\n'));
  }
  return {};
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) {
    text += c;
    if (c == '"') text += c;
  }
  return text + '"';
}

std::string row(const testing::TestResult& result) {
  const char* outcome = result.Failed() ? "failed" : result.Skipped() ? "no" : "yes";
  return fmt::format("{},{},{},{},{},{}\n", property(result, kDimensionProperty),
                     property(result, kMethodProperty), property(result, kFeatureProperty), outcome,
                     quoted(reason(result)), quoted(property(result, kQuestionProperty)));
}

}  // namespace

void write_matrix(const testing::UnitTest& run, const std::string& file) {
  std::vector<std::string> rows;
  for (int s = 0; s < run.total_test_suite_count(); ++s) {
    const auto& suite = *run.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const auto& test = *suite.GetTestInfo(t);
      if (test.should_run() && !property(*test.result(), kFeatureProperty).empty())
        rows.push_back(row(*test.result()));
    }
  }
  std::sort(rows.begin(), rows.end());
  std::ofstream out(file);
  out << "dimension,method,feature,result,reason,question\n";
  for (const auto& line : rows) out << line;
  out.close();
  if (!out) throw IoError(file + ": cannot be written");
}

}  // namespace touchstone::conformance
