// Solves contact steps at random with the implicit NCP and holds each answer to Eqs. 10-11 by the independent
// checker, at 1e-10. An answer that is called solved and does not hold is a fault; a step that is not solved
// is counted, by its reason, and may have no solution.
//   certify_steps --count 100000 --seed 1 --jobs 2 --dump /tmp/dumps
// Every third step is planar. Exit codes: 0 no false answer, 1 there are some, 2 bad usage.

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "baselines/isolation.h"
#include "tests/support/random_steps.h"
#include "tests/support/step_fault.h"

namespace {

using namespace touchstone;
using random_steps::RandomStep;

constexpr double kTolerance = 1e-10;

enum class Verdict {
  certified,
  certified_but_for_rounding,  ///< of the numbers that tell the answer (certificate::Missed)
  falsely_converged,
  not_solved,
  out_of_time,
  broken
};

constexpr std::array kVerdicts = {
    "certified", "certified_but_for_rounding", "falsely_converged", "not_solved", "out_of_time", "broken"};

struct Result {
  Verdict verdict = Verdict::certified;
  std::string reason;
  int dimension = 3;
  int bodies = 0;    ///< that move
  int contacts = 0;  ///< in the step's problem; of one not solved, in the last one tried
  double mu = 0.0;
  std::string shapes;
};

template <int Dim>
void judge(const RandomStep<Dim>& step, Result& result) {
  ImplicitStepper<Dim> stepper(step.scene, {});
  const std::vector<BodyState<Dim>> before(stepper.state().begin(), stepper.state().end());
  const StepReport report = stepper.step(step.h);
  result.contacts = static_cast<int>(stepper.problem().contacts().size());
  if (report.status != StepStatus::solved) {
    result.verdict = Verdict::not_solved;
    result.reason = fmt::format("{}, residual {:.0e}", report.reason, report.residual);
    return;
  }
  const auto fault = step_fault(stepper, before, step.h, kTolerance);
  if (!fault) return;
  result.verdict = fault->is_rounding ? Verdict::certified_but_for_rounding : Verdict::falsely_converged;
  result.reason = fault->description;
}

/// The verdict as a process tells it to the other: "2 6 stalled, residual 6e-13".
std::string text(const Result& result) {
  return fmt::format("{} {} {}", static_cast<int>(result.verdict), result.contacts, result.reason);
}
void read(const std::string& text, Result& result) {
  std::istringstream in(text);
  int verdict = 0;
  in >> verdict >> result.contacts;
  result.verdict = static_cast<Verdict>(verdict);
  std::getline(in >> std::ws, result.reason);
}

/// Solves in a process of its own, with a limit of processor time, because a step may take minutes of pivots
/// before it is given up, and a crash is to cost that step alone.
template <int Dim>
void judge_apart(const RandomStep<Dim>& step, unsigned seconds, Result& result) {
  constexpr double kWaiting = 100;  // wall time over processor time on a machine that is busy
  const IsolatedResult outcome = run_isolated(
      [&] {
        const rlimit limit{seconds, seconds};
        setrlimit(RLIMIT_CPU, &limit);
        judge(step, result);
        return text(result);
      },
      std::chrono::duration<double>(kWaiting * seconds));
  if (outcome.outcome == Outcome::finished) return read(outcome.text, result);
  // At a limit that is hard as well as soft the process is killed outright.
  const bool killed =
      outcome.outcome == Outcome::timed_out ||
      (outcome.outcome == Outcome::crashed && outcome.text.find(strsignal(SIGKILL)) != std::string::npos);
  result.verdict = killed ? Verdict::out_of_time : Verdict::broken;
  result.reason = killed ? fmt::format("more than {} s of processor time", seconds) : outcome.text;
}

template <int Dim>
Result solve(std::uint64_t seed, unsigned seconds, const std::filesystem::path& dump) {
  const RandomStep<Dim> step = random_steps::random_step<Dim>(seed);
  Result result;
  result.dimension = Dim;
  for (const auto& body : step.scene.bodies) result.bodies += body.fixed ? 0 : 1;
  result.mu = step.scene.contact_law.mu;
  result.shapes = random_steps::shapes_of(step.scene);
  judge_apart(step, seconds, result);
  if (result.verdict != Verdict::certified && !dump.empty()) {
    const char* verdict = kVerdicts[static_cast<std::size_t>(result.verdict)];
    std::ofstream(dump / fmt::format("{}_{}.toml", verdict, seed))
        << fmt::format("# h = {}\n# seed {}: {}\n\n", step.h, seed, result.reason)
        << random_steps::write_scene(step.scene);
  }
  return result;
}

/// Counts by verdict and, of one property, by its value.
class Tally {
 public:
  void add(const Result& r) {
    ++total_[r.verdict];
    const std::string dimension = fmt::format("{}D ", r.dimension);
    count(0, dimension + fmt::format("{} bodies", r.bodies), r.verdict);
    count(1, dimension + fmt::format("{:2} contacts", r.contacts), r.verdict);
    count(2,
          dimension + (r.mu == 0    ? "mu = 0"
                       : r.mu < 0.5 ? "mu < 0.5"
                       : r.mu < 1   ? "mu < 1"
                                    : "mu < 2"),
          r.verdict);
    for (std::size_t from = 0; from < r.shapes.size();) {
      const std::size_t comma = std::min(r.shapes.find(',', from), r.shapes.size());
      count(3, dimension + r.shapes.substr(from, comma - from), r.verdict);
      from = comma + 1;
    }
    if (r.verdict == Verdict::certified) return;
    // Without names and numbers reasons are few.
    const std::size_t cut = std::min(r.reason.find(" of "), r.reason.find(", residual"));
    ++reasons_[fmt::format("{}: {}", kVerdicts[static_cast<std::size_t>(r.verdict)],
                           r.reason.substr(0, cut))];
  }

  [[nodiscard]] long count(Verdict verdict) const {
    const auto found = total_.find(verdict);
    return found == total_.end() ? 0 : found->second;
  }

  void print() const {
    for (std::size_t v = 0; v < kVerdicts.size(); ++v)
      fmt::print("{:26} {}\n", kVerdicts[v], count(static_cast<Verdict>(v)));
    for (const auto& [reason, n] : reasons_) fmt::print("  {:8} {}\n", n, reason);
    static constexpr std::array kProperties = {"bodies that move", "contacts", "friction", "with a"};
    for (std::size_t p = 0; p < kProperties.size(); ++p) {
      fmt::print("\n{:28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", kProperties[p], "certified", "rounding",
                 "false", "unsolved", "time", "broken");
      for (const auto& [value, verdicts] : by_[p]) {
        fmt::print("{:28}", value);
        for (const long n : verdicts) fmt::print(" {:9}", n);
        fmt::print("\n");
      }
    }
  }

 private:
  void count(std::size_t property, const std::string& value, Verdict verdict) {
    ++by_[property][value][static_cast<std::size_t>(verdict)];
  }

  std::map<Verdict, long> total_;
  std::map<std::string, long> reasons_;
  std::array<std::map<std::string, std::array<long, kVerdicts.size()>>, 4> by_;
};

}  // namespace

int main(int argc, char** argv) {
  long count = 10000;
  std::uint64_t seed = 1;
  unsigned jobs = 1;
  unsigned seconds = 10;
  long most_unsolved = -1;
  std::filesystem::path dump;
  CLI::App app("Solves contact steps at random and certifies each answer", "certify_steps");
  app.add_option("--count", count, "number of steps")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--seed", seed, "number of the first step")->capture_default_str();
  app.add_option("--jobs", jobs, "threads")->check(CLI::Range(1U, 256U))->capture_default_str();
  app.add_option("--seconds", seconds, "processor time for one step")
      ->check(CLI::Range(1U, 3600U))
      ->capture_default_str();
  app.add_option("--dump", dump, "folder for the scenes of steps that are not certified");
  app.add_option("--most-unsolved", most_unsolved, "fail if more steps than these are not solved");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!dump.empty()) std::filesystem::create_directories(dump);

  Tally tally;
  std::mutex mutex;
  std::atomic<long> next = 0;
  const auto work = [&] {
    for (long k = next++; k < count; k = next++) {
      const std::uint64_t number = seed + static_cast<std::uint64_t>(k);
      const Result result =
          number % 3 == 0 ? solve<2>(number, seconds, dump) : solve<3>(number, seconds, dump);
      const std::lock_guard lock(mutex);
      tally.add(result);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned j = 1; j < jobs; ++j) threads.emplace_back(work);
    work();
  }
  tally.print();
  const long unsolved = tally.count(Verdict::not_solved) + tally.count(Verdict::out_of_time);
  const bool too_many = most_unsolved >= 0 && unsolved > most_unsolved;
  const long wrong = tally.count(Verdict::falsely_converged) + tally.count(Verdict::broken);
  return wrong > 0 || too_many ? 1 : 0;
}
