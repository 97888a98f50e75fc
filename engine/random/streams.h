#pragma once
/// Uniform random numbers as a function of (stream, sample): no state, no order, no dependence on
/// blocks or threads.
#include <array>
#include <cstddef>
#include <cstdint>

namespace gumshoe::random {

/// Which stream of random numbers: a key and the words of the counter that are not the sample.
struct Stream {
  std::uint64_t key = 0;
  std::uint32_t reading = 0; ///< 0: shared by all readings; else 1 + index of the reading
  std::uint16_t purpose = 0;
  std::uint16_t draw = 0; ///< several numbers per sample and stream: 0, 1, ...
};

/// Philox4x32-10 itself (Salmon et al. 2011), for tests and for whoever needs 128 bits at a counter.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// out[i] = uniform in (0, 1) of sample first + i, i < n. first and n are even, because two
/// neighbouring samples share one counter. Values are (k + 1/2) 2^-52: symmetric about 1/2, never 0 or 1.
void uniforms(const Stream& stream, std::uint64_t first, std::size_t n, double* out);

/// The same for one sample.
double uniform(const Stream& stream, std::uint64_t sample);

/// A 64-bit number for derived keys (scrambles, permutations) of a stream.
std::uint64_t derived_key(const Stream& stream, std::uint64_t salt);

} // namespace gumshoe::random
