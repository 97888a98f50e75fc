#pragma once
/// The trigger height in any scalar: fast chord solve, the general solve where that fails, derivatives.
#include "models/rod_gauging/shadow/shadow_area.h"
#include "models/rod_gauging/shadow/shadow_newton.h"

namespace gumshoe::models::rod_gauging {

inline bool in_domain(const Rod<double>& rod, const Beam<double>& beam) {
  return rod.radius > 0 && rod.fillet_radius >= 0 && rod.fillet_radius <= rod.radius && rod.bottom_elevation > 0 &&
         rod.bottom_elevation < pi && beam.radius > 0 && beam.fraction > 0 && beam.fraction < 1 &&
         std::fabs(beam.pitch) < 0.5 * pi && std::isfinite(rod.radius + beam.radius + beam.yaw + rod.bottom_azimuth) &&
         std::isfinite(rod.axis_x + rod.axis_y);
}

/// The general solve for one rod; the fallback of the lanes, too.
inline Solved<double> general_height(const Rod<double>& rod, const Beam<double>& beam) {
  if (!in_domain(rod, beam)) return {std::nan(""), Status::out_of_domain};
  const BoundarySolve s = solve_boundary(shadow_edge(rod, beam), beam.radius, beam.fraction);
  if (s.status != Status::ok) return {std::nan(""), s.status};
  return {bottom_height_of(s.k, rod, beam), Status::ok};
}

template <class T> Rod<double> value(const Rod<T>& r) {
  return {num::value(r.radius),         num::value(r.fillet_radius), num::value(r.bottom_elevation),
          num::value(r.bottom_azimuth), num::value(r.axis_x),        num::value(r.axis_y)};
}
template <class T> Beam<double> value(const Beam<T>& b) {
  return {num::value(b.yaw), num::value(b.pitch), num::value(b.radius), num::value(b.fraction)};
}

/// The solved chord as crossings of the boundary, for carrying derivatives along.
inline BoundarySolve crossings_of(const ChordSolve<double>& chord) {
  const auto crossing = [](double s) {
    return Crossing{s < 0 ? Piece::left_quarter : Piece::right_quarter, std::acos(std::fabs(s))};
  };
  return {chord.k, {crossing(chord.left), crossing(chord.right)}, Status::ok};
}

/// Height with its derivatives, for dual numbers; `kink` where there are none.
template <class T> Solved<T> differentiable_height(const Rod<T>& rod, const Beam<T>& beam) {
  const Rod<double> r = value(rod);
  const Beam<double> b = value(beam);
  if (!in_domain(r, b)) return {T(std::nan("")), Status::out_of_domain};
  const ShadowEdge<double> plain = shadow_edge(r, b);
  const auto chord = solve_chord<double>(plain, b.radius, b.fraction);
  const BoundarySolve s = chord.failed == 0 ? crossings_of(chord) : solve_boundary(plain, b.radius, b.fraction);
  if (s.status != Status::ok) return {T(std::nan("")), s.status};
  const ShadowEdge<T> edge = shadow_edge(rod, beam);
  const T k = refine_height(edge, beam.radius, beam.fraction, s);
  // depth is an absolute value and rho ends at zero: no derivative there.
  const bool kink = plain.depth <= 1e-13 * plain.rho || plain.rho <= 1e-13 * r.radius;
  return {bottom_height_of(k, rod, beam), Status::ok, kink};
}

} // namespace gumshoe::models::rod_gauging
