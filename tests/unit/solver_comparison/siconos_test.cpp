// Siconos's answers hang on the problem alone: not on what the process left in storage, nor on the processor.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "baselines/engines/silence.h"
#include "baselines/isolation.h"
#include "experiments/solver_comparison/answer.h"
#include "tests/unit/harness/process.h"

namespace touchstone::solver_comparison {
namespace {

using touchstone::test::Finished;
using touchstone::test::Scratch;
using touchstone::test::slurp;

/// The first start of Billups's problem, whose path search reads F in storage of its own: one number.
Task billups() {
  for (Task& task : literature_tasks()) {
    if (task.problem == "billups" && task.start == "1") return task;
  }
  throw std::runtime_error("there is no such problem");
}

/// What is freed here of the sizes that a problem of one unknown asks for is what malloc() gives next. What
/// glibc links the blocks by is an address, which as a double is a tiny number above zero; the rest is
/// another one.
void leave_in_storage(std::size_t blocks_of_each_size) {
  constexpr std::size_t kLargest = 32;
  std::vector<double*> blocks;
  for (std::size_t doubles = 1; doubles <= kLargest; ++doubles) {
    for (std::size_t i = 0; i < blocks_of_each_size; ++i) {
      auto* const block = static_cast<double*>(std::malloc(doubles * sizeof(double)));
      for (std::size_t k = 0; k < doubles; ++k) block[k] = std::numeric_limits<double>::denorm_min();
      blocks.push_back(block);
    }
  }
  for (double* block : blocks) std::free(block);
}

/// In a process of its own, as its storage is spoilt and Siconos may end it.
std::string searched(std::size_t blocks_left) {
  const IsolatedResult result = run_isolated(
      [&] {
        const Task task = billups();
        const engines::SilencedStdout silenced;  // it prints
        leave_in_storage(blocks_left);
        const Answer answer = solve_by_siconos("siconos_ncp_path_search", task);
        return std::to_string(answer.iterations) + " iterations, " + std::to_string(answer.evaluations) +
               " evaluations, " + answer.claim;
      },
      std::chrono::seconds(60));
  EXPECT_EQ(result.outcome, Outcome::finished) << result.text;
  return result.text;
}

TEST(Siconos, PathSearchDoesNotReadWhatWasLeftInStorage) {
  if (siconos_version().empty()) GTEST_SKIP() << "the program was built without Siconos";
  const std::string first = searched(0);
  for (std::size_t blocks = 1; blocks <= 40; ++blocks) EXPECT_EQ(searched(blocks), first) << blocks;
}

/// The program's tables as they would be made on a processor of which OpenBLAS has this to say.
std::string tables_on(const char* processor) {
  const Scratch scratch;
  ::setenv("OPENBLAS_CORETYPE", processor, 1);
  const Finished run =
      test::run({SOLVER_COMPARISON, "--out", scratch / "out", "--families", "random_lcp", "--sizes", "5",
                 "--methods", "siconos_mcp_min,siconos_ncp_fb,siconos_ncp_path_search"});
  ::unsetenv("OPENBLAS_CORETYPE");
  EXPECT_LE(run.code, 1) << run.err;  // 1: a case failed, as path search does
  return slurp(scratch / "out/summary.csv");
}

TEST(Siconos, RowsDoNotDependOnTheProcessor) {
  if (siconos_version().empty()) GTEST_SKIP() << "the program was built without Siconos";
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    GTEST_SKIP() << "the kernels that are the same everywhere need AVX2 and FMA";
  const std::string old = tables_on("Prescott");
  EXPECT_EQ(tables_on("Haswell"), old);
  EXPECT_EQ(tables_on("Sandybridge"), old);
#else
  GTEST_SKIP() << "not a processor of this family";
#endif
}

}  // namespace
}  // namespace touchstone::solver_comparison
