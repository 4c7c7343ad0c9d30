#include "experiments/solver_comparison/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "experiments/harness/files.h"
#include "experiments/solver_comparison/speed.h"

namespace touchstone::solver_comparison {

using harness::number_cell;
using harness::Row;
using harness::Table;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Key = std::vector<std::string>;

/// The cells of these columns.
Key cells(const Table& table, const Row& row, const std::vector<const char*>& columns,
          const std::string& file) {
  Key key;
  for (const char* column : columns) key.push_back(row[table.column(column, file)]);
  return key;
}

Key problem_of(const Effort& effort) { return {effort.family, effort.scenario, effort.problem}; }

double number_or(const std::string& cell, double otherwise) {
  double value = otherwise;
  return harness::parse_number(cell, value) ? value : otherwise;
}

std::string describe_shares(const std::vector<Effort>& efforts) {
  std::map<Key, std::pair<int, int>> counts;  // family and method: solved, of how many
  for (const Effort& effort : efforts) {
    auto& [solved, all] = counts[{effort.family, effort.method}];
    solved += effort.solved ? 1 : 0;
    ++all;
  }
  std::string text;
  for (const auto& [key, count] : counts)
    text += fmt::format("{:12} {:24} solves {:3} of {:3}\n", key[0], key[1], count.first, count.second);
  return text;
}

}  // namespace

std::vector<Effort> read_efforts(const std::filesystem::path& folder) {
  const std::string names[] = {"summary.csv", "solve_timing.csv"};
  const std::vector<const char*> identity = {"family", "scenario", "item", "size", "start", "method"};
  const Table summary = harness::read_csv(folder / names[0]);
  const Table timing = harness::read_csv(folder / names[1]);
  std::map<Key, const Row*> times;
  for (const Row& row : timing.rows) times[cells(timing, row, identity, names[1])] = &row;
  std::vector<Effort> efforts;
  for (const Row& row : summary.rows) {
    const auto cell = [&](const char* column) { return row[summary.column(column, names[0])]; };
    if (cell("solvable") != "yes" || cell("status") == "skipped") continue;
    Effort effort{.family = cell("family"),
                  .scenario = cell("scenario"),
                  .start = cell("start"),
                  .problem = fmt::format("{} {} {}", cell("item"), cell("size"), cell("start")),
                  .method = cell("method"),
                  .solved = cell("outcome") == "solved",
                  .iterations = number_or(cell("iterations"), Effort{}.iterations),
                  .steps = static_cast<long>(number_or(cell("problems"), 1.0))};
    const auto found = times.find(cells(summary, row, identity, names[0]));
    if (found != times.end()) {
      const auto time = [&](const char* column) {
        return number_or((*found->second)[timing.column(column, names[1])], Effort{}.seconds);
      };
      effort.seconds = time("solve_s");
      effort.mean_seconds = time("total_s") / static_cast<double>(effort.steps);
    }
    efforts.push_back(std::move(effort));
  }
  return efforts;
}

Table performance_profile(const std::vector<Effort>& efforts, double Effort::*cost, double least) {
  std::map<Key, double> cheapest;
  std::map<std::string, std::set<Key>> problems;  // of each family
  for (const Effort& effort : efforts) {
    problems[effort.family].insert(problem_of(effort));
    if (!effort.solved) continue;
    double& best = cheapest.try_emplace(problem_of(effort), kInfinity).first->second;
    best = std::min(best, std::max(effort.*cost, least));
  }
  std::map<Key, std::vector<double>> ratios;  // of each family and method, ascending
  for (const Effort& effort : efforts) {
    std::vector<double>& own = ratios[{effort.family, effort.method}];
    if (effort.solved) own.push_back(std::max(effort.*cost, least) / cheapest.at(problem_of(effort)));
  }
  Table table{{"family", "method", "ratio", "share"}, {}};
  for (auto& [key, own] : ratios) {
    std::ranges::sort(own);
    const auto all = static_cast<double>(problems.at(key[0]).size());
    if (own.empty() || own.front() > 1.0) table.rows.push_back({key[0], key[1], "1", "0"});
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (i + 1 < own.size() && own[i + 1] == own[i]) continue;
      table.rows.push_back(
          {key[0], key[1], number_cell(own[i]), number_cell(static_cast<double>(i + 1) / all)});
    }
  }
  harness::sort_rows(table);
  return table;
}

std::string write_profiles(const std::filesystem::path& folder) {
  const std::vector<Effort> efforts = read_efforts(folder);
  std::vector<Effort> single = efforts;  // a trajectory is no problem like the others
  std::erase_if(single, [](const Effort& effort) { return effort.family == "trajectory"; });
  const Table speed = speed_ratios(single);
  const Table trajectories = trajectory_ratios(efforts);
  constexpr double kClock = 1e-8;  // [s]; what the clock cannot tell from nothing
  harness::write_files(
      {{folder / "profile.csv", format_csv(performance_profile(single, &Effort::iterations, 1.0))},
       {folder / "profile_timing.csv", format_csv(performance_profile(single, &Effort::seconds, kClock))},
       {folder / "speed_timing.csv", format_csv(speed)},
       {folder / "trajectory_timing.csv", format_csv(trajectories)}});
  return describe_shares(efforts) + describe_speed(speed) + describe_trajectories(trajectories);
}

}  // namespace touchstone::solver_comparison
