// Tests what results/gates.toml claims of the results, the committed ones or fresh ones elsewhere.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/model/errors.h"
#include "tools/gate/report.h"

namespace {

enum ExitCode { kAllHold = 0, kOneFails = 1, kBadInput = 2, kInputOutput = 3 };

int run(const std::string& gates, const std::string& results) {
  using namespace touchstone::gate;
  const std::vector<Claim> claims = read_claims(gates);
  const std::vector<Verdict> verdicts = check_all(claims, results);
  fmt::print("{}", format_report(claims, verdicts));
  const bool all = std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.holds; });
  return all ? kAllHold : kOneFails;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Checks every claim of a gates file on the tables of results.", "gate");
  std::string gates = "results/gates.toml";
  std::string results = "results";
  app.add_option("--gates", gates, "the claims")->capture_default_str()->type_name("FILE");
  app.add_option("--results", results, "folder of the results that they are about")
      ->capture_default_str()
      ->type_name("DIR");
  app.footer(
      "Exit codes: 0 every claim holds, 1 one fails, 2 bad usage or a malformed file, 3 a file cannot be "
      "read.");
  try {
    app.parse(argc, argv);
    return run(gates, results);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "gate: {} (see gate --help)\n", error.what());
    return kBadInput;
  } catch (const touchstone::InputError& error) {
    fmt::print(stderr, "gate: {}\n", error.what());
    return kBadInput;
  } catch (const touchstone::IoError& error) {
    fmt::print(stderr, "gate: {}\n", error.what());
    return kInputOutput;
  }
}
