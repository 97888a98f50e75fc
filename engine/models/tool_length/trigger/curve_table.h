#pragma once
/// A tabulated trigger curve (trigger_curve.h) and its reading in SIMD lanes, compiled once per instruction set.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gumshoe::models::tool_length {

/// A piece of the curve as a cubic of s, from its end (s = 0) back to its begin (s = span):
///     G = x - s (rise + s (bend + s third))   at the angle end - width s.
/// A wall, where the cover begins all at once, has span 0.
struct CurvePiece {
  double low, begin; ///< G and the angle at the begin
  double x, end;     ///< at the end
  double width;      ///< angle per s
  double rise, bend, third;
  double span;             ///< s at the begin
  double from, to, before; ///< of its run: TriggerCurve::Point
};

struct CurveTable {
  /// Piece at the begin of each of as many equal parts.
  struct Start {
    std::vector<std::uint32_t> first;
    double from = 0, step = 1;
  };
  std::vector<CurvePiece> pieces;
  Start by_x, by_angle;
  double drop = 0, period = 0;
};

/// Rows of TriggerCurve::Point.
struct CurvePoints {
  double *height, *slope, *from, *to, *before;
  CurvePoints from_row(std::size_t i) const { return {height + i, slope + i, from + i, to + i, before + i}; }
};

struct CurveTableKernels {
  void (*at)(const CurveTable& table, std::size_t n, const double* x, const CurvePoints& out);
  void (*record)(const CurveTable& table, std::size_t n, const double* angle, double* out);
};

/// For the best instruction set of this processor; all give the same bits.
const CurveTableKernels& curve_table_kernels();

} // namespace gumshoe::models::tool_length
