#pragma once
/// Normal quantiles of many probabilities, with the bits of normal_quantile_lane.
#include <algorithm>
#include <array>

#include "math/lane_functions.h"
#include "math/store_where.h"

namespace gumshoe::quantities {

/// out[i] = f(z(u[i])) for i < n, a multiple of 8, lane by lane; out may be u. A tail costs several times what the centre does,
/// and 15 % of all are in one: most registers would hold some. They are gathered, and computed together.
template <class F> void each_normal_quantile(const double* u, double* out, std::size_t n, const F& f) {
  constexpr std::size_t strip = 512;
  alignas(64) std::array<double, strip + Lanes::size> tail{}, place{};
  alignas(64) std::array<double, Lanes::size> lane{};
  for (std::size_t i = 0; i < Lanes::size; ++i) lane[i] = static_cast<double>(i);
  for (std::size_t start = 0; start < n; start += strip) {
    const std::size_t count = std::min(strip, n - start);
    std::size_t tails = 0;
    Lanes at = Lanes::load_aligned(lane.data());
    for (std::size_t i = start; i < start + count; i += Lanes::size, at = at + Lanes(double{Lanes::size})) {
      const Lanes p = Lanes::load_unaligned(u + i), centred = p - Lanes(0.5);
      const auto outside = xsimd::abs(centred) > Lanes(normal_centre);
      f(normal_quantile_centre(centred)).store_unaligned(out + i);
      store_where(outside, p, &tail[tails]);
      tails += store_where(outside, at, &place[tails]);
    }
    std::fill_n(&tail[tails], Lanes::size, 0.5); // the rest of the last register
    for (std::size_t i = 0; i < tails; i += Lanes::size) {
      const Lanes p = Lanes::load_aligned(&tail[i]);
      f(normal_quantile_tail(xsimd::min(p, Lanes(1.0) - p), p - Lanes(0.5))).store_aligned(&tail[i]);
    }
    for (std::size_t i = 0; i < tails; ++i) out[start + static_cast<std::size_t>(place[i])] = tail[i];
  }
}

} // namespace gumshoe::quantities
