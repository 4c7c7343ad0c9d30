#include "experiments/harness/sweep.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>
#include <stop_token>
#include <thread>

#include "core/model/errors.h"
#include "experiments/harness/case_server.h"
#include "experiments/harness/interrupt.h"
#include "experiments/harness/progress.h"

namespace touchstone::harness {

namespace {

/// The queue of cases that threads take from, and what they gave.
class Pool {
 public:
  Pool(std::span<const Case> cases, const FinishedCases& done, Journal& journal,
       const IsolationPolicy& isolation)
      : cases_(cases), journal_(journal), isolation_(isolation), results_(cases.size()) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto it = done.find(case_key(cases[i].id));
      if (it != done.end()) {
        results_[i] = it->second;
      } else {
        queue_.push_back(i);
        queued_cost_ += cases[i].cost;
      }
    }
    // Costly ones first, so that no thread is left with a long one at the end.
    std::stable_sort(queue_.begin(), queue_.end(),
                     [&](std::size_t a, std::size_t b) { return cases_[a].cost > cases_[b].cost; });
  }

  void run(int jobs, const std::string& name) {
    Progress progress(name, static_cast<int>(queue_.size()), queued_cost_);
    const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(jobs), queue_.size());
    start_servers(count);
    std::vector<std::jthread> threads = start(count);
    std::unique_lock lock(mutex_);
    while (busy_ > 0) {
      changed_.wait_for(lock, std::chrono::milliseconds(200));
      progress.show(done_cases_, done_cost_);
    }
    lock.unlock();
    threads.clear();
    if (error_) std::rethrow_exception(error_);
  }

  std::vector<std::optional<FinishedCase>> take_results() { return std::move(results_); }

 private:
  /// One for each thread to be, if there is anything for them to do.
  void start_servers(std::size_t count) {
    const auto isolated = [&](std::size_t index) { return isolation_.applies_to(cases_[index]); };
    if (std::none_of(queue_.begin(), queue_.end(), isolated)) return;
    while (servers_.size() < count) {
      servers_.push_back(std::make_unique<CaseServer>(cases_, isolation_.time_limit));
    }
  }

  std::vector<std::jthread> start(std::size_t count) {
    const InterruptBlock signals_go_to_the_main_thread;
    std::vector<std::jthread> threads;
    busy_ = count;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([this, i] { work(i); });
    return threads;
  }

  void work(std::size_t thread) {
    try {
      while (const std::optional<std::size_t> index = take()) {
        const Case& one = cases_[*index];
        finish(*index, isolation_.applies_to(one) ? servers_[thread]->run(*index) : run_one(one));
      }
    } catch (const Interrupted&) {
      // Its case stays without a result; the others see the same flag.
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    --busy_;
    changed_.notify_one();
  }

  std::optional<std::size_t> take() {
    const std::scoped_lock lock(mutex_);
    if (next_ == queue_.size() || error_ || interrupt_requested()) return std::nullopt;
    return queue_[next_++];
  }

  void finish(std::size_t index, FinishedCase finished) {
    if (!finished.timed_out) journal_.append(case_key(cases_[index].id), finished);
    const std::scoped_lock lock(mutex_);
    results_[index] = std::move(finished);
    ++done_cases_;
    done_cost_ += cases_[index].cost;
    changed_.notify_one();
  }

  std::span<const Case> cases_;
  Journal& journal_;
  const IsolationPolicy& isolation_;
  std::vector<std::unique_ptr<CaseServer>> servers_;  ///< by thread
  std::vector<std::size_t> queue_;
  double queued_cost_ = 0.0;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::vector<std::optional<FinishedCase>> results_;
  std::size_t next_ = 0;
  std::size_t busy_ = 0;
  int done_cases_ = 0;
  double done_cost_ = 0.0;
  std::exception_ptr error_;
};

CaseResult result_of(const Case& one) {
  try {
    return one.run();
  } catch (const Unsupported& error) {
    return {CaseStatus::unsupported, error.what(), {}};
  } catch (const std::exception& error) {
    return {CaseStatus::failed, error.what(), {}};
  }
}

}  // namespace

FinishedCase run_one(const Case& one) {
  const auto start = std::chrono::steady_clock::now();
  CaseResult result = result_of(one);
  return {std::move(result), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

std::vector<std::optional<FinishedCase>> run_sweep(std::span<const Case> cases, const FinishedCases& done,
                                                   int jobs, const std::string& name, Journal& journal,
                                                   const IsolationPolicy& isolation) {
  Pool pool(cases, done, journal, isolation);
  pool.run(jobs, name);
  return pool.take_results();
}

}  // namespace touchstone::harness
