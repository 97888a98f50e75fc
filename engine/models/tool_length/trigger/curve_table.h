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
    double from = 0, per_unit = 1; ///< parts begin at `from`, so many a unit
  };
  std::vector<CurvePiece> pieces;
  Start by_x, by_angle;
  double drop = 0, period = 0, per_period = 0; ///< per_period: one over the period
};

/// Rows of TriggerCurve::Point.
struct CurvePoints {
  double *height, *slope, *from, *to, *before;
  CurvePoints from_row(std::size_t i) const { return {height + i, slope + i, from + i, to + i, before + i}; }
};

/// Readings of a characteristic curve (curve_fit.h): what a scan of the phase looks at.
struct CurveScan {
  std::size_t readings = 0, flutes = 0;
  double drop = 0;                           ///< m per rad; of all readings, about
  const CurveTable* const* tables = nullptr; ///< [flute][reading]
  const double* lines = nullptr;             ///< [flute][reading], m
  const double* heights = nullptr;           ///< [reading], m
};

struct CurveTableKernels {
  void (*at)(const CurveTable& table, std::size_t n, const double* x, const CurvePoints& out);
  void (*record)(const CurveTable& table, std::size_t n, const double* angle, double* out);
  /// At each of n phases, the longest flutes of which none triggers more than `margin` before its reading: line minus
  /// height at which each begins, `begins` [flute][n], and the sum of squared residuals, `squares` [n].
  void (*longest)(const CurveScan& scan, double margin, std::size_t n, const double* phase, double* begins,
                  double* squares);
};

/// For the best instruction set of this processor; all give the same bits.
const CurveTableKernels& curve_table_kernels();

} // namespace gumshoe::models::tool_length
