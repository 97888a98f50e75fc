#pragma once
/// Zc(psi): the highest height of the tool's centre at which an insert at spindle angle psi covers the trigger's share
/// of the beam. Geometry alone; the motion comes in insert_trigger.h.
#include "models/tool_length/trigger/insert_cover.h"
#include "models/tool_length/trigger/insert_pass.h"

namespace gumshoe::models::tool_length {

struct HeightNode {
  double angle = 0;
  double height = 0; ///< of the tool's centre above the laser reference point, m
  double slope = 0;  ///< by the angle, m/rad
  bool covered = false;
  double most = 0; ///< not covered: the largest area reached at any height
};

/// Zc of one insert in one beam. The constructor finds its highest point and whether there is cover at all.
class InsertHeight {
public:
  InsertHeight(const Insert<double>& insert, const Beam<double>& beam);

  /// Zc at a spindle angle, rad. Absolute error below 1e-13 m. `hint`: a height nearby, m, or NaN.
  HeightNode at(double angle, double hint) const;
  /// Below this width in angle Zc is taken to have one hump or valley at most.
  double resolution() const { return resolution_; }
  bool ever_covered() const { return ever_covered_; }
  /// The highest height over all angles; only if ever_covered().
  const HeightNode& highest() const { return highest_; }

  const InsertPass& bound() const { return bound_; }
  const InsertBody<double>& body() const { return body_; }
  double target() const { return target_; }

private:
  void consider(const HeightNode& n);
  void search(const HeightNode& a, const HeightNode& b);
  void seek_narrow_cover(double angle, double step);
  InsertBody<double> body_;
  double beam_radius_, target_;
  InsertPass bound_;
  double resolution_ = 0;
  bool ever_covered_ = false;
  HeightNode highest_, widest_;
};

/// The height at another angle along the tangent, a hint for InsertHeight::at; NaN if there is no cover.
inline double guess(double angle, const HeightNode& n) {
  return n.covered ? n.height + n.slope * (angle - n.angle) : std::nan("");
}

/// Angle at which d(height + drift angle)/d(angle) changes from + to -, between two nodes where it does. With `wanted`,
/// only as precisely as needed to decide whether height + drift angle reaches it.
HeightNode hump(const InsertHeight& heights, HeightNode a, HeightNode b, double drift, double wanted = std::nan(""));

} // namespace gumshoe::models::tool_length
