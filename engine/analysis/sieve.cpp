#include "analysis/sieve.h"

#include <algorithm>
#include <array>

#include <boost/sort/pdqsort/pdqsort.hpp>

#include "analysis/leaves.h"
#include "analysis/order_key.h"
#include "analysis/sieve_kernels.h"
#include "base/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::analysis::SieveKernels, sieve)

namespace gumshoe::analysis {

const SieveKernels& sieve_kernels() { return *GUMSHOE_BEST_KERNELS(sieve); }

std::size_t SieveRange::bins() const {
  return shift == keep ? 0 : static_cast<std::size_t>(distance(first, last) >> shift) + 1;
}

/// Neighbouring ranges, and which of them a key is in.
class Sieve::Group {
public:
  explicit Group(std::span<const SieveRange> ranges) : ranges_(ranges) {
    first_ = ranges.front().first, last_ = ranges.back().last;
    const std::size_t slots = std::min<std::size_t>(2 * ranges.size(), 65536);
    while ((distance(first_, last_) >> shift_) >= slots) ++shift_;
    const std::size_t used = static_cast<std::size_t>(distance(first_, last_) >> shift_) + 1;
    std::uint32_t r = 0;
    for (std::size_t s = 0; s < used; ++s) {
      while (distance(first_, ranges[r].last) >> shift_ < s) ++r;
      starts_.push_back(r);
    }
    starts_.push_back(static_cast<std::uint32_t>(ranges.size() - 1));
  }
  double low() const { return value_of(first_); }
  double high() const { return value_of(last_); }

  /// Null: in none.
  const SieveRange* range_of(std::int64_t key) const {
    if (key < first_ || key > last_) return nullptr;
    const auto slot = static_cast<std::size_t>(distance(first_, key) >> shift_);
    const SieveRange *from = &ranges_[starts_[slot]], *to = &ranges_[starts_[slot + 1]];
    if (from != to)
      from = std::lower_bound(from, to, key, [](const SieveRange& r, std::int64_t k) { return r.last < k; });
    return from->first <= key && key <= from->last ? from : nullptr;
  }

private:
  std::span<const SieveRange> ranges_;
  std::int64_t first_ = 0, last_ = 0;
  int shift_ = 0;
  std::vector<std::uint32_t> starts_; ///< by slot: the first range that ends in or above it
};

/// What one thread finds.
struct Sieve::Tally {
  std::vector<std::uint64_t> counts;
  std::vector<std::int64_t> kept;
  std::uint64_t below = 0, above = 0;
};

Sieve::Sieve(std::vector<SieveRange> ranges, std::size_t second, bool outside)
    : ranges_(std::move(ranges)), outside_(outside) {
  for (SieveRange& r : ranges_) r.bin = bins_, bins_ += r.bins();
  const std::span<const SieveRange> all(ranges_);
  if (second > 0) groups_.emplace_back(all.first(second));
  if (second < all.size()) groups_.emplace_back(all.subspan(second));
}

Sieve::~Sieve() = default;

std::unique_ptr<Sieve::Tally> Sieve::borrow() {
  {
    const std::lock_guard lock(guard_);
    if (!tallies_.empty()) {
      auto one = std::move(tallies_.back());
      tallies_.pop_back();
      return one;
    }
  }
  auto one = std::make_unique<Tally>();
  one->counts.resize(bins_);
  return one;
}

void Sieve::take(std::span<const double> values) {
  const SieveKernels& kernels = sieve_kernels();
  const Group &low = groups_.front(), &high = groups_.back();
  std::unique_ptr<Tally> tally = borrow();
  std::array<double, leaf_values> some;
  const std::size_t count =
      kernels.within(values.data(), values.size(), {{low.low(), high.low()}, {low.high(), high.high()}}, some.data());
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t key = key_of(some[i]);
    const SieveRange* range = low.range_of(key);
    if (!range) range = high.range_of(key);
    if (!range) continue;
    if (range->shift == SieveRange::keep)
      tally->kept.push_back(key);
    else
      ++tally->counts[range->bin + static_cast<std::size_t>(distance(range->first, key) >> range->shift)];
  }
  if (outside_) {
    std::size_t below = 0, above = 0;
    kernels.outside(values.data(), values.size(), low.low(), high.high(), below, above);
    tally->below += below, tally->above += above;
  }
  const std::lock_guard lock(guard_);
  tallies_.push_back(std::move(tally));
}

Sieved Sieve::found() {
  Sieved found;
  found.counts.resize(bins_);
  std::size_t kept = 0;
  for (const auto& tally : tallies_) kept += tally->kept.size();
  found.kept.reserve(kept);
  for (auto& tally : tallies_) {
    for (std::size_t b = 0; b < bins_; ++b) found.counts[b] += tally->counts[b];
    found.kept.insert(found.kept.end(), tally->kept.begin(), tally->kept.end());
    found.below += tally->below;
    found.above += tally->above;
    tally.reset();
  }
  tallies_.clear();
  boost::sort::pdqsort_branchless(found.kept.begin(), found.kept.end());
  return found;
}

} // namespace gumshoe::analysis
