#pragma once
/// One pass over values that counts or keeps those of given ranges.
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace gumshoe::analysis {

/// Values by their keys (order_key.h), both ends included.
struct SieveRange {
  static constexpr int keep = -1;
  std::int64_t first = 0, last = 0;
  int shift = keep;    ///< the values are counted in bins of 2^shift keys, or kept
  std::size_t bin = 0; ///< where its bins begin among all
  std::size_t bins() const;
};

struct Sieved {
  std::vector<std::uint64_t> counts;  ///< of the bins
  std::vector<std::int64_t> kept;     ///< keys, rising
  std::uint64_t below = 0, above = 0; ///< values outside of all ranges, if they were asked for
};

class Sieve {
public:
  /// `ranges` rise and do not overlap; `bin` is set here. Values between the ranges before `second` and those from
  /// there on are passed over at the least cost: ranges lie at both ends of most distributions.
  /// @param outside  counts what lies below the first and above the last range
  Sieve(std::vector<SieveRange> ranges, std::size_t second, bool outside);
  ~Sieve();
  /// Takes up to a leaf of values; NaN is in no range. Several threads may call it at once.
  void take(std::span<const double> values);
  /// What was taken; call once.
  Sieved found();
  const std::vector<SieveRange>& ranges() const { return ranges_; }

private:
  class Group;
  struct Tally;
  std::unique_ptr<Tally> borrow();

  std::vector<SieveRange> ranges_;
  std::vector<Group> groups_; ///< at both ends
  std::size_t bins_ = 0;
  bool outside_;
  std::mutex guard_;
  std::vector<std::unique_ptr<Tally>> tallies_; ///< as many as threads take values at the same time
};

} // namespace gumshoe::analysis
