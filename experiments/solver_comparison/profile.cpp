#include "experiments/solver_comparison/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "experiments/harness/files.h"

namespace touchstone::solver_comparison {

using harness::number_cell;
using harness::Row;
using harness::Table;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Key = std::vector<std::string>;

bool is_siconos(const std::string& method) { return method.starts_with("siconos"); }

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

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Our time and the best of theirs on a problem.
struct Pair {
  double ours = 0.0;
  double theirs = kInfinity;
  std::string best;
};

std::string most_frequent(const std::vector<Pair>& pairs) {
  std::map<std::string, int> counts;
  for (const Pair& pair : pairs) ++counts[pair.best];
  return std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
}

Row speed_row(const Key& group, const std::vector<Pair>& all) {
  std::vector<Pair> pairs;
  std::vector<double> ours, theirs, ratios;
  for (const Pair& pair : all) {
    if (pair.theirs == kInfinity) continue;
    pairs.push_back(pair);
    ours.push_back(pair.ours);
    theirs.push_back(pair.theirs);
    ratios.push_back(pair.theirs / pair.ours);
  }
  Row row = group;
  row.push_back(number_cell(static_cast<long>(all.size())));
  row.push_back(number_cell(static_cast<long>(pairs.size())));
  if (pairs.empty()) {
    row.resize(row.size() + 6);
    return row;
  }
  const auto [smallest, largest] = std::ranges::minmax(ratios);
  for (const double value : {median(ratios), smallest, largest, median(ours), median(theirs)})
    row.push_back(number_cell(value));
  row.push_back(most_frequent(pairs));
  return row;
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

std::string describe_speed(const Table& speed) {
  std::string text;
  for (const Row& row : speed.rows) {
    const auto number = [&](std::size_t column) { return number_or(row[column], 0.0); };
    if (!row[1].empty() || row[5].empty()) continue;
    text += fmt::format(
        "{:12} {:24} Siconos's fastest takes {:.1f} times as long, median over {} problems ({:.2g} to "
        "{:.2g})\n",
        row[0], row[2], number(5), row[4], number(6), number(7));
  }
  return text;
}

}  // namespace

std::vector<Effort> read_efforts(const std::filesystem::path& folder) {
  const std::string names[] = {"summary.csv", "solve_timing.csv"};
  const std::vector<const char*> identity = {"family", "scenario", "item", "size", "start", "method"};
  const Table summary = harness::read_csv(folder / names[0]);
  const Table timing = harness::read_csv(folder / names[1]);
  std::map<Key, double> seconds;
  for (const Row& row : timing.rows) {
    seconds[cells(timing, row, identity, names[1])] =
        number_or(row[timing.column("solve_s", names[1])], Effort{}.seconds);
  }
  std::vector<Effort> efforts;
  for (const Row& row : summary.rows) {
    const auto cell = [&](const char* column) { return row[summary.column(column, names[0])]; };
    if (cell("solvable") != "yes" || cell("status") == "skipped") continue;
    Effort effort{.family = cell("family"),
                  .scenario = cell("scenario"),
                  .problem = fmt::format("{} {} {}", cell("item"), cell("size"), cell("start")),
                  .method = cell("method"),
                  .solved = cell("outcome") == "solved",
                  .iterations = number_or(cell("iterations"), Effort{}.iterations)};
    const auto found = seconds.find(cells(summary, row, identity, names[0]));
    if (found != seconds.end()) effort.seconds = found->second;
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

Table speed_ratios(const std::vector<Effort>& efforts) {
  std::map<Key, std::pair<double, std::string>> best;
  for (const Effort& effort : efforts) {
    if (!effort.solved || !is_siconos(effort.method)) continue;
    auto& one = best.try_emplace(problem_of(effort), kInfinity, "").first->second;
    if (effort.seconds < one.first) one = {effort.seconds, effort.method};
  }
  std::map<Key, std::vector<Pair>> groups;
  for (const Effort& effort : efforts) {
    if (!effort.solved || is_siconos(effort.method)) continue;
    Pair pair{.ours = effort.seconds, .theirs = kInfinity, .best = {}};
    if (const auto found = best.find(problem_of(effort)); found != best.end())
      std::tie(pair.theirs, pair.best) = found->second;
    groups[{effort.family, "", effort.method}].push_back(pair);
    if (effort.family.ends_with("step"))
      groups[{effort.family, effort.scenario, effort.method}].push_back(pair);
  }
  Table table{{"family", "scenario", "method", "solved", "compared", "median_ratio", "smallest_ratio",
               "largest_ratio", "median_s", "median_best_s", "most_often_best"},
              {}};
  for (const auto& [group, pairs] : groups) table.rows.push_back(speed_row(group, pairs));
  harness::sort_rows(table);
  return table;
}

std::string write_profiles(const std::filesystem::path& folder) {
  const std::vector<Effort> efforts = read_efforts(folder);
  const Table speed = speed_ratios(efforts);
  constexpr double kClock = 1e-8;  // [s]; what the clock cannot tell from nothing
  harness::write_files(
      {{folder / "profile.csv", format_csv(performance_profile(efforts, &Effort::iterations, 1.0))},
       {folder / "profile_timing.csv", format_csv(performance_profile(efforts, &Effort::seconds, kClock))},
       {folder / "speed_timing.csv", format_csv(speed)}});
  return describe_shares(efforts) + describe_speed(speed);
}

}  // namespace touchstone::solver_comparison
