#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <regex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "core/complementarity/solver_chain.h"
#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/box_step.h"

namespace touchstone {
namespace {

using Eigen::VectorXd;

std::string read_source(const std::string& path) {
  std::ifstream file(std::string(SOURCE_ROOT) + "/" + path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// -- Each option is read --

/// All that solves of the table and of a tumbling box show: an option that nothing reads leaves it unchanged.
std::vector<double> trace(ComplementaritySolver& solver) {
  std::vector<double> numbers;
  const auto note = [&numbers](const SolveReport& report) {
    numbers.insert(numbers.end(),
                   {static_cast<double>(report.status), static_cast<double>(report.iterations),
                    static_cast<double>(report.pivots), static_cast<double>(report.evaluations),
                    report.residual, static_cast<double>(report.stages.count())});
  };
  for (const problems::TestProblem& test : problems::all_problems()) {
    for (VectorXd z : test.starts) note(solver.solve(*test.problem, z));
  }
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    testing::BoxState state;
    state.q << 0.0, 0.6 + 0.1 * uniform(engine), (i % 4 == 0 ? 0.0 : 1.6 * uniform(engine));
    state.nu << 3.0 * uniform(engine), 3.0 * uniform(engine), 6.0 * uniform(engine);
    const testing::BoxStep problem({}, state);
    VectorXd z = problem.predicted_start();
    note(solver.solve(problem, z));
  }
  return numbers;
}

template <typename Solver, typename Options>
void expect_read(const std::string& name, const Options& defaults,
                 const std::function<void(Options&)>& change) {
  Options changed = defaults;
  change(changed);
  Solver before(defaults);
  Solver after(changed);
  EXPECT_NE(trace(before), trace(after)) << name << " is read by nobody";
}

TEST(Options, EverySearchOptionIsReadByTheSemismoothMethod) {
  using Options = SemismoothNewtonOptions;
  const auto read = [](const std::string& name, const std::function<void(Options&)>& change) {
    expect_read<SemismoothNewton, Options>(name, {}, change);
  };
  read("tolerance", [](Options& o) { o.search.tolerance = 1e-4; });
  read("max_iterations", [](Options& o) { o.search.max_iterations = 5; });
  read("armijo", [](Options& o) { o.search.armijo = 0.4; });
  read("backtrack", [](Options& o) { o.search.backtrack = 0.8; });
  read("min_step", [](Options& o) { o.search.min_step = 0.4; });
  read("memory", [](Options& o) { o.search.memory = 1; });
  read("penalty", [](Options& o) { o.search.penalty = 0.7; });
  read("max_step", [](Options& o) { o.search.max_step = 1.0; });
  read("patience", [](Options& o) { o.search.patience = 3; });
  read("regularisation", [](Options& o) { o.search.regularisation = 1.0; });
  read("consistency", [](Options& o) { o.search.consistency = 0.0; });
  read("project", [](Options& o) { o.project = false; });
  read("second_search", [](Options& o) { o.second_search = false; });
}

TEST(Options, EveryOptionIsReadByThePathMethod) {
  using Options = PathNewtonOptions;
  const auto read = [](const std::string& name, const std::function<void(Options&)>& change) {
    expect_read<PathNewton, Options>(name, {}, change);
  };
  read("tolerance", [](Options& o) { o.search.tolerance = 1e-4; });
  read("max_iterations", [](Options& o) { o.search.max_iterations = 3; });
  read("armijo", [](Options& o) { o.search.armijo = 0.4; });
  read("backtrack", [](Options& o) { o.search.backtrack = 0.8; });
  read("min_step", [](Options& o) { o.search.min_step = 0.6; });
  read("memory", [](Options& o) { o.search.memory = 1; });
  read("penalty", [](Options& o) { o.search.penalty = 0.7; });
  read("max_step", [](Options& o) { o.search.max_step = 1.0; });
  read("patience", [](Options& o) { o.search.patience = 2; });
  read("regularisation", [](Options& o) { o.search.regularisation = 1.0; });
  read("consistency", [](Options& o) { o.search.consistency = 0.0; });
  read("watchdog", [](Options& o) { o.watchdog = 0; });
  read("lemke", [](Options& o) { o.lemke = false; });
  read("crash_steps", [](Options& o) { o.crash_steps = 5; });
  read("linear.max_pivots", [](Options& o) { o.linear.max_pivots = 1; });
  // The tolerances of the pivoter are tested with it: LinearPathOptions.
}

TEST(Options, EveryOptionIsReadByTheChain) {
  using Options = SolverChainOptions;
  const auto read = [](const std::string& name, const std::function<void(Options&)>& change) {
    expect_read<SolverChain, Options>(name, {}, change);
  };
  read("path", [](Options& o) { o.path.watchdog = 0; });
  read("semismooth", [](Options& o) { o.semismooth.search.memory = 1; });
  read("first", [](Options& o) { o.first = SolverKind::semismooth_newton; });
  read("second", [](Options& o) { o.second = false; });
  read("crash_steps", [](Options& o) { o.crash_steps = 0; });
  read("proximal_steps", [](Options& o) { o.proximal_steps = 1; });
  read("proximal_weight", [](Options& o) { o.proximal_weight = 100.0; });
  read("restarts", [](Options& o) { o.restarts = 2; });
  read("perturbation", [](Options& o) { o.perturbation = 2.0; });
  read("seed", [](Options& o) { o.seed = 2; });
}

TEST(Options, OneCallSetsTheToleranceOfAChain) {
  SolverChainOptions options;
  options.set_tolerance(1e-7);
  EXPECT_EQ(options.path.search.tolerance, 1e-7);
  EXPECT_EQ(options.semismooth.search.tolerance, 1e-7);
}

// -- Each option is in the list --

/// Names of the data members of `struct name { ... };` in a header.
std::vector<std::string> fields_of(const std::string& header, const std::string& name) {
  const std::string text = read_source("core/complementarity/" + header);
  const std::size_t begin = text.find("struct " + name + " {");
  const std::size_t end = text.find("\n};", begin);
  EXPECT_NE(end, std::string::npos) << name;
  const std::string body = text.substr(begin, end - begin);
  const std::regex field(R"(\n  (?:const )?[A-Za-z_:0-9]+ ([a-z_]+)(?: = [^;]+)?;)");
  std::vector<std::string> names;
  for (std::sregex_iterator at(body.begin(), body.end(), field), none; at != none; ++at)
    names.push_back((*at)[1]);
  return names;
}

TEST(Options, EveryOptionIsListedInTheReadme) {
  const std::string readme = read_source("core/complementarity/README.md");
  for (const auto& [header, name, count] : std::vector<std::tuple<std::string, std::string, std::size_t>>{
           {"merit_search.h", "SearchOptions", 11},
           {"linear_path.h", "LinearPathOptions", 3},
           {"path_newton.h", "PathNewtonOptions", 5},
           {"semismooth_newton.h", "SemismoothNewtonOptions", 3},
           {"solver_chain.h", "SolverChainOptions", 11}}) {
    const std::size_t begin = readme.find("### " + name);
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = readme.substr(begin, readme.find("\n###", begin + 1) - begin);
    const std::vector<std::string> fields = fields_of(header, name);
    EXPECT_EQ(fields.size(), count) << name;
    for (const std::string& field : fields)
      EXPECT_NE(section.find("`" + field + "`"), std::string::npos) << name << "." << field;
  }
}

// -- Bad values are refused by name --

void expect_refused(const std::function<void()>& construct, const std::vector<std::string>& parts) {
  try {
    construct();
    ADD_FAILURE() << "accepted " << parts[0];
  } catch (const std::invalid_argument& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << " lacks " << part;
    }
  }
}

TEST(Options, BadSearchOptionsAreRefusedWithFieldValueAndBound) {
  const auto refused = [](void (*change)(SearchOptions&), const std::vector<std::string>& parts) {
    PathNewtonOptions path;
    change(path.search);
    expect_refused([&] { PathNewton solver(path); }, parts);
    SemismoothNewtonOptions semismooth;
    change(semismooth.search);
    expect_refused([&] { SemismoothNewton solver(semismooth); }, parts);
    SolverChainOptions chain;
    change(chain.semismooth.search);
    expect_refused([&] { SolverChain solver(chain); }, parts);
  };
  refused([](SearchOptions& o) { o.tolerance = -1e-3; }, {"SearchOptions.tolerance", "-0.001", "> 0"});
  refused([](SearchOptions& o) { o.tolerance = nan; }, {"SearchOptions.tolerance", "nan", "> 0"});
  refused([](SearchOptions& o) { o.tolerance = infinity; }, {"SearchOptions.tolerance", "inf", "finite"});
  refused([](SearchOptions& o) { o.max_iterations = 0; }, {"SearchOptions.max_iterations", "= 0", ">= 1"});
  refused([](SearchOptions& o) { o.armijo = 0.6; }, {"SearchOptions.armijo", "0.6", "(0, 0.5]"});
  refused([](SearchOptions& o) { o.backtrack = 1.0; }, {"SearchOptions.backtrack", "= 1", "(0, 0.9]"});
  refused([](SearchOptions& o) { o.min_step = nan; }, {"SearchOptions.min_step", "nan", "(0, 1]"});
  refused([](SearchOptions& o) { o.memory = 17; }, {"SearchOptions.memory", "17", "[1, 16]"});
  refused([](SearchOptions& o) { o.penalty = 0.0; }, {"SearchOptions.penalty", "= 0", "(0, 1]"});
  refused([](SearchOptions& o) { o.max_step = -1.0; }, {"SearchOptions.max_step", "-1", "> 0"});
  refused([](SearchOptions& o) { o.patience = -2; }, {"SearchOptions.patience", "-2", ">= 1"});
  refused([](SearchOptions& o) { o.regularisation = nan; }, {"SearchOptions.regularisation", "nan", "> 0"});
  refused([](SearchOptions& o) { o.consistency = nan; }, {"SearchOptions.consistency", "nan", "[0, 0.5]"});
}

TEST(Options, BadSolverOptionsAreRefusedWithFieldValueAndBound) {
  const auto path = [](void (*change)(PathNewtonOptions&), const std::vector<std::string>& parts) {
    PathNewtonOptions options;
    change(options);
    expect_refused([&] { PathNewton solver(options); }, parts);
  };
  path([](PathNewtonOptions& o) { o.watchdog = -1; }, {"PathNewtonOptions.watchdog", "-1", "[0, 16]"});
  path([](PathNewtonOptions& o) { o.linear.max_pivots = -5; },
       {"LinearPathOptions.max_pivots", "-5", ">= 0"});
  path([](PathNewtonOptions& o) { o.linear.tie_tolerance = nan; },
       {"LinearPathOptions.tie_tolerance", "nan", "0.001]"});
  path([](PathNewtonOptions& o) { o.linear.pivot_tolerance = 0; },
       {"LinearPathOptions.pivot_tolerance", "= 0", "(0,"});
  const auto chain = [](void (*change)(SolverChainOptions&), const std::vector<std::string>& parts) {
    SolverChainOptions options;
    change(options);
    expect_refused([&] { SolverChain solver(options); }, parts);
  };
  path([](PathNewtonOptions& o) { o.crash_steps = 101; },
       {"PathNewtonOptions.crash_steps", "101", "[0, 100]"});
  chain([](SolverChainOptions& o) { o.crash_steps = -1; },
        {"SolverChainOptions.crash_steps", "-1", "[0, 100]"});
  chain([](SolverChainOptions& o) { o.largest_pivoting = -1; },
        {"SolverChainOptions.largest_pivoting", "-1", ">= 0"});
  chain([](SolverChainOptions& o) { o.proximal_steps = 17; },
        {"SolverChainOptions.proximal_steps", "17", "[0, 16]"});
  chain([](SolverChainOptions& o) { o.proximal_weight = 0; },
        {"SolverChainOptions.proximal_weight", "= 0", "> 0"});
  chain([](SolverChainOptions& o) { o.restarts = -1; }, {"SolverChainOptions.restarts", "-1", "[0, 64]"});
  chain([](SolverChainOptions& o) { o.perturbation = nan; },
        {"SolverChainOptions.perturbation", "nan", "> 0"});
}

}  // namespace
}  // namespace touchstone
