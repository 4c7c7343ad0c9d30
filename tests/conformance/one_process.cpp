#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <map>
#include <thread>
#include <vector>

#include "baselines/isolation.h"
#include "core/model/errors.h"
#include "tests/conformance/trace.h"

/// Every method of the build in one process: after each other, between each other, from several threads and
/// over forks each gives the bytes that it gives in a process of its own.
namespace touchstone::conformance {

namespace {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TOUCHSTONE_ADDRESS_SANITIZER
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(TOUCHSTONE_ADDRESS_SANITIZER)
constexpr bool kAddressSanitizer = true;
#else
constexpr bool kAddressSanitizer = false;
#endif

/// The methods that take the scene, which an engine without contacts need not.
template <int Dim>
std::vector<MethodEntry<Dim>> tracers() {
  std::vector<MethodEntry<Dim>> found;
  for (const auto& entry : methods<Dim>()) {
    try {
      static_cast<void>(entry.make(busy_scene<Dim>(), {}));
      found.push_back(entry);
    } catch (const Unsupported&) {
    }
  }
  return found;
}

template <int Dim>
std::map<std::string_view, std::string> traces_of_fresh_processes() {
  std::map<std::string_view, std::string> traces;
  for (const auto& entry : tracers<Dim>()) {
    traces[entry.key] = trace_of_fresh_process<Dim>(entry.key);
    EXPECT_FALSE(traces[entry.key].empty()) << entry.key;
  }
  return traces;
}

template <int Dim>
void one_after_another() {
  const auto alone = traces_of_fresh_processes<Dim>();
  const auto table = tracers<Dim>();
  for (const auto& entry : table) EXPECT_EQ(trace(entry), alone.at(entry.key)) << entry.key;
  // The other way round, so that each comes after each.
  for (auto entry = table.rbegin(); entry != table.rend(); ++entry)
    EXPECT_EQ(trace(*entry), alone.at(entry->key)) << entry->key;
}

template <int Dim>
void step_by_step() {
  const auto alone = traces_of_fresh_processes<Dim>();
  std::map<std::string_view, std::unique_ptr<Method<Dim>>> worlds;
  std::map<std::string_view, std::string> texts;
  for (const auto& entry : tracers<Dim>()) worlds[entry.key] = entry.make(busy_scene<Dim>(), {});
  for (int k = 0; k < kTraceSteps; ++k) {
    for (auto& [key, world] : worlds) {
      advance(*world, kStep, 1);
      append(texts[key], *world);
    }
  }
  for (const auto& [key, text] : texts) EXPECT_EQ(text, alone.at(key)) << key;
}

TEST(OneProcess, OneMethodAfterAnotherInThePlane) { one_after_another<2>(); }
TEST(OneProcess, OneMethodAfterAnotherInSpace) { one_after_another<3>(); }
TEST(OneProcess, MethodsStepByStepInThePlane) { step_by_step<2>(); }
TEST(OneProcess, MethodsStepByStepInSpace) { step_by_step<3>(); }

/// Worlds of every method in each of several threads that start with nothing loaded by them.
TEST(OneProcess, EveryMethodInSeveralThreads) {
  const auto alone = traces_of_fresh_processes<3>();
  constexpr int kThreads = 4;
  constexpr int kTimes = 2;
  std::vector<std::map<std::string_view, std::string>> traces(kThreads);
  std::vector<std::thread> threads;
  for (auto& of_thread : traces) {
    threads.emplace_back([&of_thread] {
      for (const auto& entry : tracers<3>()) {
        // More than once, because what threads do to each other takes a coincidence.
        std::string all;
        for (int i = 0; i < kTimes; ++i) all += trace(entry);
        of_thread[entry.key] = all;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (const auto& of_thread : traces) {
    for (const auto& [key, text] : of_thread) {
      std::string expected;
      for (int i = 0; i < kTimes; ++i) expected += alone.at(key);
      EXPECT_TRUE(text == expected) << key;
    }
  }
}

/// The module of bullet_si_float has a C library of its own, which is not told of forks.
TEST(OneProcess, ForksWhileOtherThreadsAreInAModule) {
  if (kAddressSanitizer)
    GTEST_SKIP() << "AddressSanitizer's allocator is not told of forks: a child of allocating threads hangs";
  using namespace std::chrono_literals;
  constexpr int kForks = 20;
  const auto& entry = find_method<3>("bullet_si_float");
  const std::string alone = trace_of_fresh_process<3>(entry.key);
  std::atomic<bool> done = false;
  std::vector<std::thread> threads;
  for (int i = 0; i < 24; ++i) {
    threads.emplace_back([&] {
      while (!done) EXPECT_EQ(trace(entry), alone);
    });
  }
  const auto inherited = entry.make(busy_scene<3>(), {});
  int same = 0;
  for (int i = 0; i < kForks && same == i; ++i)
    same += static_cast<int>(run_isolated([&] { return trace(entry); }, 60s).text == alone);
  EXPECT_EQ(same, kForks);
  const auto child = run_isolated(
      [&] {
        std::string text;
        for (int k = 0; k < kTraceSteps; ++k) {
          advance(*inherited, kStep, 1);
          append(text, *inherited);
        }
        return text;
      },
      60s);
  EXPECT_EQ(child.text, alone) << "a world from before the fork";
  done = true;
  for (auto& thread : threads) thread.join();
}

}  // namespace

}  // namespace touchstone::conformance
