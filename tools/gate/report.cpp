#include "tools/gate/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace touchstone::gate {

namespace {

using Line = std::array<std::string, 5>;

std::string align(const std::vector<Line>& lines) {
  std::array<std::size_t, 5> widths{};
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const Line& line : lines) {
    text += fmt::format("{:<{}}  {:<{}}  {:>{}}  {:>{}}  {}\n", line[0], widths[0], line[1], widths[1],
                        line[2], widths[2], line[3], widths[3], line[4]);
  }
  return text;
}

}  // namespace

std::string format_report(const std::vector<Claim>& claims, const std::vector<Verdict>& verdicts) {
  std::vector<Line> lines = {{"claim", "bound", "value", "margin", "holds"}};
  std::string failures;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const Verdict& verdict = verdicts[i];
    lines.push_back(
        {claims[i].name, verdict.bound, verdict.value, verdict.margin, verdict.holds ? "yes" : "NO"});
    if (verdict.holds) continue;
    ++failed;
    failures +=
        fmt::format("\nFAILS: {} ({})\n  {}: {}\n  why it is claimed: {}\n", claims[i].name, claims[i].file,
                    claims[i].column.empty() ? "rows" : claims[i].column, verdict.problem, claims[i].reason);
  }
  return align(lines) + failures +
         fmt::format("\n{} claims: {} hold, {} fail\n", claims.size(), claims.size() - failed, failed);
}

}  // namespace touchstone::gate
