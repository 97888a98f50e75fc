#pragma once
/// Rigorous upper bounds on the height at which an insert of any shape covers the share, over intervals of angle.
///
/// What is covered lies above every line that touches the shadow from below, so for every slope t the height is at most
///     D sqrt(1 + t^2) + max over both circles of (t C_y - C_z + rho g(t)),
/// with D the height of the line above which the share of the disc lies.
#include "models/tool_length/trigger/insert_chord.h"

namespace gumshoe::models::tool_length {

class InsertLines {
public:
  InsertLines(const InsertBody<double>& body, const DiscShare& disc);
  /// Height at one angle; minus infinity where the insert misses the beam.
  double at(double angle) const;
  /// True only if k(angle) + fall (angle - from) < limit at all angles from `from` to `to`.
  bool below(double from, double to, double fall, double limit) const;

private:
  bool misses(const RakeView& v, double half) const;
  template <class F> void tangents(const RakeView& v, const F& use) const;
  double line(const RakeView& v, double t, double half, double fall) const;
  RakeBody rake_;
  DiscShare disc_;
  double back_radius_, thickness_, shrink_share_, normal_spread_, tilt_, spread_[2];
};

} // namespace gumshoe::models::tool_length
