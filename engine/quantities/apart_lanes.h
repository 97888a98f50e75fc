#pragma once
/// Functions of many numbers of which some cost more than the others: normal quantiles in the tails, for one.
#include <algorithm>
#include <array>

#include "math/lanes.h"
#include "math/store_where.h"

namespace gumshoe::quantities {

/// out[i] = rare(u[i]) ? costly(u[i]) : usual(u[i]) for i < n, a multiple of 8; out may be u. All three work on lanes, each
/// for itself. Were they computed side by side, nearly every register would hold a costly lane: these are gathered.
template <class Rare, class Usual, class Costly>
void each_apart(const double* u, double* out, std::size_t n, const Rare& rare, const Usual& usual,
                const Costly& costly) {
  constexpr std::size_t strip = 512;
  alignas(64) std::array<double, strip + Lanes::size> gathered{}, place{};
  alignas(64) std::array<double, Lanes::size> lane{};
  for (std::size_t i = 0; i < Lanes::size; ++i) lane[i] = static_cast<double>(i);
  for (std::size_t start = 0; start < n; start += strip) {
    const std::size_t count = std::min(strip, n - start);
    std::size_t found = 0;
    Lanes at = Lanes::load_aligned(lane.data());
    for (std::size_t i = start; i < start + count; i += Lanes::size, at = at + Lanes(double{Lanes::size})) {
      const Lanes x = Lanes::load_unaligned(u + i);
      const auto apart = rare(x);
      usual(x).store_unaligned(out + i);
      store_where(apart, x, &gathered[found]);
      found += store_where(apart, at, &place[found]);
    }
    std::fill_n(&gathered[found], Lanes::size, 0.5); // the rest of the last register
    for (std::size_t i = 0; i < found; i += Lanes::size)
      costly(Lanes::load_aligned(&gathered[i])).store_aligned(&gathered[i]);
    for (std::size_t i = 0; i < found; ++i) out[start + static_cast<std::size_t>(place[i])] = gathered[i];
  }
}

} // namespace gumshoe::quantities
