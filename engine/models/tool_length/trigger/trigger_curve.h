#pragma once
/// The trigger curve of one flute: the height at which an unworn flute triggers as a function of the line on which it
/// comes down, z = x - drop psi over its own angle psi, followed from high above:
///     F(x) = x - drop psi at the first psi where the line meets Zc,   F(x + 2 pi drop) = F(x).
/// The line meets Zc first where G(psi) = Zc + drop psi reaches x: only the records of G count, so one pass over a turn
/// tabulates F. Interpolated by cubics between exact heights and slopes.
#include <span>
#include <vector>

#include "models/tool_length/trigger/curve_table.h"
#include "models/tool_length/trigger/insert_height.h"

namespace gumshoe::models::tool_length {

class TriggerCurve {
public:
  /// `heights.ever_covered()`, `drop` > 0 in m per rad. Absolute error of F below 1e-11 m where |F'| is below 10: near
  /// the end of a hump, where the line touches Zc, F' grows without bound.
  TriggerCurve(const InsertHeight& heights, double drop);

  struct Point {
    double height;
    double slope;    ///< dF/dx, to -1e6 where the line touches Zc
    double from, to; ///< F is continuous in between and jumps down at these
    double before;   ///< limit of F at `from`, coming from below
  };
  Point at(double x) const;
  /// The same for many lines, in SIMD lanes; the bits do not depend on how many there are.
  void at(std::span<const double> x, const CurvePoints& out) const;
  /// The record of G up to each angle: a flute on a line of greater x has not triggered there yet.
  void record(std::span<const double> angle, double* out) const;
  double record(double angle) const;
  /// Descent per turn.
  double period() const { return period_; }
  double highest() const { return highest_; }
  const CurveTable& table() const { return table_; }

private:
  /// G = x over [x0, x1] at angle + width t, t over [t0, t1]: Zc = c[0] + c[1] t + c[2] t^2 + c[3] t^3. A wall, where
  /// the cover begins all at once, has t0 = t1.
  struct Piece {
    double x0, x1, t0, t1, angle, width, c[4];
    std::size_t run = 0; ///< pieces of one run join
  };
  double reach(const Piece& p, double t) const;
  double solve(const Piece& p, double t0, double t1, double x) const;
  void cover(const HeightNode& a, const HeightNode& b);
  void add(const HeightNode& a, const HeightNode& b);
  void wall(const HeightNode& b);

  const InsertHeight* heights_; ///< only while tabulating
  double drop_, period_, highest_, begin_, record_;
  struct Run {
    double from, to, end; ///< in x; F at `to`
  };
  void join_runs();
  std::vector<Piece> pieces_;
  void tabulate(double first);
  std::vector<Run> runs_;
  CurveTable table_;
};

} // namespace gumshoe::models::tool_length
