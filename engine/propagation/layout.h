#pragma once
/// Layout of the row of values at a reading: model quantities | effects | indications | stated sizes.
#include <cstddef>

namespace gumshoe::propagation {

/// Places [begin, end) of a row.
struct Range {
  std::size_t begin = 0, end = 0;
  constexpr std::size_t size() const { return end - begin; }
  constexpr bool contains(std::size_t place) const { return place >= begin && place < end; }
  /// Place of the i-th value of the range in the row.
  constexpr std::size_t operator[](std::size_t i) const { return begin + i; }
};

/// Order of a scenario's quantities, and of every point's values: SI.
struct Layout {
  Range model;       ///< the model's quantities, in the order of its card
  Range effects;     ///< quantities of the effects that act, effect by effect
  Range indications; ///< as read; in a scenario's quantities, their noise
  Range sizes;       ///< sizes of stated effects
  constexpr Layout() = default;
  constexpr Layout(std::size_t m, std::size_t e, std::size_t i, std::size_t s)
      : model{0, m}, effects{m, m + e}, indications{m + e, m + e + i}, sizes{m + e + i, m + e + i + s} {}
  constexpr std::size_t size() const { return sizes.end; }
};

} // namespace gumshoe::propagation
