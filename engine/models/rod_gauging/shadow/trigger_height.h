#pragma once
/// The trigger height in any scalar: fast chord solve, the general solve where that fails, derivatives.
#include "models/reading.h"
#include "models/rod_gauging/shadow/shadow_area.h"
#include "models/rod_gauging/shadow/shadow_newton.h"

namespace gumshoe::models::rod_gauging {

inline bool finite(const ShadowEdge<double>& e) { return std::isfinite(e.rho + e.depth + e.shear + e.side); }

/// The general solve for one rod; the fallback of the lanes, too.
inline Solved<double> general_height(const Rod<double>& rod, const Beam<double>& beam) {
  const ShadowEdge<double> edge = shadow_edge(rod, beam);
  if (!finite(edge)) return {std::nan(""), Status::out_of_domain};
  const BoundarySolve s = solve_boundary(edge, beam.radius, beam.fraction);
  if (s.status != Status::ok) return {std::nan(""), s.status};
  return {bottom_height_of(s.k, rod, beam), Status::ok};
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
  const Rod<double> r = converted<double>(rod);
  const Beam<double> b = converted<double>(beam);
  const ShadowEdge<double> plain = shadow_edge(r, b);
  if (!finite(plain)) return {T(std::nan("")), Status::out_of_domain};
  const auto chord = solve_chord<double>(plain, b.radius, b.fraction);
  const BoundarySolve s = chord.failed == 0 ? crossings_of(chord) : solve_boundary(plain, b.radius, b.fraction);
  if (s.status != Status::ok) return {T(std::nan("")), s.status};
  const ShadowEdge<T> edge = shadow_edge(rod, beam);
  const T k = refine_height(edge, beam.radius, beam.fraction, s);
  // depth is an absolute value and rho ends at zero: no derivative there.
  const bool kink = plain.depth <= 1e-13 * plain.rho || plain.rho <= 1e-13 * r.radius;
  return {bottom_height_of(k, rod, beam), Status::ok, kink};
}

/// The trigger height in any scalar, m; `outcome` receives failures and kinks. Lanes take the fast chord solve, and
/// those for which it does not hold the general one; samples that have failed already are left as they are.
template <class T> T trigger_height(const Rod<T>& rod, const Beam<T>& beam, Outcome<T>& outcome) {
  const Solved<T> solved = differentiable_height(rod, beam);
  outcome.fail(solved.status);
  outcome.kink = solved.kink;
  return solved.value;
}
inline double trigger_height(const Rod<double>& rod, const Beam<double>& beam, Outcome<double>& outcome) {
  const auto solved = trigger_height(rod, beam);
  outcome.fail(solved.status);
  return solved.value;
}
inline Lanes trigger_height(const Rod<Lanes>& rod, const Beam<Lanes>& beam, Outcome<Lanes>& outcome) {
  const auto chord = solve_chord<Lanes>(shadow_edge(rod, beam), beam.radius, beam.fraction);
  const Lanes fast = bottom_height_of(chord.k, rod, beam);
  const auto general = !(chord.failed < Lanes(0.5));
  if (!num::any(general)) return fast;
  double height[Lanes::size];
  fast.store_unaligned(height);
  for (std::size_t l = 0; l < Lanes::size; ++l) {
    if (!general.get(l) || outcome.status[l] != Status::ok) continue;
    const auto lane = [l](const Lanes& x) { return x.get(l); };
    const auto solved = general_height(converted<double>(rod, lane), converted<double>(beam, lane));
    height[l] = solved.value;
    outcome.fail(l, solved.status);
  }
  return Lanes::load_unaligned(height);
}

} // namespace gumshoe::models::rod_gauging
