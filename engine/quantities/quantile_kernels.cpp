/// Kernels of the sampler: uniforms, quantile functions, normal probabilities. Compiled once per
/// instruction set; every step is exact or correctly rounded, so all copies give equal bits.
// GCC 12 warns of `__m512i __Y = __Y` in its own headers (its bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "quantities/quantile_kernels.h"

#include <algorithm>

#include "math/lane_functions.h"
#include "math/lanes.h"
#include "quantities/apart_lanes.h"
#include "quantities/latin_lanes.h"
#include "quantities/philox_lanes.h"

namespace gumshoe::quantities {
namespace {

template <class F> inline void each(const double* u, double* out, std::size_t n, F&& f) {
  for (std::size_t i = 0; i < n; i += Lanes::size) f(Lanes::load_unaligned(u + i)).store_unaligned(out + i);
}

/// Root t of 1 - t + t ln t = q on (0, 1], q in [0, 1]: Newton's method from a point below the root,
/// from where it rises monotonically because the function is convex.
Lanes curvilinear_root(const Lanes& q) {
  const Lanes s = xsimd::sqrt(Lanes(2.0) * q), c = Lanes(1.0) - q;
  Lanes t = xsimd::max(xsimd::max(Lanes(1.0) - s, Lanes(0.5) * c * c), Lanes(1e-290));
  for (int i = 0; i < 6; ++i) {
    const Lanes log_t = log_lane(t);
    t = t - (Lanes(1.0) - t + t * log_t - q) / xsimd::min(log_t, Lanes(-1e-9));
    t = xsimd::min(xsimd::max(t, Lanes(1e-290)), Lanes(1.0));
  }
  // Near the end the root is double and Newton's steps are noise; the series is exact to rounding.
  const Lanes series = Lanes(1.0) - s * (Lanes(1.0) - s * (Lanes(1.0 / 6) + s * Lanes(1.0 / 72)));
  return xsimd::select(s < Lanes(1e-4), series, t);
}

void curvilinear(const Lanes (&c)[8], const double* u, double* out, std::size_t n) {
  const Lanes one(1.0), half(0.5);
  const auto rarer = [&](const Lanes& x) { return xsimd::min(x, one - x); };
  // Distance from the centre where the density is flat.
  const auto inner = [&](const Lanes& x) { return (half - rarer(x)) * c[4]; };
  const auto placed = [&](const Lanes& x, const Lanes& y) { return xsimd::select(x < half, c[0] - y, c[0] + y); };
  each_apart(
      u, out, n, [&](const Lanes& x) { return inner(x) > c[1]; }, [&](const Lanes& x) { return placed(x, inner(x)); },
      [&](const Lanes& x) { return placed(x, c[2] * curvilinear_root(xsimd::min(rarer(x) * c[3], one))); });
}

/// f of the standard normal quantiles.
template <class F> void normal(const double* u, double* out, std::size_t n, const F& f) {
  const Lanes one(1.0), half(0.5);
  each_apart(
      u, out, n, [&](const Lanes& p) { return xsimd::abs(p - half) > Lanes(normal_centre); },
      [&](const Lanes& p) { return f(normal_quantile_centre(p - half)); },
      [&](const Lanes& p) { return f(normal_quantile_tail(xsimd::min(p, one - p), p - half)); });
}

/// Turns rows into columns: every interleaving moves the leading bit of a lane's number to the row's (a perfect
/// shuffle).
void transpose(Lanes (&rows)[Lanes::size]) {
  constexpr auto order = std::make_index_sequence<Lanes::size>();
  constexpr std::size_t half = Lanes::size / 2;
  for (std::size_t step = 1; step < Lanes::size; step *= 2) {
    Lanes next[Lanes::size];
    for (std::size_t i = 0; i < half; ++i) {
      next[2 * i] = interleaved<0>(rows[i], rows[i + half], order);
      next[2 * i + 1] = interleaved<half>(rows[i], rows[i + half], order);
    }
    std::ranges::copy(next, rows);
  }
}

Lanes table_value(const TableView& table, const Lanes& p, const Lanes& upper, bool two_sided) {
  using Index = Bits<Lanes>;
  // p = 2^e (1 + m): piece = octave and the leading bits of m; x in [-1, 1] within the piece.
  const int pieces = table.log2_pieces;
  const Index bits = bits_of(p) & Index(std::uint64_t{0x7fffffffffffffffu});
  const Index piece = (bits >> (52 - pieces)) - Index(static_cast<std::uint64_t>(1023 - 1 - table_octaves) << pieces);
  const Index inside = bits & Index((std::uint64_t{1} << (52 - pieces)) - 1);
  const double half = static_cast<double>(std::uint64_t{1} << (51 - pieces));
  const Lanes x = (to_double<Lanes>(inside) - Lanes(half)) * Lanes(1.0 / half);
  alignas(64) std::uint64_t index[Lanes::size];
  alignas(64) double side[Lanes::size], last[Lanes::size];
  piece.store_aligned(index);
  upper.store_aligned(side);
  const double* row[Lanes::size];
  for (std::size_t k = 0; k < Lanes::size; ++k) {
    row[k] = (two_sided && side[k] > 0.5 ? table.upper : table.lower) + index[k] * (table_degree + 1);
    last[k] = row[k][table_degree];
  }
  static_assert(table_degree % Lanes::size == 0);
  Lanes y = Lanes::load_aligned(last);
  for (std::size_t from = table_degree; from > 0;) { // as many coefficients at a time as there are lanes
    from -= Lanes::size;
    Lanes c[Lanes::size];
    for (std::size_t k = 0; k < Lanes::size; ++k) c[k] = Lanes::load_unaligned(row[k] + from);
    transpose(c);
    for (std::size_t j = Lanes::size; j-- > 0;) y = y * x + c[j];
  }
  return y;
}

void quantile(const QuantileSpec* spec, const double* u, double* out, std::size_t n) {
  const auto& v = spec->c;
  Lanes c[8];
  for (int i = 0; i < 8; ++i) c[i] = Lanes(v[i]);
  const Lanes one(1.0), half(0.5), zero(0.0);
  switch (spec->form) {
  case Form::constant:
    return each(u, out, n, [&](const Lanes&) { return c[0]; });
  case Form::linear:
    return each(u, out, n, [&](const Lanes& x) { return c[0] + c[1] * x; });
  case Form::curvilinear:
    return curvilinear(c, u, out, n);
  case Form::trapezoid:
    return each(u, out, n, [&](const Lanes& x) {
      const Lanes p = xsimd::min(x, one - x);
      const Lanes y = xsimd::select(p < c[2], c[3] * xsimd::sqrt(p), c[4] + c[5] * p);
      return xsimd::select(x < half, c[0] + y, c[1] - y);
    });
  case Form::arcsine:
    return each(u, out, n, [&](const Lanes& x) {
      const Lanes s = small_sine(xsimd::min(x, one - x) * Lanes(1.57079632679489661923));
      const Lanes y = c[2] * s * s;
      return xsimd::select(x < half, c[0] + y, c[1] - y);
    });
  case Form::normal:
    return normal(u, out, n, [&](const Lanes& z) { return c[0] + c[1] * z; });
  case Form::exponential:
    return each(u, out, n, [&](const Lanes& x) { return c[0] * -log_lane(one - x); });
  case Form::lognormal:
    return normal(u, out, n, [&](const Lanes& z) { return exp_lane(c[0] + c[1] * z); });
  case Form::truncated:
    return each(u, out, n, [&](const Lanes& x) {
      // From the nearer tail of the parent, which keeps its digits.
      const Lanes below = c[4] + x * c[6], above = c[5] + (one - x) * c[6];
      const auto low = below < half;
      const Lanes tail = xsimd::max(xsimd::select(low, below, above), Lanes(0x1p-1022));
      const Lanes z = normal_quantile_lane(tail, one - tail);
      return xsimd::min(xsimd::max(c[0] + c[1] * xsimd::select(low, z, -z), c[2]), c[3]);
    });
  case Form::odd_table:
    return each(u, out, n, [&](const Lanes& x) {
      const Lanes p = xsimd::min(xsimd::max(xsimd::min(x, one - x), Lanes(0x1p-53)), Lanes(0x1.fffffffffffffp-2));
      return c[0] + c[1] * ((x - half) * table_value(spec->table, p, zero, false));
    });
  case Form::table:
    return each(u, out, n, [&](const Lanes& x) {
      const Lanes p = xsimd::min(xsimd::max(xsimd::min(x, one - x), Lanes(0x1p-53)), Lanes(0x1.fffffffffffffp-2));
      return c[0] + c[1] * table_value(spec->table, p, xsimd::select(x < half, zero, one), true);
    });
  }
}

void uniforms(const random::Stream* stream, std::uint64_t first, std::size_t n, double* out) {
  fill_uniforms_in_lanes(*stream, first, n, out);
}

void latin_hypercube(const random::Stream* stream, const random::Permutation* strata, std::uint64_t first, std::size_t n,
                     double* out) {
  fill_latin_in_lanes(*stream, *strata, first, n, out);
}

void normal_probability(const double* z, double* out, std::size_t n) {
  each(z, out, n, [](const Lanes& x) {
    return xsimd::min(xsimd::max(normal_probability_lane(x), Lanes(0x1p-1022)), Lanes(0x1.fffffffffffffp-1));
  });
}

} // namespace
} // namespace gumshoe::quantities

extern "C" const gumshoe::quantities::Kernels GUMSHOE_KERNEL(gumshoe_quantity_kernels_);
const gumshoe::quantities::Kernels GUMSHOE_KERNEL(gumshoe_quantity_kernels_) = {
    gumshoe::quantities::uniforms, gumshoe::quantities::latin_hypercube, gumshoe::quantities::quantile,
    gumshoe::quantities::normal_probability};
