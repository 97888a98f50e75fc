#pragma once
/// Philox4x32-10 (Salmon et al. 2011) turned into uniforms. The only door to Random123.
///
/// Header-only, so that kernel sources compile it once per instruction set; integers and exact
/// floating-point steps only, hence equal bits on all of them.
#include <bit>
#include <cstddef>
#include <cstdint>

#include <Random123/philox.h>

#include "random/streams.h"

namespace gumshoe::random {

/// (k + 1/2) 2^-52 of the upper 52 bits: exact, symmetric, never 0 or 1 (53 bits would round up to 1).
inline double unit_from_bits(std::uint64_t bits) {
  return (std::bit_cast<double>(0x3ff0000000000000u | bits >> 12) - 1.0) + 0x1p-53;
}

/// out[i] = uniform of sample first + i, i < n; first and n are even.
/// Counter: (sample / 2 low, sample / 2 high, reading, purpose << 16 | draw); each call serves two samples.
[[gnu::always_inline]] inline void fill_uniforms(const Stream& stream, std::uint64_t first, std::size_t n,
                                                 double* __restrict out) {
  const std::uint32_t key0 = static_cast<std::uint32_t>(stream.key), key1 = static_cast<std::uint32_t>(stream.key >> 32);
  const std::uint32_t purpose = static_cast<std::uint32_t>(stream.purpose) << 16 | stream.draw;
  const std::uint32_t reading = stream.reading;
  const std::uint64_t start = first / 2;
  const std::size_t pairs = n / 2;
  for (std::size_t i = 0; i < pairs; ++i) {
    const std::uint64_t pair = start + i;
    const philox4x32_ctr_t counter = {
        {static_cast<std::uint32_t>(pair), static_cast<std::uint32_t>(pair >> 32), reading, purpose}};
    const philox4x32_key_t key = {{key0, key1}};
    const philox4x32_ctr_t r = philox4x32_R(10, counter, key);
    out[2 * i] = unit_from_bits(static_cast<std::uint64_t>(r.v[1]) << 32 | r.v[0]);
    out[2 * i + 1] = unit_from_bits(static_cast<std::uint64_t>(r.v[3]) << 32 | r.v[2]);
  }
}

} // namespace gumshoe::random
