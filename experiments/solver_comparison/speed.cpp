#include "experiments/solver_comparison/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "experiments/harness/csv.h"

namespace touchstone::solver_comparison {

namespace {

/// Times of solved steps by what tells the step: scene, number, and start.
using Times = std::map<std::string, double>;
using ByFamilyAndSolver = std::map<std::pair<std::string, std::string>, Times>;

std::string step_of(const harness::Row& row, const harness::Table& table, const std::string& file) {
  const auto cell = [&](const char* column) { return row[table.column(column, file)]; };
  return fmt::format("{} {} {}", cell("scenario"), cell("item"),
                     cell("family") == "frozen_step" ? "cold" : cell("start"));
}

/// Rows of summary and timing have the same order: both are sorted by what tells the case.
ByFamilyAndSolver solved_times(const std::filesystem::path& folder) {
  const harness::Table summary = harness::read_csv(folder / "summary.csv");
  const harness::Table timing = harness::read_csv(folder / "timing.csv");
  const std::size_t outcome = summary.column("outcome", "summary.csv");
  std::map<std::string, double> measured;
  const auto key = [](const harness::Row& row, const harness::Table& table) {
    std::string text;
    for (const char* column : {"family", "method"}) text += row[table.column(column, "timing.csv")] + " ";
    return text + step_of(row, table, "timing.csv");
  };
  for (const harness::Row& row : timing.rows) {
    double seconds = 0;
    if (harness::parse_number(row[timing.column("measured_s", "timing.csv")], seconds))
      measured[key(row, timing)] = seconds;
  }
  ByFamilyAndSolver times;
  for (const harness::Row& row : summary.rows) {
    const std::string& family = row[summary.column("family", "summary.csv")];
    if (row[outcome] != "solved" || !family.ends_with("step")) continue;
    const auto found = measured.find(key(row, summary));
    if (found == measured.end()) continue;
    times[{family, row[summary.column("method", "summary.csv")]}][step_of(row, summary, "summary.csv")] =
        found->second;
  }
  return times;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Ratio of medians over the steps of both, and how many these are.
std::pair<double, std::size_t> ratio(const Times& ours, const Times& theirs) {
  std::vector<double> a, b;
  for (const auto& [step, time] : ours) {
    const auto other = theirs.find(step);
    if (other == theirs.end()) continue;
    a.push_back(time);
    b.push_back(other->second);
  }
  if (a.empty()) return {0.0, 0};
  return {median(b) / median(a), a.size()};
}

}  // namespace

std::string describe_speed(const std::filesystem::path& folder) {
  const ByFamilyAndSolver times = solved_times(folder);
  const auto ours = times.find({"step", "elimination"});
  if (ours == times.end()) return {};
  std::string text;
  for (const std::string family : {"step", "frozen_step"}) {
    std::size_t most = 0;
    double best = 0;
    std::string best_solver;
    for (const auto& [key, theirs] : times) {
      if (key.first != family || !key.second.starts_with("siconos")) continue;
      const auto [slower, common] = ratio(ours->second, theirs);
      if (common == 0) continue;
      text += fmt::format(
          "{:12} {:24} solved {:3}, {:3} of them as steps by elimination too; median time over elimination's "
          "{:.1f}\n",
          family, key.second, theirs.size(), common, slower);
      if (common < most || (common == most && slower > best)) continue;
      most = common;
      best = slower;
      best_solver = key.second;
    }
    if (most > 0) {
      text +=
          fmt::format("{:12} best of Siconos: {}, {} steps, {:.1f} times elimination's time (demanded: 5)\n",
                      family, best_solver, most, best);
    }
  }
  return text;
}

}  // namespace touchstone::solver_comparison
