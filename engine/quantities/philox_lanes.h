#pragma once
/// Uniforms of a stream in lanes: the Philox4x32-10 of random/philox.h (Salmon et al. 2011) with every 32-bit word in
/// a 64-bit lane, where one instruction multiplies. Integers and exact steps only: the bits are those of
/// random::uniforms, which the tests compare with.
#include <utility>

#include "math/lane_functions.h"
#include "random/philox.h"

namespace gumshoe::quantities {

using Words = Bits<Lanes>;

/// Products of the lower 32 bits of each 64-bit lane, exact in 64 bits.
template <class Register> inline Register product_of_low_words(const Register& a, const Register& b) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Register) == 64) return Register(_mm512_mul_epu32(a, b));
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(Register) == 32) return Register(_mm256_mul_epu32(a, b));
#endif
  if constexpr (sizeof(Register) == 16) return Register(_mm_mul_epu32(a, b));
}

/// The upper 32 bits of each 64-bit lane in its lower half; the upper half holds them as well. A permutation, because a
/// shift would wait for the ports that multiply.
template <class Register> inline Register high_words(const Register& a) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Register) == 64) return Register(_mm512_shuffle_epi32(a, _MM_PERM_DDBB));
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(Register) == 32) return Register(_mm256_shuffle_epi32(a, _MM_SHUFFLE(3, 3, 1, 1)));
#endif
  if constexpr (sizeof(Register) == 16) return Register(_mm_shuffle_epi32(a, _MM_SHUFFLE(3, 3, 1, 1)));
}

/// Ten rounds of Philox4x32 on the counters c, in place. Words are the lower halves of the lanes; the upper halves may
/// hold anything.
/// Source: Salmon et al. 2011, Parallel random numbers: as easy as 1, 2, 3.
inline void philox_lanes(Words (&c)[4], std::uint32_t key0, std::uint32_t key1) {
  const Words m0(std::uint64_t{0xD2511F53}), m1(std::uint64_t{0xCD9E8D57});
  for (int round = 0; round < 10; ++round) {
    const Words p0 = product_of_low_words(c[0], m0), p1 = product_of_low_words(c[2], m1);
    c[0] = high_words(p1) ^ c[1] ^ Words(std::uint64_t{key0});
    c[2] = high_words(p0) ^ c[3] ^ Words(std::uint64_t{key1});
    c[1] = p1;
    c[3] = p0;
    key0 += 0x9E3779B9;
    key1 += 0xBB67AE85;
  }
}

/// Uniforms in (0, 1) from two words each, as random::unit_from_bits makes them.
inline Lanes unit_lanes(const Words& low, const Words& high) {
  const Words bits = (low & Words(std::uint64_t{0xffffffff})) | (high << 32);
  return (lanes_of<Lanes>((bits >> 12) | Words(std::uint64_t{0x3ff0000000000000u})) - Lanes(1.0)) + Lanes(0x1p-53);
}

/// The lanes a[from], b[from], a[from + 1], b[from + 1], ... (xsimd's zip orders them differently on each instruction set).
template <std::size_t from, std::size_t... i>
inline Lanes interleaved(const Lanes& a, const Lanes& b, std::index_sequence<i...>) {
  using Register = Lanes::register_type;
  return Lanes(Register(
      __builtin_shufflevector(Register(a), Register(b), static_cast<int>(from + i / 2 + (i % 2) * sizeof...(i))...)));
}

/// Writes the uniforms of samples [first, first + n) of a stream to out: the same bits as random::fill_uniforms, which also
/// does the rest that fills no lane. first and n are even.
inline void fill_uniforms_in_lanes(const random::Stream& stream, std::uint64_t first, std::size_t n, double* out) {
  constexpr std::size_t step = 2 * Lanes::size; // each counter serves two samples
  alignas(64) std::uint64_t number[Lanes::size];
  for (std::size_t i = 0; i < Lanes::size; ++i) number[i] = i;
  const Words offset = Words::load_aligned(number);
  const std::uint64_t reading = stream.reading,
                      purpose = static_cast<std::uint32_t>(stream.purpose) << 16 | stream.draw;
  const auto key0 = static_cast<std::uint32_t>(stream.key), key1 = static_cast<std::uint32_t>(stream.key >> 32);
  constexpr auto order = std::make_index_sequence<Lanes::size>();
  std::size_t i = 0;
  for (; i + step <= n; i += step) {
    const Words pair = Words((first + i) / 2) + offset;
    Words c[4] = {pair, pair >> 32, Words(reading), Words(purpose)};
    philox_lanes(c, key0, key1);
    const Lanes even = unit_lanes(c[0], c[1]), odd = unit_lanes(c[2], c[3]);
    interleaved<0>(even, odd, order).store_unaligned(out + i);
    interleaved<Lanes::size / 2>(even, odd, order).store_unaligned(out + i + Lanes::size);
  }
  random::fill_uniforms(stream, first + i, n - i, out + i);
}

} // namespace gumshoe::quantities
