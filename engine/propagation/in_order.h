#pragma once
/// Blocks of a range made side by side, by threads and by other processes, and handed over in order. Private to this
/// folder.
#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

#include "propagation/threads.h"

namespace gumshoe::propagation {

/// [first, last) in blocks that end at multiples of `step`.
struct Blocks {
  std::uint64_t first = 0, last = 0, step = 1;
  std::uint64_t end(std::uint64_t begin) const { return std::min(last, (begin / step + 1) * step); }
};

/// Things that one thread at a time may use.
template <class Thing> class Loans {
public:
  explicit Loans(const std::vector<Thing>& all) {
    for (const Thing& one : all) free_.push_back(&one);
  }
  /// Calls body(thing), or body(nullptr) where none is free.
  template <class Body> auto lend(const Body& body) {
    struct Loan {
      Loans& from;
      const Thing* const one;
      ~Loan() { from.give_back(one); }
    };
    const Loan loan{*this, take()};
    return body(loan.one);
  }

private:
  const Thing* take() {
    const std::lock_guard lock(guard_);
    if (free_.empty()) return nullptr;
    const Thing* one = free_.back();
    free_.pop_back();
    return one;
  }
  void give_back(const Thing* one) {
    const std::lock_guard lock(guard_);
    if (one) free_.push_back(one);
  }
  std::mutex guard_;
  std::vector<const Thing*> free_;
};

/// Makes every block, make(first, last, buffers) on these threads and elsewhere[i](first, last) in other processes, one
/// block at a time each, and calls finish(block, first, last) in order. Returns where it came to: the end, or less
/// after `stop`. Where a block fails, those before it are handed over; then its exception goes on.
template <class Buffers, class Made, class Make, class Finish>
std::uint64_t in_order(const Blocks& blocks, int threads,
                       const std::vector<std::function<Made(std::uint64_t, std::uint64_t)>>& elsewhere,
                       const std::atomic<bool>* stop, const Make& make, const Finish& finish) {
  struct Tried {
    Made block;
    std::uint64_t first = 0;
    std::exception_ptr failure;
  };
  Loans<std::function<Made(std::uint64_t, std::uint64_t)>> others(elsewhere);
  const std::uint64_t last = blocks.last;
  std::uint64_t next = blocks.first, done = blocks.first;
  std::atomic<std::uint64_t> failed_at{last}; // the earliest block known to have failed
  std::exception_ptr failure;                 // of the first block that failed, in order: what follows it is discarded
  const auto take = [&]() -> std::optional<std::uint64_t> {
    if (next >= last || failed_at < last || (stop && *stop)) return std::nullopt;
    return std::exchange(next, blocks.end(next));
  };
  const auto compute = [&](std::uint64_t first, Buffers& own) -> Tried {
    // Thrown here, an exception would cancel the pipeline with earlier blocks still in it.
    try {
      if (first > failed_at) return {};
      return others.lend([&](const auto* process) -> Tried {
        if (process) return {(*process)(first, blocks.end(first)), first, {}};
        return {make(first, blocks.end(first), own), first, {}};
      });
    } catch (...) {
      std::uint64_t known = failed_at;
      while (first < known && !failed_at.compare_exchange_weak(known, first)) {
      }
      return {{}, first, std::current_exception()};
    }
  };
  const auto hand_over = [&](const Tried& tried) {
    if (!failure) failure = tried.failure;
    if (failure) return;
    done = blocks.end(tried.first);
    finish(tried.block, tried.first, done);
  };
  if ((threads == 1 && elsewhere.empty()) || blocks.end(blocks.first) >= last) {
    Buffers own; // in the calling thread: a single block waits for no other thread to start
    while (const std::optional<std::uint64_t> first = take()) hand_over(compute(*first, own));
  } else {
    pipeline<Tried, Buffers>(thread_count(threads) + static_cast<int>(elsewhere.size()), take, compute, hand_over);
  }
  if (failure) std::rethrow_exception(failure);
  return done;
}

} // namespace gumshoe::propagation
