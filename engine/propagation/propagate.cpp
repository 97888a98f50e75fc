#include "propagation/propagate.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "base/interrupt.h"
#include "base/progress.h"

namespace gumshoe::propagation {

namespace tbb = oneapi::tbb;

quantities::PointSet point_set(scenario::Design design) {
  switch (design) {
  case scenario::Design::latin_hypercube:
    return quantities::PointSet::latin_hypercube;
  case scenario::Design::sobol:
    return quantities::PointSet::sobol;
  default:
    return quantities::PointSet::monte_carlo;
  }
}

namespace {

int thread_count(int asked) { return asked > 0 ? asked : tbb::this_task_arena::max_concurrency(); }

std::shared_ptr<const quantities::Sampler> make_sampler(const Experiment& e) {
  const auto& run = e.scenario().run;
  return std::make_shared<const quantities::Sampler>(e.plan(), point_set(run.design), run.samples);
}

struct ThreadBuffers {
  Workspace workspace;
  std::vector<double> variates, outputs;
  std::vector<std::uint8_t> status;
};

struct Tried {
  ResultBlock block;
  std::exception_ptr failure;
};

/// Samples [first, first + count) into a block; drawn in multiples of 8, the surplus is cut off.
ResultBlock run_block(const Experiment& e, const quantities::Sampler& sampler, std::uint64_t first, std::size_t count,
                      ThreadBuffers& b) {
  const std::size_t n = (count + 7) / 8 * 8, variates = e.plan().variates.size(), rows = e.outputs().size();
  b.variates.resize(variates * n);
  b.outputs.resize(rows * n);
  b.status.resize(n);
  sampler.draw(first, n, quantities::Purpose::sampling, b.variates.data(), n);
  std::vector<const double*> pointers(variates);
  for (std::size_t v = 0; v < variates; ++v) pointers[v] = &b.variates[v * n];
  b.workspace.first_sample = first;
  e.run(pointers, n, b.workspace, b.outputs.data(), b.status.data());
  ResultBlock block{
      first, count, std::vector<double>(rows * count), {b.status.begin(), b.status.begin() + static_cast<long>(count)}};
  for (std::size_t r = 0; r < rows; ++r) std::copy_n(&b.outputs[r * n], count, &block.outputs[r * count]);
  return block;
}

/// Blocks one after the other in the calling thread: a run of one block waits for no other thread to start.
template <class Take, class Compute, class Finish>
void one_by_one(const Take& take, const Compute& compute, const Finish& finish) {
  ThreadBuffers buffers;
  while (const std::optional<std::uint64_t> first = take()) finish(compute(*first, buffers));
}

/// The other processes, each lent to one thread at a time.
class Elsewhere {
public:
  explicit Elsewhere(const std::vector<MakeBlock>& all) {
    for (const MakeBlock& one : all) free_.push_back(&one);
  }
  /// Calls body(process), or body(nullptr) where none is free.
  template <class Body> auto lend(const Body& body) {
    struct Loan {
      Elsewhere& from;
      const MakeBlock* const one;
      ~Loan() { from.give_back(one); }
    };
    const Loan loan{*this, take()};
    return body(loan.one);
  }

private:
  const MakeBlock* take() {
    const std::lock_guard lock(guard_);
    if (free_.empty()) return nullptr;
    const MakeBlock* one = free_.back();
    free_.pop_back();
    return one;
  }
  void give_back(const MakeBlock* one) {
    const std::lock_guard lock(guard_);
    if (one) free_.push_back(one);
  }
  std::mutex guard_;
  std::vector<const MakeBlock*> free_;
};

#ifndef __SANITIZE_THREAD__

/// Runs `body` with as many workers as asked for, more than there are processors too.
template <class Body> void on_threads(int threads, const Body& body) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(body);
}

/// Calls body(i) for i in [0, n).
template <class Body> void each(std::size_t n, int threads, const Body& body) {
  on_threads(threads, [&] { tbb::parallel_for(std::size_t{0}, n, body); });
}

/// Blocks in three steps: taken one after the other, computed side by side, finished in the order in which they were
/// taken.
template <class Take, class Compute, class Finish>
void pipeline(int threads, const Take& take, const Compute& compute, const Finish& finish) {
  tbb::enumerable_thread_specific<ThreadBuffers> buffers;
  on_threads(threads, [&] {
    tbb::parallel_pipeline(
        4 * static_cast<std::size_t>(threads),
        tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order,
                                              [&](tbb::flow_control& control) -> std::uint64_t {
                                                const std::optional<std::uint64_t> first = take();
                                                if (!first) control.stop();
                                                return first.value_or(0);
                                              }) &
            tbb::make_filter<std::uint64_t, Tried>(
                tbb::filter_mode::parallel, [&](std::uint64_t first) { return compute(first, buffers.local()); }) &
            tbb::make_filter<Tried, void>(tbb::filter_mode::serial_in_order, finish));
  });
}

#else // the same on plain threads: what oneTBB's tasks hand to each other looks unordered to the thread sanitizer

template <class Body> void each(std::size_t n, int threads, const Body& body) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex guard;
  std::vector<std::jthread> workers;
  for (int t = 0; t < threads; ++t)
    workers.emplace_back([&] {
      try {
        for (std::size_t i; (i = next++) < n;) body(i);
      } catch (...) {
        const std::lock_guard lock(guard);
        failure = std::current_exception();
        next = n;
      }
    });
  workers.clear();
  if (failure) std::rethrow_exception(failure);
}

template <class Take, class Compute, class Finish>
void pipeline(int threads, const Take& take, const Compute& compute, const Finish& finish) {
  std::mutex taking, finishing;
  std::uint64_t taken = 0, finished = 0;
  std::map<std::uint64_t, Tried> waiting;
  each(static_cast<std::size_t>(threads), threads, [&](std::size_t) {
    ThreadBuffers own;
    for (;;) {
      std::optional<std::uint64_t> first;
      std::uint64_t number = 0;
      {
        const std::lock_guard lock(taking);
        if (!(first = take())) return;
        number = taken++;
      }
      Tried tried = compute(*first, own);
      const std::lock_guard lock(finishing);
      waiting[number] = std::move(tried);
      for (; !waiting.empty() && waiting.begin()->first == finished; ++finished) {
        finish(waiting.begin()->second);
        waiting.erase(waiting.begin());
      }
    }
  });
}

#endif

} // namespace

MakeBlock block_maker(const Experiment& e) {
  return [&e, sampler = make_sampler(e)](std::uint64_t first, std::uint64_t last) {
    ThreadBuffers own;
    return run_block(e, *sampler, first, static_cast<std::size_t>(last - first), own);
  };
}

std::uint64_t propagate(const Experiment& e, Sink& sink, const RunSettings& settings) {
  const auto sampler = make_sampler(e);
  Elsewhere elsewhere(settings.elsewhere);
  const std::uint64_t total = settings.last > 0 ? settings.last : e.scenario().run.samples;
  const std::uint64_t per_block = std::max<std::uint64_t>(1, e.model().block / block_samples) * block_samples;
  std::uint64_t next = settings.first, done = settings.first;
  std::atomic<std::uint64_t> failed_at{total}; // first sample of the earliest block known to have failed
  std::exception_ptr failure;                  // of the first block that failed, in order: what follows it is discarded
  const auto end_of = [&](std::uint64_t first) {
    return std::min<std::uint64_t>(total, (first / per_block + 1) * per_block);
  };
  const auto take = [&]() -> std::optional<std::uint64_t> {
    if (next >= total || failed_at < total || (settings.stop && *settings.stop)) return std::nullopt;
    return std::exchange(next, end_of(next));
  };
  const auto compute = [&](std::uint64_t first, ThreadBuffers& own) -> Tried {
    // Thrown here, an exception would cancel the pipeline with earlier blocks still in it.
    try {
      if (first > failed_at) return {};
      return elsewhere.lend([&](const MakeBlock* process) -> Tried {
        if (process) return {(*process)(first, end_of(first)), {}};
        return {run_block(e, *sampler, first, static_cast<std::size_t>(end_of(first) - first), own), {}};
      });
    } catch (...) {
      std::uint64_t known = failed_at;
      while (first < known && !failed_at.compare_exchange_weak(known, first)) {
      }
      return {{}, std::current_exception()};
    }
  };
  const auto finish = [&](const Tried& tried) {
    if (!failure) failure = tried.failure;
    if (failure) return;
    sink.write(tried.block);
    done = tried.block.first_sample + tried.block.samples;
    if (settings.progress) settings.progress({done, total});
  };
  if ((settings.threads == 1 && settings.elsewhere.empty()) || end_of(settings.first) >= total)
    one_by_one(take, compute, finish);
  else
    pipeline(thread_count(settings.threads) + static_cast<int>(settings.elsewhere.size()), take, compute, finish);
  if (failure) std::rethrow_exception(failure);
  return done;
}

std::function<void(std::uint64_t, std::size_t, double*)> variate_draws(const Experiment& e) {
  return [sampler = make_sampler(e), variates = e.plan().variates.size()](std::uint64_t first, std::size_t count,
                                                                          double* values) {
    const std::uint64_t begin = first / 64 * 64;
    const std::size_t n = static_cast<std::size_t>((first + count - begin + 63) / 64 * 64);
    std::vector<double> drawn(variates * n);
    sampler->draw(begin, n, quantities::Purpose::sampling, drawn.data(), n);
    for (std::size_t v = 0; v < variates; ++v) std::copy_n(&drawn[v * n + (first - begin)], count, values + v * count);
  };
}

std::vector<double> variates_of(const Experiment& e, std::uint64_t sample) {
  std::vector<double> one(e.plan().variates.size());
  variate_draws(e)(sample, 1, one.data());
  return one;
}

void parallel_for(std::size_t n, int threads, const std::function<void(std::size_t)>& body) {
  progress::Loop loop(n);
  const auto step = [&](std::size_t i) {
    stop_if_interrupted();
    body(i);
    loop.step();
  };
  if (n > 1 && threads != 1) return each(n, thread_count(threads), step);
  for (std::size_t i = 0; i < n; ++i) step(i);
}

} // namespace gumshoe::propagation
