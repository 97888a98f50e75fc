#pragma once
/// Integers in the order of the values.
#include <bit>
#include <cstdint>

namespace gumshoe::analysis {

/// Rises with the value; -0 comes before 0. Not for NaN.
inline std::int64_t key_of(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits ^ static_cast<std::int64_t>(static_cast<std::uint64_t>(bits >> 63) >> 1);
}
/// The inverse.
inline double value_of(std::int64_t key) {
  return std::bit_cast<double>(key ^ static_cast<std::int64_t>(static_cast<std::uint64_t>(key >> 63) >> 1));
}

/// How many keys `key` lies above `base`; no difference of two keys overflows it.
inline std::uint64_t distance(std::int64_t base, std::int64_t key) {
  return static_cast<std::uint64_t>(key) - static_cast<std::uint64_t>(base);
}
inline std::int64_t moved(std::int64_t key, std::uint64_t up) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(key) + up);
}

} // namespace gumshoe::analysis
