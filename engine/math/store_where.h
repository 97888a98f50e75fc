#pragma once
/// Some of the lanes, one after the other in memory: what a comparison selects.
#include <bit>

#include "math/lanes.h"

namespace gumshoe {

/// Stores the lanes of x for which `in` holds, one after the other; returns how many. Writes up to all lanes.
inline std::size_t store_where(const xsimd::batch_bool<double, isa::sse2>& in, const LanesOf<isa::sse2>& x,
                               double* out) {
  const auto bits = static_cast<unsigned>(_mm_movemask_pd(in));
  out[0] = x.get(bits == 2 ? 1 : 0);
  out[1] = x.get(1);
  return static_cast<std::size_t>(std::popcount(bits));
}
#ifdef __AVX2__
inline std::size_t store_where(const xsimd::batch_bool<double, isa::avx2>& in, const LanesOf<isa::avx2>& x,
                               double* out) {
  alignas(32) double all[4];
  x.store_aligned(all);
  std::size_t count = 0;
  for (auto bits = static_cast<unsigned>(_mm256_movemask_pd(in)); bits != 0; bits &= bits - 1)
    out[count++] = all[std::countr_zero(bits)];
  return count;
}
#endif
#ifdef __AVX512F__
inline std::size_t store_where(const xsimd::batch_bool<double, isa::avx512>& in, const LanesOf<isa::avx512>& x,
                               double* out) {
  _mm512_storeu_pd(out, _mm512_maskz_compress_pd(in, x));
  return static_cast<std::size_t>(std::popcount(static_cast<unsigned>(static_cast<__mmask8>(in))));
}
#endif

} // namespace gumshoe
