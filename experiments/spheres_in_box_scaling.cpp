// Question: how do the time of a step and the memory grow with the number of contacts?
// Success criterion: time in proportion to contacts^a with a <= 1.2, by least squares on the logarithms over
// n = 10 ... 3000 spheres in a tray, where nothing but their number grows; every step solved, Eqs. 10-11 to
// 1e-10 by the judge. In a cube heaps get deeper as well, and where they meet changes with n: its exponent is
// told beside. A heap is one sample of many, and its steps may take half or twice the time of another's of
// as many spheres, so there are several of each n in trays, and one in cubes, some of which take minutes for
// a step. Time is the processor's, the median over the second half of the steps of all of them, in which the
// spheres meet; of each step the shortest of several passes over all heaps, as what else the machine does at
// times only lengthens it, and where memory is what a step waits for that is by half. Contacts, those with an
// impulse, are the mean over the same steps. Memory is the largest resident set of a process that ran one
// heap, with nothing else in it but scene, stepper and judge. The table is another one on each machine and at
// each time.

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <numeric>

#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/csv.h"
#include "experiments/harness/files.h"
#include "experiments/harness/judge.h"
#include "experiments/scenarios/spheres_in_box.h"

namespace {

using namespace touchstone;

constexpr double kStep = 0.01;      // [s]
constexpr int kSteps = 20;          // as long as the default horizon of spheres_in_box
constexpr int kLayers = 4;          // of the tray
constexpr int kTimed = kSteps / 2;  // the later ones
constexpr int kSpheres = 4000;      // of all trays of one n together, if these are not too few or too many:
constexpr int kFewestHeaps = 2;
constexpr int kMostHeaps = 8;
constexpr int kPasses = 3;
constexpr long kBytesOfKilobyte = 1024;  // ru_maxrss is in KiB

/// What a process tells of its heap: plain data, for it goes through a pipe.
struct Heap {
  int steps = 0;  ///< solved
  int timed = 0;  ///< of them, those told of here:
  std::array<double, kTimed> step_s{}, contacts{}, listed{}, iterations{};
  double residual = 0.0;  ///< largest of all steps
  double memory_bytes = 0.0;
};

/// Of all heaps of one n.
struct Measured {
  int layers = 0;
  int spheres = 0;
  int heaps = 0;
  int steps = 0;  ///< solved
  double contacts = 0.0;
  double listed = 0.0;
  double iterations = 0.0;  ///< a step
  double step_s = 0.0;
  double slowest_s = 0.0;
  double residual = 0.0;
  double memory_bytes = 0.0;  ///< of the largest

  [[nodiscard]] int planned() const { return heaps * kSteps; }
};

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Heap measure(int layers, int spheres, int seed) {
  SpheresInBox box;
  box.spheres = spheres;
  box.layers = layers;
  box.seed = static_cast<std::uint64_t>(seed);
  const Scene<3> scene = spheres_in_box_scene(box);
  ImplicitStepper<3> stepper(scene, {});
  const Judge<3> judge(scene);
  Heap heap;
  std::vector<BodyState<3>> before;
  for (int k = 0; k < kSteps; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    const double start = processor_time();
    const StepReport report = stepper.step(kStep);
    const double took = processor_time() - start;
    if (report.status != StepStatus::solved) break;
    ++heap.steps;
    heap.residual = std::max(
        heap.residual, judge.step_residual(before, stepper.state(), stepper.contacts(), kStep).largest());
    if (k < kSteps - kTimed) continue;
    const auto at = static_cast<std::size_t>(heap.timed++);
    heap.step_s[at] = took;
    heap.iterations[at] = report.iterations;
    heap.listed[at] = static_cast<double>(stepper.contacts().size());
    heap.contacts[at] = static_cast<double>(
        std::count_if(stepper.contacts().begin(), stepper.contacts().end(),
                      [](const ContactImpulse<3>& contact) { return contact.normal_impulse > 0; }));
  }
  return heap;
}

/// In a process of its own, whose memory is then that heap's. @return none solved if it ended early
Heap measure_apart(int layers, int spheres, int seed) {
  Heap heap;
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return heap;
  const pid_t child = fork();
  if (child == 0) {
    const Heap measured = measure(layers, spheres, seed);
    const bool told = write(ends[1], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  if (child > 0) {
    Heap told;
    if (read(ends[0], &told, sizeof told) == static_cast<ssize_t>(sizeof told)) heap = told;
    rusage used{};
    int status = 0;
    if (wait4(child, &status, 0, &used) == child)
      heap.memory_bytes = static_cast<double>(used.ru_maxrss * kBytesOfKilobyte);
  }
  close(ends[0]);
  return heap;
}

/// n spheres in one kind of box, and what was measured of each heap.
struct Heaps {
  int layers = 0;
  int spheres = 0;
  std::vector<Heap> heaps;

  Heaps(int layers_of_it, int n) : layers(layers_of_it), spheres(n) {
    heaps.resize(layers > 0 ? static_cast<std::size_t>(std::clamp(kSpheres / n, kFewestHeaps, kMostHeaps))
                            : 1);
  }
  [[nodiscard]] const char* name() const { return layers > 0 ? "tray" : "cube"; }
};

/// The same heap measured twice: of each step the shorter time.
Heap shorter(const Heap& a, const Heap& b) {
  if (a.timed != b.timed) return a.timed < b.timed ? a : b;
  Heap heap = a;
  std::transform(a.step_s.begin(), a.step_s.end(), b.step_s.begin(), heap.step_s.begin(),
                 [](double x, double y) { return std::min(x, y); });
  heap.memory_bytes = std::max(a.memory_bytes, b.memory_bytes);
  return heap;
}

/// Every heap of the box once, one after the other.
void measure(bool is_first, Heaps& box) {
  for (std::size_t i = 0; i < box.heaps.size(); ++i) {
    const Heap heap = measure_apart(box.layers, box.spheres, static_cast<int>(i) + 1);
    box.heaps[i] = is_first ? heap : shorter(box.heaps[i], heap);
    fmt::print(".");
    std::fflush(stdout);
  }
}

Measured summary(const Heaps& box) {
  Measured result;
  result.layers = box.layers;
  result.spheres = box.spheres;
  result.heaps = static_cast<int>(box.heaps.size());
  std::vector<double> times, contacts, listed, iterations;
  for (const Heap& heap : box.heaps) {
    result.steps += heap.steps;
    result.residual = std::max(result.residual, heap.residual);
    result.memory_bytes = std::max(result.memory_bytes, heap.memory_bytes);
    const auto append = [&](const std::array<double, kTimed>& from, std::vector<double>& to) {
      to.insert(to.end(), from.begin(), from.begin() + heap.timed);
    };
    append(heap.step_s, times);
    append(heap.contacts, contacts);
    append(heap.listed, listed);
    append(heap.iterations, iterations);
  }
  if (!times.empty()) {
    result.contacts = mean(contacts);
    result.listed = mean(listed);
    result.iterations = mean(iterations);
    result.step_s = median(times);
    result.slowest_s = *std::max_element(times.begin(), times.end());
  }
  return result;
}

/// Slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]);
    const double b = std::log(y[i]);
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  const auto n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// Rows of one kind of box, and the exponent of its times.
void add_rows(const char* box, const std::vector<Measured>& all, harness::Table& table) {
  std::vector<double> contacts, times;
  for (const Measured& m : all) {
    if (m.steps != m.planned()) continue;
    contacts.push_back(m.contacts);
    times.push_back(m.step_s);
  }
  const double slope = contacts.size() > 1 ? exponent(contacts, times) : NAN;
  fmt::print("{}: time a step ~ contacts^{:.3f}\n", box, slope);
  using harness::number_cell;
  for (const Measured& m : all) {
    table.rows.push_back(
        {box, number_cell(long{m.layers}), number_cell(long{m.spheres}), number_cell(long{m.heaps}),
         number_cell(long{m.planned()}), number_cell(long{m.steps}), number_cell(m.contacts),
         number_cell(m.listed), number_cell(m.iterations), number_cell(m.step_s), number_cell(m.slowest_s),
         number_cell(m.memory_bytes), number_cell(m.residual), number_cell(slope), processor()});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "--help") == 0) {
    fmt::print(
        "Usage: spheres_in_box_scaling DIR [N...]\n\nMeasures the time of a step and the memory of n spheres "
        "in a tray and in a cube, in several heaps of each n, on a quiet machine, and writes "
        "DIR/scaling.csv.\n  N   numbers of spheres (default: 10 30 100 300 1000 3000)\nExit codes: 0 done, "
        "1 a step was not solved, 2 bad usage, 3 I/O.\n");
    return argc < 2 ? 2 : 0;
  }
  std::vector<int> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {10, 30, 100, 300, 1000, 3000};
  if (*std::min_element(sizes.begin(), sizes.end()) < 1) {
    fmt::print(stderr, "N: got less than 1, allowed: positive integers\n");
    return 2;
  }
  harness::Table table{
      {"box", "layers", "spheres", "heaps", "planned_steps", "steps", "contacts", "listed_contacts",
       "iterations", "step_s", "slowest_step_s", "memory_bytes", "largest_residual", "exponent", "processor"},
      {}};
  const std::filesystem::path folder = argv[1];
  try {
    harness::prepare_folder(folder);  // before minutes of measuring
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
  std::vector<Heaps> boxes;
  for (const int layers : {kLayers, 0}) {
    for (const int n : sizes) boxes.emplace_back(layers, n);
  }
  for (int pass = 1; pass <= kPasses; ++pass) {
    for (Heaps& box : boxes) {
      fmt::print("pass {} of {}, {}, n = {}: ", pass, kPasses, box.name(), box.spheres);
      measure(pass == 1, box);
      fmt::print("\n");
    }
  }
  bool solved = true;
  for (const int layers : {kLayers, 0}) {
    std::vector<Measured> all;
    for (const Heaps& box : boxes) {
      if (box.layers != layers) continue;
      all.push_back(summary(box));
      const Measured& m = all.back();
      fmt::print("{}, n = {}: {} heaps, {} of {} steps solved, {:.0f} contacts, {:.4g} s a step, {:.0f} MB\n",
                 box.name(), m.spheres, m.heaps, m.steps, m.planned(), m.contacts, m.step_s,
                 m.memory_bytes / 1e6);
      solved = solved && m.steps == m.planned();
    }
    add_rows(layers > 0 ? "tray" : "cube", all, table);
  }
  try {
    harness::write_files({{folder / "scaling.csv", harness::format_csv(table)}});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
  return solved ? 0 : 1;
}
