/// Compiled once per instruction set: pieces are looked up one by one and read in lanes.
#include <algorithm>
#include <numbers>

#include "math/scalar.h"
#include "models/tool_length/trigger/curve_table.h"

namespace gumshoe::models::tool_length {
namespace {

constexpr std::size_t width = Lanes::size;

/// Pieces side by side: the fields of CurvePiece.
struct Pieces {
  Lanes low, begin, x, end, width, rise, bend, third, span, from, to, before;
};
static_assert(sizeof(Pieces) / sizeof(Lanes) == sizeof(CurvePiece) / sizeof(double));

/// The pieces of some numbers y, the first that `passed(piece, following)` does not pass over: fields `first` to
/// `last`, excluded, of them.
template <std::size_t first_field, std::size_t last_field, class Passed>
Pieces pieces_of(const CurveTable& table, const CurveTable::Start& start, const Lanes& y, const Passed& passed) {
  double at[width], rows[last_field][width], numbers[width];
  const Lanes part = (y - Lanes(start.from)) * Lanes(1 / start.step), last(static_cast<double>(start.first.size() - 1));
  xsimd::min(xsimd::max(part, Lanes(0.0)), last).store_unaligned(at);
  y.store_unaligned(numbers);
  const std::size_t size = table.pieces.size();
  for (std::size_t l = 0; l < width; ++l) {
    // NaN has no piece; any will do
    std::size_t i = at[l] == at[l] ? start.first[static_cast<std::size_t>(at[l])] : 0;
    while (i + 1 < size && passed(table.pieces[i], table.pieces[i + 1], numbers[l])) ++i;
    const auto* piece = reinterpret_cast<const double*>(&table.pieces[i]);
    for (std::size_t f = first_field; f < last_field; ++f) rows[f][l] = piece[f];
  }
  Pieces out;
  for (std::size_t f = first_field; f < last_field; ++f)
    reinterpret_cast<Lanes*>(&out)[f] = Lanes::load_unaligned(rows[f]);
  return out;
}

/// s where the piece has fallen by `depth` from its end, to 1e-10.
Lanes reached(const Pieces& p, const Lanes& depth) {
  Lanes low(0.0), high = p.span;
  // From the parabola at the end, which is the top of a hump or near one.
  const Lanes down = num::select(depth > Lanes(0.0), depth, Lanes(0.0));
  const Lanes square = p.rise * p.rise + 4.0 * p.bend * down;
  Lanes s = 2.0 * down / (p.rise + num::sqrt(num::select(square > Lanes(0.0), square, Lanes(0.0))));
  s = num::select(s < p.span, s, p.span); // where the parabola does not reach so far, too
  Lanes active(1.0);
  for (int i = 0; i < 80; ++i) {
    const Lanes fallen = s * (p.rise + s * (p.bend + s * p.third)) - down;
    const Lanes bend = p.bend + 3.0 * s * p.third, slope = p.rise + s * (p.bend + bend);
    const auto beyond = fallen >= Lanes(0.0);
    high = num::select(beyond, s, high);
    low = num::select(beyond, low, s);
    const Lanes newton = s - fallen / slope;
    const auto inside = newton >= low && newton <= high;
    const Lanes next = num::select(inside, newton, 0.5 * (low + high));
    // What Newton's step leaves of the cubic.
    const Lanes step = num::abs(next - s), left = step * step * (num::abs(bend) + num::abs(p.third) * step);
    const auto settled = (inside && left < 1e-10 * slope) || step < Lanes(1e-10);
    const auto moving = active > Lanes(0.5);
    s = num::select(moving, next, s);
    active = num::select(settled, Lanes(0.0), active);
    if (!num::any(active > Lanes(0.5))) break;
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

void at(const CurveTable& table, std::size_t n, const double* x, const CurvePoints& out) {
  const Lanes period(table.period), drop(table.drop);
  in_groups(n, x, [&](std::size_t i, std::size_t count, const Lanes& line) {
    const Lanes turns = xsimd::floor((line - Lanes(table.by_x.from)) / period), shift = turns * period;
    const Lanes y = line - shift;
    const Pieces p =
        pieces_of<2, 12>(table, table.by_x, y,
                         [](const CurvePiece& piece, const CurvePiece&, double number) { return piece.x < number; });
    const auto wall = p.span == Lanes(0.0);
    const Lanes s = reached(p, p.x - y), least = 1e-6 * drop * p.width;
    const Lanes slope = p.rise + s * (2.0 * p.bend + s * 3.0 * p.third),
                rise = num::select(slope < least, least, slope);
    store(num::select(wall, y - drop * p.end, y - drop * (p.end - p.width * s)), count, out.height + i);
    store(num::select(wall, Lanes(1.0), (slope - drop * p.width) / rise), count, out.slope + i);
    store(p.from + shift, count, out.from + i);
    store(p.to + shift, count, out.to + i);
    store(p.before, count, out.before + i);
  });
}

void record(const CurveTable& table, std::size_t n, const double* angle, double* out) {
  const Lanes turn(2 * std::numbers::pi);
  in_groups(n, angle, [&](std::size_t i, std::size_t count, const Lanes& turned) {
    const Lanes turns = xsimd::floor((turned - Lanes(table.by_angle.from)) / turn), psi = turned - turns * turn;
    const Pieces p =
        pieces_of<0, 8>(table, table.by_angle, psi,
                        [](const CurvePiece&, const CurvePiece& next, double number) { return next.begin <= number; });
    const Lanes s = (p.end - psi) / p.width;
    const Lanes on = p.x - s * (p.rise + s * (p.bend + s * p.third));
    const Lanes reach = num::select(psi >= p.end, p.x, num::select(psi < p.begin, p.low, on));
    store(turns * Lanes(table.period) + reach, count, out + i);
  });
}

} // namespace
} // namespace gumshoe::models::tool_length

extern "C" const gumshoe::models::tool_length::CurveTableKernels GUMSHOE_KERNEL(gumshoe_curve_table_);
const gumshoe::models::tool_length::CurveTableKernels GUMSHOE_KERNEL(gumshoe_curve_table_) = {
    gumshoe::models::tool_length::at, gumshoe::models::tool_length::record};
