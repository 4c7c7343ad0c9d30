#include "experiments/harness/provenance.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <Eigen/Core>
#include <cstdint>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "build_info.h"
#include "experiments/harness/files.h"
#include "source_version.h"

namespace touchstone::harness {

namespace {

using Json = nlohmann::json;  // keeps its keys sorted: the same bytes every time

Json sources() {
  return {{"core", kCoreTree}, {"baselines", kBaselinesTree}, {"experiments", kExperimentsTree}};
}

Json libraries() {
  return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)}};
}

/// FNV-1a, 64 bit: enough to tell one build of ours from the next.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      value_ ^= static_cast<unsigned char>(byte);
      value_ *= 0x100000001b3U;
    }
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

/// Bytes that are not UTF-8 (of a path on the command line, say) are replaced.
std::string to_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string meta_json(const Provenance& provenance, const std::string& table) {
  return to_text({{"experiment", provenance.experiment},
                  {"table", table},
                  {"command", provenance.command},
                  {"seed", provenance.seed ? Json(*provenance.seed) : Json(nullptr)},
                  {"sources", sources()},
                  {"libraries", libraries()},
                  {"engines", provenance.engines}});
}

std::string environment_json(const RunFacts& facts) {
  return to_text({{"host", host_name()},
                  {"processors", std::thread::hardware_concurrency()},
                  {"compiler", kCompiler},
                  {"build_type", kBuildType},
                  {"flags", kFlags},
                  {"commit", kHeadCommit},
                  {"dirty", kSourcesDirty},
                  {"command_line", facts.command_line},
                  {"jobs", facts.jobs},
                  {"started", facts.started},
                  {"wall_s", facts.wall_s}});
}

std::string build_stamp(const Provenance& provenance) {
  Hash hash;
  hash.add(Json{sources(), libraries(), provenance.engines, kCompiler, kBuildType, kFlags}.dump());
  // Without git nothing else tells one version of the sources from the next.
  if (kCoreTree == std::string_view("unknown")) hash.add(read_file("/proc/self/exe"));
  return hash.text();
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace touchstone::harness
