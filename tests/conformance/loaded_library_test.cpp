#include "baselines/engines/loaded_library.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "baselines/registry.h"

/// Versions are those of the files that run. What is mapped is read from /proc/self/maps, and not by dladdr.
namespace touchstone::engines {
namespace {

struct Mapping {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  std::string file;  ///< without its folder
};

std::vector<Mapping> mappings() {
  std::vector<Mapping> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::string range, skipped, path;
    words >> range;
    for (int i = 0; i < 4; ++i) words >> skipped;
    words >> path;
    const auto dash = range.find('-');
    found.push_back({std::stoul(range.substr(0, dash), nullptr, 16),
                     std::stoul(range.substr(dash + 1), nullptr, 16),
                     std::filesystem::path(path).filename()});
  }
  return found;
}

std::string mapped_at(const void* address) {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (const auto& mapping : mappings()) {
    if (mapping.begin <= at && at < mapping.end) return mapping.file;
  }
  return "nothing";
}

TEST(LoadedLibrary, FileOfAFunctionIsTheOneMappedThere) {
  const auto* of_libc = dlsym(RTLD_DEFAULT, "gnu_get_libc_version");
  EXPECT_EQ(loaded_file(of_libc), mapped_at(of_libc));
  EXPECT_TRUE(loaded_file(of_libc).starts_with("libc.so")) << loaded_file(of_libc);
  const auto* of_program = reinterpret_cast<const void*>(&mapped_at);
  EXPECT_EQ(loaded_file(of_program), mapped_at(of_program));
}

TEST(LoadedLibrary, AnAddressInNoFileIsAnError) {
  const int on_the_stack = 0;
  EXPECT_THROW(static_cast<void>(loaded_file(&on_the_stack)), std::runtime_error);
}

TEST(LoadedLibrary, VersionStatesBoth) {
  EXPECT_EQ(version_and_file("6.12.1", "libdart.so.6.12.1", FileNumber::release),
            "6.12.1 (libdart.so.6.12.1)");
  EXPECT_EQ(version_and_file("3.24", "libB.so", FileNumber::release), "3.24 (libB.so)");
  EXPECT_EQ(version_and_file("0.16.2", "libode.so.8.0.2", FileNumber::interface), "0.16.2 (libode.so.8.0.2)");
}

TEST(LoadedLibrary, AFileOfAnotherReleaseIsAnErrorThatNamesBoth) {
  EXPECT_NO_THROW(version_and_file("6.12.1", "libdart.so.6.12", FileNumber::release));
  EXPECT_NO_THROW(version_and_file("3.24", "libB.so.3.24.1", FileNumber::release));
  for (const char* file : {"libdart.so.6.13.0", "libdart.so.6.1", "libdart.so.6.12.10", "libdart.so.7"}) {
    try {
      static_cast<void>(version_and_file("6.12.1", file, FileNumber::release));
      ADD_FAILURE() << file << " was taken for 6.12.1";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("6.12.1"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }
}

/// Of the libraries that have no function for it.
TEST(LoadedLibrary, VersionsOfMethodsNameFilesThatAreLoaded) {
  std::set<std::string> named;
  for (const auto& entry : methods<3>()) {
    const std::string version = entry.version();
    const auto open = version.find('(');
    if (open == std::string::npos) continue;
    ASSERT_EQ(version.back(), ')') << version;
    named.insert(version.substr(open + 1, version.size() - open - 2));
  }
  std::set<std::string> mapped;
  for (const auto& mapping : mappings()) mapped.insert(mapping.file);
  for (const auto& file : named) EXPECT_EQ(mapped.count(file), 1U) << file;
  for (const std::string library : {"libBulletDynamics.so", "libBulletDynamics-float64.so", "libode.so"}) {
    const auto is_of = [&](const std::string& file) { return file.starts_with(library); };
    EXPECT_EQ(std::count_if(named.begin(), named.end(), is_of), 1) << library;
  }
}

}  // namespace
}  // namespace touchstone::engines
