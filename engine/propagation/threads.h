#pragma once
/// The door to oneTBB: a loop and a pipeline on as many threads as asked for. Private to this folder.
#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

namespace gumshoe::propagation {

namespace tbb = oneapi::tbb;

/// 0 asks for all processors.
inline int thread_count(int asked) { return asked > 0 ? asked : tbb::this_task_arena::max_concurrency(); }

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

/// Blocks in three steps: take() says where one begins, one after the other, until there is none; compute(first,
/// buffers) makes them side by side; finish(made) takes them in the order in which they were taken.
template <class Made, class Buffers, class Take, class Compute, class Finish>
void pipeline(int threads, const Take& take, const Compute& compute, const Finish& finish) {
  tbb::enumerable_thread_specific<Buffers> buffers;
  on_threads(threads, [&] {
    tbb::parallel_pipeline(
        4 * static_cast<std::size_t>(threads),
        tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order,
                                              [&](tbb::flow_control& control) -> std::uint64_t {
                                                const std::optional<std::uint64_t> first = take();
                                                if (!first) control.stop();
                                                return first.value_or(0);
                                              }) &
            tbb::make_filter<std::uint64_t, Made>(
                tbb::filter_mode::parallel, [&](std::uint64_t first) { return compute(first, buffers.local()); }) &
            tbb::make_filter<Made, void>(tbb::filter_mode::serial_in_order, finish));
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

template <class Made, class Buffers, class Take, class Compute, class Finish>
void pipeline(int threads, const Take& take, const Compute& compute, const Finish& finish) {
  std::mutex taking, finishing;
  std::uint64_t taken = 0, finished = 0;
  std::map<std::uint64_t, Made> waiting;
  each(static_cast<std::size_t>(threads), threads, [&](std::size_t) {
    Buffers own;
    for (;;) {
      std::optional<std::uint64_t> first;
      std::uint64_t number = 0;
      {
        const std::lock_guard lock(taking);
        if (!(first = take())) return;
        number = taken++;
      }
      Made made = compute(*first, own);
      const std::lock_guard lock(finishing);
      waiting[number] = std::move(made);
      for (; !waiting.empty() && waiting.begin()->first == finished; ++finished) {
        finish(waiting.begin()->second);
        waiting.erase(waiting.begin());
      }
    }
  });
}

#endif

} // namespace gumshoe::propagation
