#include "experiments/solver_comparison/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/solver_comparison/timing.h"

namespace touchstone::solver_comparison {

using harness::number_cell;
using harness::Row;
using harness::Table;

namespace {

bool is_siconos(const std::string& method) { return method.starts_with("siconos"); }

using Key = std::vector<std::string>;

double number_in(const std::string& cell) {
  double value = 0.0;
  harness::parse_number(cell, value);
  return value;
}

/// One problem that ours solves, and what each of Siconos's that solves it too takes.
struct Comparison {
  double ours = 0.0;
  std::map<std::string, double> theirs;
};

/// The one with the least value.
const std::pair<const std::string, double>& least(const std::map<std::string, double>& values) {
  return *std::ranges::min_element(values, {}, [](const auto& entry) { return entry.second; });
}

/// Of the solvers that solve all of these: the median of their ratios to ours.
std::map<std::string, double> ratios_of_single(const std::vector<Comparison>& comparisons) {
  std::map<std::string, std::vector<double>> ratios;
  for (const Comparison& one : comparisons) {
    for (const auto& [solver, seconds] : one.theirs) ratios[solver].push_back(seconds / one.ours);
  }
  std::map<std::string, double> medians;
  for (const auto& [solver, own] : ratios) {
    if (own.size() == comparisons.size()) medians[solver] = median(own);
  }
  return medians;
}

/// compared to most_often_best.
void add_best_of_each(const std::vector<Comparison>& comparisons, Row& row) {
  std::vector<double> ours, theirs, ratios;
  std::map<std::string, double> often;  // as negative numbers, so that the least is the most frequent
  for (const Comparison& one : comparisons) {
    if (one.theirs.empty()) continue;
    const auto& [solver, seconds] = least(one.theirs);
    ours.push_back(one.ours);
    theirs.push_back(seconds);
    ratios.push_back(seconds / one.ours);
    often[solver] -= 1;
  }
  row.push_back(number_cell(static_cast<long>(ratios.size())));
  if (ratios.empty()) {
    row.resize(row.size() + 6);
    return;
  }
  const auto [smallest, largest] = std::ranges::minmax(ratios);
  for (const double value : {median(ratios), smallest, largest, median(ours), median(theirs)})
    row.push_back(number_cell(value));
  row.push_back(least(often).first);
}

/// single_best to single_median_s.
void add_single_best(const std::vector<Comparison>& comparisons, Row& row) {
  const std::map<std::string, double> single = ratios_of_single(comparisons);
  if (single.empty()) {
    row.resize(row.size() + 3);
    return;
  }
  const auto& [solver, ratio] = least(single);
  std::vector<double> seconds;
  for (const Comparison& one : comparisons) seconds.push_back(one.theirs.at(solver));
  row.insert(row.end(), {solver, number_cell(ratio), number_cell(median(std::move(seconds)))});
}

/// Of one of our solvers on all scenes, and of all of theirs from one start.
class TrajectoryGroup {
 public:
  TrajectoryGroup(std::string method, std::string start, std::string siconos_start)
      : method_(std::move(method)), start_(std::move(start)), siconos_start_(std::move(siconos_start)) {}

  void add(const std::string& scenario, const Effort& ours, const std::map<std::string, Effort>& theirs) {
    std::map<std::string, double> seconds;
    for (const auto& [solver, effort] : theirs) seconds[solver] = effort.seconds;
    comparisons_.push_back({ours.seconds, seconds});
    scenes_.push_back({scenario, ours, theirs});
  }

  [[nodiscard]] std::vector<Row> rows() const {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      const auto& theirs = comparisons_[i].theirs;
      rows.push_back(row(scenes_[i], theirs.empty() ? "" : least(theirs).first));
    }
    rows.push_back(all_scenes());
    return rows;
  }

 private:
  struct Scene {
    std::string scenario;
    Effort ours;
    std::map<std::string, Effort> theirs;
  };

  [[nodiscard]] Row head(const std::string& scenario, long steps) const {
    return {scenario, method_, start_, siconos_start_, number_cell(steps)};
  }

  [[nodiscard]] Row row(const Scene& scene, const std::string& solver) const {
    Row row = head(scene.scenario, scene.ours.steps);
    row.insert(row.end(), {number_cell(scene.ours.seconds), number_cell(scene.ours.mean_seconds), solver});
    if (solver.empty()) {
      row.resize(row.size() + 4);
      return row;
    }
    const Effort& theirs = scene.theirs.at(solver);
    for (const double value : {theirs.seconds, theirs.mean_seconds, theirs.seconds / scene.ours.seconds,
                               theirs.mean_seconds / scene.ours.mean_seconds})
      row.push_back(number_cell(value));
    return row;
  }

  [[nodiscard]] Row all_scenes() const {
    long steps = 0;
    for (const Scene& scene : scenes_) steps += scene.ours.steps;
    Row row = head("", steps);
    const std::map<std::string, double> single = ratios_of_single(comparisons_);
    row.resize(row.size() + 2);  // a median over scenes of their times says nothing
    if (single.empty()) {
      row.resize(row.size() + 5);
      return row;
    }
    const auto& [solver, ratio] = least(single);
    std::vector<double> of_means;
    for (const Scene& scene : scenes_)
      of_means.push_back(scene.theirs.at(solver).mean_seconds / scene.ours.mean_seconds);
    row.push_back(solver);
    row.resize(row.size() + 2);
    row.insert(row.end(), {number_cell(ratio), number_cell(median(std::move(of_means)))});
    return row;
  }

  std::string method_, start_, siconos_start_;
  std::vector<Comparison> comparisons_;
  std::vector<Scene> scenes_;
};

}  // namespace

Table speed_ratios(const std::vector<Effort>& efforts) {
  const auto problem_of = [](const Effort& effort) {
    return Key{effort.family, effort.scenario, effort.problem};
  };
  std::map<Key, std::map<std::string, double>> theirs;
  for (const Effort& effort : efforts) {
    if (effort.solved && is_siconos(effort.method))
      theirs[problem_of(effort)][effort.method] = effort.seconds;
  }
  std::map<Key, std::vector<Comparison>> groups;
  for (const Effort& effort : efforts) {
    if (!effort.solved || is_siconos(effort.method)) continue;
    const Comparison one{effort.seconds, theirs[problem_of(effort)]};
    groups[{effort.family, "", "", effort.method}].push_back(one);
    if (!effort.family.ends_with("step")) continue;
    const std::set<Key> parts = {{effort.family, effort.scenario, "", effort.method},
                                 {effort.family, "", effort.start, effort.method},
                                 {effort.family, effort.scenario, effort.start, effort.method}};
    for (const Key& part : parts) groups[part].push_back(one);
  }
  Table table{{"family", "scenario", "start", "method", "solved", "compared", "median_ratio",
               "smallest_ratio", "largest_ratio", "median_s", "median_best_s", "most_often_best",
               "single_best", "single_ratio", "single_median_s"},
              {}};
  for (const auto& [group, comparisons] : groups) {
    Row row = group;
    row.push_back(number_cell(static_cast<long>(comparisons.size())));
    add_best_of_each(comparisons, row);
    add_single_best(comparisons, row);
    table.rows.push_back(std::move(row));
  }
  harness::sort_rows(table);
  return table;
}

Table trajectory_ratios(const std::vector<Effort>& efforts) {
  std::map<Key, std::map<std::string, Effort>> theirs;  // by scene and start
  for (const Effort& effort : efforts) {
    if (effort.family == "trajectory" && effort.solved && is_siconos(effort.method))
      theirs[{effort.scenario, effort.start}][effort.method] = effort;
  }
  std::map<Key, TrajectoryGroup> groups;
  for (const Effort& effort : efforts) {
    if (effort.family != "trajectory" || !effort.solved || is_siconos(effort.method)) continue;
    for (const std::string& start : std::set<std::string>{effort.start, "last"}) {
      const Key key = {effort.method, effort.start, start};
      TrajectoryGroup& group = groups.try_emplace(key, effort.method, effort.start, start).first->second;
      group.add(effort.scenario, effort, theirs[{effort.scenario, start}]);
    }
  }
  Table table{{"scenario", "method", "start", "siconos_start", "steps", "median_s", "mean_s", "siconos_best",
               "siconos_median_s", "siconos_mean_s", "median_ratio", "mean_ratio"},
              {}};
  for (const auto& [key, group] : groups) {
    for (Row& row : group.rows()) table.rows.push_back(std::move(row));
  }
  harness::sort_rows(table);
  return table;
}

std::string describe_speed(const Table& speed) {
  std::string text;
  for (const Row& row : speed.rows) {
    const auto cell = [&](const char* column) { return row[speed.column(column, "speed")]; };
    const auto number = [&](const char* column) { return number_in(cell(column)); };
    if (!cell("scenario").empty() || cell("median_ratio").empty()) continue;
    if (!cell("start").empty() && cell("family") != "step") continue;  // there is but one
    const std::string start = cell("start").empty() ? "" : ", " + cell("start") + " start";
    text += fmt::format(
        "{:12} {:18} Siconos's fastest on each of {} problems{} takes {:.2g} times as long ({:.2g} to "
        "{:.2g})",
        cell("family"), cell("method"), cell("compared"), start, number("median_ratio"),
        number("smallest_ratio"), number("largest_ratio"));
    text += cell("single_best").empty()
                ? fmt::format("; none solves all {}\n", cell("solved"))
                : fmt::format("; {} solves all {}: {:.2g} times\n", cell("single_best"), cell("solved"),
                              number("single_ratio"));
  }
  return text;
}

std::string describe_trajectories(const Table& trajectories) {
  const auto cell = [&](const Row& row, const char* column) {
    return row[trajectories.column(column, "trajectories")];
  };
  std::map<std::string, std::map<Key, const Row*>> scenes;
  for (const Row& row : trajectories.rows) {
    const Key pair = {cell(row, "method"), cell(row, "start"), cell(row, "siconos_start")};
    if (!cell(row, "siconos_best").empty()) scenes[cell(row, "scenario")][pair] = &row;
  }
  std::string text;
  for (const auto& scene : scenes) {
    const std::string& scenario = scene.first;  // clang lets no lambda capture a structured binding
    const auto& rows = scene.second;
    std::string line;
    const auto add = [&](const Key& pair, const char* what) {
      const auto found = rows.find(pair);
      if (found == rows.end()) return;
      const Row& row = *found->second;
      if (line.empty()) line = fmt::format("{} takes", cell(row, "siconos_best"));
      line += fmt::format(" {:.2g} times {},", number_in(cell(row, "median_ratio")), what);
    };
    add({"elimination", "last", "last"}, "elimination's time, both from the last solution");
    add({"elimination", "extrapolated", "extrapolated"}, "both from the extrapolated start");
    add({"elimination", "extrapolated", "last"}, "from the last solution beside ours extrapolated");
    add({"implicit_stepper", "extrapolated", "last"}, "the stepper's whole step");
    if (line.empty()) continue;
    line.back() = '\n';
    text += fmt::format("trajectory   {:22} {}", scenario.empty() ? "all scenes" : scenario, line);
  }
  return text;
}

}  // namespace touchstone::solver_comparison
