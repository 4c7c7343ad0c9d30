#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "core/model/errors.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/matrix.h"
#include "tests/conformance/trace.h"

/// Every method of the table against every feature, one test each, named <plane|space>_<method>.<feature>.
///   conformance_test --matrix FILE   also writes the capability matrix
///   conformance_test --trace 2|3 KEY prints one method's trace, for comparing processes
namespace touchstone::conformance {

namespace {

template <int Dim>
class FeatureTest : public testing::Test {
 public:
  FeatureTest(const MethodEntry<Dim>& entry, const Feature<Dim>& feature)
      : entry_(entry), feature_(feature) {}

  void TestBody() override {
    RecordProperty(kDimensionProperty, Dim);
    RecordProperty(kMethodProperty, std::string(entry_.key));
    RecordProperty(kFeatureProperty, feature_.name);
    RecordProperty(kQuestionProperty, feature_.question);
    try {
      feature_.check({entry_, traits_of(entry_.key)});
    } catch (const Unsupported& reason) {
      GTEST_SKIP() << reason.what();
    } catch (const std::exception& error) {
      FAIL() << error.what();
    }
  }

 private:
  const MethodEntry<Dim>& entry_;
  const Feature<Dim> feature_;
};

template <int Dim>
std::vector<Feature<Dim>> all_features() {
  std::vector<Feature<Dim>> all;
  for (const auto table : {loading_features<Dim>, motion_features<Dim>, contact_features<Dim>,
                           friction_features<Dim>, repeat_features<Dim>, shape_features<Dim>}) {
    const auto features = table();
    all.insert(all.end(), features.begin(), features.end());
  }
  return all;
}

template <int Dim>
void register_tests() {
  for (const auto& entry : methods<Dim>()) {
    const std::string suite = fmt::format("{}_{}", Dim == 2 ? "plane" : "space", entry.key);
    for (const auto& feature : all_features<Dim>()) {
      testing::RegisterTest(
          suite.c_str(), feature.name, nullptr, nullptr, __FILE__, __LINE__,
          [&entry, feature]() -> testing::Test* { return new FeatureTest<Dim>(entry, feature); });
    }
  }
}

template <int Dim>
int print_trace(const std::string& key) {
  for (const auto& entry : methods<Dim>()) {
    if (entry.key == key) fmt::print("{}", trace(entry));
  }
  return 0;
}

}  // namespace

int run(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--trace") == 0) {
    return argv[2][0] == '2' ? print_trace<2>(argv[3]) : print_trace<3>(argv[3]);
  }
  testing::InitGoogleTest(&argc, argv);
  register_tests<2>();
  register_tests<3>();
  const int result = RUN_ALL_TESTS();
  if (argc == 3 && std::strcmp(argv[1], "--matrix") == 0)
    write_matrix(*testing::UnitTest::GetInstance(), argv[2]);
  return result;
}

}  // namespace touchstone::conformance

int main(int argc, char** argv) { return touchstone::conformance::run(argc, argv); }
