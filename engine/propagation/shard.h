#pragma once
/// Division of a run's samples, and of its studies' model runs, among processes that share nothing.
#include <cstdint>
#include <string>
#include <vector>

#include "propagation/work.h"

namespace gumshoe::propagation {

/// Samples [first, last).
struct SampleRange {
  std::uint64_t first = 0, last = 0;
  std::uint64_t size() const { return last - first; }
};

/// One part of a run, written "3/16"; parts count from 1.
struct Shard {
  std::uint64_t number = 1, of = 1;
  std::string text() const;
  /// Its samples. Parts are contiguous, in order, and equal but for a unit of 64 samples, at which every design can
  /// begin (random/README.md). A part is empty if there are fewer units than parts.
  SampleRange samples(std::uint64_t total) const;
  /// Its units: those that begin within its part of all model runs, taken in order. Each work's at most once; empty
  /// ones are left out.
  std::vector<Portion> portions(const std::vector<Work>& works) const;
};

/// Numbers that the units give.
std::uint64_t values_of(const std::vector<Portion>& portions, const std::vector<Work>& works);

/// Throws InputError naming `option` unless the text is NUMBER/OF with 1 <= NUMBER <= OF <= 1,000,000.
Shard shard_of(const std::string& text, const std::string& option);

} // namespace gumshoe::propagation
