/// Compiled once per instruction set: pieces are looked up one by one and read in lanes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>

#include "chain/turning_tool.h"
#include "math/scalar.h"
#include "models/tool_length/trigger/curve_table.h"
#include "models/tool_length/trigger/selections.h"

namespace gumshoe::models::tool_length {
namespace {

constexpr std::size_t width = Lanes::size;

/// Pieces side by side: the fields of CurvePiece.
struct Pieces {
  Lanes low, begin, x, end, width, rise, bend, third, span, from, to, before;
};
static_assert(sizeof(Pieces) / sizeof(Lanes) == sizeof(CurvePiece) / sizeof(double));

/// The pieces of some numbers y, the first that `passed(piece, following)` does not pass over: fields `first` to
/// `last`, excluded, of them. NaN has no piece; any will do.
template <std::size_t first_field, std::size_t last_field, class Passed, std::size_t... Lane>
[[gnu::always_inline]] inline Pieces pieces_of(const CurveTable& table, const CurveTable::Start& start, const Lanes& y,
                                               const Passed& passed, std::index_sequence<Lane...>) {
  double at[width], numbers[width];
  const Lanes part = (y - Lanes(start.from)) * Lanes(start.per_unit), last(static_cast<double>(start.first.size() - 1));
  smaller(num::select(part > Lanes(0.0), part, Lanes(0.0)), last).store_unaligned(at);
  y.store_unaligned(numbers);
  const CurvePiece* const pieces = table.pieces.data();
  const CurvePiece* const end = pieces + table.pieces.size() - 1;
  const auto find = [&](double place, double number) [[gnu::always_inline]] {
    const CurvePiece* piece = pieces + start.first[static_cast<std::size_t>(static_cast<std::int64_t>(place))];
    while (piece < end && passed(piece[0], piece[1], number)) ++piece;
    return reinterpret_cast<const double*>(piece);
  };
  const double* const rows[width] = {find(at[Lane], numbers[Lane])...};
  Pieces out;
  for (std::size_t f = first_field; f < last_field; ++f) reinterpret_cast<Lanes*>(&out)[f] = Lanes({rows[Lane][f]...});
  return out;
}
constexpr std::make_index_sequence<width> lanes;

/// s where the piece has fallen by `depth` from its end, to 1e-10.
Lanes reached(const Pieces& p, const Lanes& depth) {
  Lanes low(0.0), high = p.span;
  // From the parabola at the end, which is the top of a hump or near one.
  const Lanes down = num::select(depth > Lanes(0.0), depth, Lanes(0.0));
  const Lanes square = p.rise * p.rise + 4.0 * p.bend * down;
  Lanes s = 2.0 * down / (p.rise + num::sqrt(num::select(square > Lanes(0.0), square, Lanes(0.0))));
  s = num::select(s < p.span, s, p.span); // where the parabola does not reach so far, or there is none (NaN), too
  auto active = everywhere<Lanes>(true);
  for (int i = 0; i < 80; ++i) {
    const Lanes fallen = s * (p.rise + s * (p.bend + s * p.third)) - down;
    const Lanes bend = p.bend + 3.0 * s * p.third, slope = p.rise + s * (p.bend + bend);
    const auto beyond = fallen >= Lanes(0.0);
    high = num::select(beyond, s, high);
    low = num::select(beyond, low, s);
    // Halley's step: the cubic's first two derivatives.
    const Lanes square_slope = slope * slope, halley = s - fallen * slope / (square_slope - fallen * bend);
    const auto inside = halley >= low && halley <= high;
    const Lanes next = num::select(inside, halley, 0.5 * (low + high));
    // What it leaves.
    const Lanes step = num::abs(next - s), left = step * step * step * num::abs(bend * bend - p.third * slope);
    const auto settled = (inside && left < 1e-10 * square_slope) || step < Lanes(1e-10);
    s = num::select(active, next, s);
    active = active && !settled;
    if (!num::any(active)) break;
  }
  return s;
}

/// Calls f(i, lanes) on groups of n numbers; f returns what to store, row by row.
template <class F> void in_groups(std::size_t n, const double* from, const F& f) {
  for (std::size_t i = 0; i < n; i += width) {
    if (i + width <= n) {
      f(i, width, Lanes::load_unaligned(from + i));
      continue;
    }
    double last[width];
    for (std::size_t l = 0; l < width; ++l) last[l] = from[std::min(i + l, n - 1)];
    f(i, n - i, Lanes::load_unaligned(last));
  }
}
void store(const Lanes& x, std::size_t count, double* to) {
  if (count == width) return x.store_unaligned(to);
  double all[width];
  x.store_unaligned(all);
  std::copy_n(all, count, to);
}

/// Numbers y of the table's first turn and how far they were shifted.
struct Turned {
  Lanes y, shift;
};
Turned first_turn(const CurveTable& table, const Lanes& line) {
  const Lanes shift = xsimd::floor((line - Lanes(table.by_x.from)) * Lanes(table.per_period)) * Lanes(table.period);
  return {line - shift, shift};
}
constexpr auto passed_x = [](const CurvePiece& piece, const CurvePiece&, double number) { return piece.x < number; };
constexpr auto passed_angle = [](const CurvePiece&, const CurvePiece& next, double number) {
  return next.begin <= number;
};

Lanes height_on(const Pieces& p, const Lanes& y, const Lanes& s, const Lanes& drop) {
  return num::select(p.span == Lanes(0.0), y - drop * p.end, y - drop * (p.end - p.width * s));
}

Lanes height_of(const CurveTable& table, const Lanes& line) {
  const Lanes y = first_turn(table, line).y;
  const Pieces p = pieces_of<2, 9>(table, table.by_x, y, passed_x, lanes);
  return height_on(p, y, reached(p, p.x - y), Lanes(table.drop));
}

Lanes record_of(const CurveTable& table, const Lanes& turned) {
  const Lanes turn(2 * std::numbers::pi), per_turn(0.5 / std::numbers::pi);
  const Lanes turns = xsimd::floor((turned - Lanes(table.by_angle.from)) * per_turn), psi = turned - turns * turn;
  const Pieces p = pieces_of<0, 8>(table, table.by_angle, psi, passed_angle, lanes);
  const Lanes s = (p.end - psi) / p.width;
  const Lanes on = p.x - s * (p.rise + s * (p.bend + s * p.third));
  const Lanes reach = num::select(psi >= p.end, p.x, num::select(psi < p.begin, p.low, on));
  return turns * Lanes(table.period) + reach;
}

void at(const CurveTable& table, std::size_t n, const double* x, const CurvePoints& out) {
  const Lanes drop(table.drop);
  in_groups(n, x, [&](std::size_t i, std::size_t count, const Lanes& line) {
    const auto [y, shift] = first_turn(table, line);
    const Pieces p = pieces_of<2, 12>(table, table.by_x, y, passed_x, lanes);
    const auto wall = p.span == Lanes(0.0);
    const Lanes s = reached(p, p.x - y), least = 1e-6 * drop * p.width;
    const Lanes slope = p.rise + s * (2.0 * p.bend + s * 3.0 * p.third),
                rise = num::select(slope < least, least, slope);
    store(height_on(p, y, s, drop), count, out.height + i);
    store(num::select(wall, Lanes(1.0), (slope - drop * p.width) / rise), count, out.slope + i);
    store(p.from + shift, count, out.from + i);
    store(p.to + shift, count, out.to + i);
    store(p.before, count, out.before + i);
  });
}

void record(const CurveTable& table, std::size_t n, const double* angle, double* out) {
  in_groups(n, angle, [&](std::size_t i, std::size_t count, const Lanes& turned) {
    store(record_of(table, turned), count, out + i);
  });
}

void longest(const CurveScan& scan, double margin, std::size_t n, const double* phase, double* begins,
             double* squares) {
  std::array<Lanes, chain::most_inserts> begin;
  in_groups(n, phase, [&](std::size_t at, std::size_t count, const Lanes& u) {
    for (std::size_t k = 0; k < scan.flutes; ++k) {
      begin[k] = Lanes(-1e300);
      for (std::size_t i = 0; i < scan.readings; ++i) {
        const CurveTable& table = *scan.tables[k * scan.readings + i];
        const Lanes line(scan.lines[k * scan.readings + i]);
        const Lanes angle = (line + u - Lanes(scan.heights[i]) - Lanes(margin)) / Lanes(scan.drop);
        begin[k] = larger(begin[k], record_of(table, angle) - line);
      }
      store(begin[k], count, begins + k * n + at);
    }
    Lanes sum(0.0);
    for (std::size_t i = 0; i < scan.readings; ++i) {
      Lanes highest(-1e300);
      for (std::size_t k = 0; k < scan.flutes; ++k) {
        const CurveTable& table = *scan.tables[k * scan.readings + i];
        const Lanes line(scan.lines[k * scan.readings + i]);
        highest = larger(highest, (u - begin[k]) + height_of(table, line + begin[k]));
      }
      const Lanes residual = highest - Lanes(scan.heights[i]);
      sum = sum + residual * residual;
    }
    store(sum, count, squares + at);
  });
}

} // namespace
} // namespace gumshoe::models::tool_length

extern "C" const gumshoe::models::tool_length::CurveTableKernels GUMSHOE_KERNEL(gumshoe_curve_table_);
const gumshoe::models::tool_length::CurveTableKernels GUMSHOE_KERNEL(gumshoe_curve_table_) = {
    gumshoe::models::tool_length::at, gumshoe::models::tool_length::record, gumshoe::models::tool_length::longest};
