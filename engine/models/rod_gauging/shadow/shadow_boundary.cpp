#include "models/rod_gauging/shadow/shadow_boundary.h"

#include <limits>

#include <boost/math/tools/toms748_solve.hpp>

#include "models/rod_gauging/shadow/shadow_area.h"

namespace gumshoe::models::rod_gauging {

namespace {

using Edge = ShadowEdge<double>;

template <class F> double bracketed_root(const F& f, double a, double b, double fa, double fb) {
  if (fa == 0) return a;
  if (fb == 0) return b;
  std::uintmax_t iterations = 200;
  const auto tolerance = [](double lo, double hi) { return hi - lo <= 4e-16 * std::max(std::fabs(lo), std::fabs(hi)); };
  const auto [lo, hi] = boost::math::tools::toms748_solve(f, a, b, fa, fb, tolerance, iterations);
  return 0.5 * (lo + hi);
}

/// d/dw of half the squared distance to the beam's axis, over the half-ellipse without its offset
/// (the offset runs along the normal and does not change the sign): p sin 2w + q cos 2w + u cos w + v sin w.
struct DistanceSlope {
  double p, q, u, v, sign;
  DistanceSlope(const Edge& e, double k, double side_sign)
      : p(0.5 * (e.rho * e.rho * (1 + e.shear * e.shear) - e.depth * e.depth)), q(-e.shear * e.rho * e.depth),
        u((e.side + k * e.shear) * e.rho), v(k * e.depth), sign(side_sign) {}
  // In t = pi/2 - |w|: sin w = sign cos t, cos w = sin t.
  double operator()(double t) const {
    const double s = sign * std::cos(t), c = std::sin(t);
    return 2 * p * s * c + q * (c * c - s * s) + u * c + v * s;
  }
  double slope(double t) const { // by w, up to the sign of dw/dt
    const double s = sign * std::cos(t), c = std::sin(t);
    return 2 * p * (c * c - s * s) - 4 * q * s * c - u * s + v * c;
  }
  double bound1() const { return 2 * (std::fabs(p) + std::fabs(q)) + std::fabs(u) + std::fabs(v); }
  double bound2() const { return 4 * (std::fabs(p) + std::fabs(q)) + std::fabs(u) + std::fabs(v); }
};

/// All simple roots in [lo, hi]: an interval is dropped if the value bound excludes a root, searched if
/// the slope bound proves it monotone, halved otherwise.
void isolate(const DistanceSlope& f, double lo, double hi, std::vector<double>& roots) {
  const double mid = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  const double at_mid = f(mid);
  if (std::fabs(at_mid) > f.bound1() * half) return;
  if (std::fabs(f.slope(mid)) > f.bound2() * half) {
    const double a = f(lo), b = f(hi);
    if ((a > 0) != (b > 0)) roots.push_back(bracketed_root(f, lo, hi, a, b));
    return;
  }
  if (hi - lo < 1e-10 * hi || hi < 1e-15) return; // a double root: the distance stays monotone
  isolate(f, lo, mid, roots);
  isolate(f, mid, hi, roots);
}

/// The boundary as arcs on which the distance to the beam's axis is monotone, in order of travel.
struct Stop {
  Piece piece;
  double t;
};

class Boundary {
public:
  Boundary(const Edge& e, double beam_radius) : e_(e), r_(beam_radius) {
    scale_ = e.rho + e.fillet;
    ball_ = e_.rho <= 1e-13 * scale_;
    if (ball_) e_.rho = e_.depth = 0;
    flat_ = !ball_ && e_.depth <= 1e-13 * e_.rho;
    if (flat_) e_.depth = 0;
  }

  const Edge& edge() const { return e_; }

  std::vector<Crossing> crossings(double k) const {
    std::vector<Crossing> found;
    const double top = 2 * r_ + std::fabs(k) + std::fabs(e_.shear) * e_.rho + scale_;
    bool inside = false; // far up on the left wall
    const auto visit = [&](Piece piece, double from, double to) {
      const auto d = [&](double t) { return gap(k, piece, t); };
      const double d_to = d(to);
      if ((d_to < 0) == inside) return;
      double d_from = d(from);
      if ((d_from < 0) != inside)
        d_from = inside ? -std::numeric_limits<double>::min() : std::numeric_limits<double>::min();
      found.push_back(
          {piece, from < to ? bracketed_root(d, from, to, d_from, d_to) : bracketed_root(d, to, from, d_to, d_from)});
      inside = d_to < 0;
    };
    const auto travel = [&](Piece piece, double from, double to, std::vector<double> stationary) {
      std::ranges::sort(stationary);
      if (to < from) std::ranges::reverse(stationary);
      double at = from;
      for (const double s : stationary)
        if ((s - from) * (s - to) < 0) visit(piece, at, s), at = s;
      visit(piece, at, to);
    };
    const double corner_l = -e_.shear * e_.rho + k, corner_r = e_.shear * e_.rho + k;
    travel(Piece::left_wall, top, corner_l, {0.0});
    if (ball_) {
      travel(Piece::left_fan, -0.5 * pi, 0.5 * pi, fan_stationary(k, -1));
    } else {
      const double nu = std::atan(e_.shear);
      if (flat_) travel(Piece::left_fan, -0.5 * pi, nu, fan_stationary(k, -1));
      const double start = flat_ ? 1e-9 : 0.0; // a flat bottom starts at its corner: the fan's end
      travel(Piece::left_quarter, start, 0.5 * pi, quarter_stationary(k, -1));
      travel(Piece::right_quarter, 0.5 * pi, start, quarter_stationary(k, 1));
      if (flat_) travel(Piece::right_fan, nu, 0.5 * pi, fan_stationary(k, 1));
    }
    travel(Piece::right_wall, corner_r, top, {0.0});
    return found;
  }

  /// Area covered when the edge has passed below the beam: the strip between the walls.
  double most() const {
    const auto primitive = [&](double y) {
      const double x = std::clamp(y / r_, -1.0, 1.0);
      return r_ * r_ * (std::asin(x) + x * std::sqrt(1 - x * x));
    };
    return primitive(e_.side + scale_) - primitive(e_.side - scale_);
  }

  /// Whether the beam's axis lies in the shadow.
  bool contains_axis(double k) const {
    if (std::fabs(e_.side) >= scale_) return false;
    std::vector<Stop> arc;
    double lo, hi;
    Piece piece;
    const double nu = std::atan(e_.shear);
    const auto y = [&](Piece p, double t) { return boundary_point(e_, k, p, t).y; };
    if (ball_)
      piece = Piece::left_fan, lo = -0.5 * pi, hi = 0.5 * pi;
    else if (flat_ && y(Piece::left_fan, nu) > 0)
      piece = Piece::left_fan, lo = -0.5 * pi, hi = nu;
    else if (flat_ && y(Piece::right_fan, nu) < 0)
      piece = Piece::right_fan, lo = nu, hi = 0.5 * pi;
    else if (y(Piece::left_quarter, 0.5 * pi) > 0)
      piece = Piece::left_quarter, lo = flat_ ? 1e-9 : 0.0, hi = 0.5 * pi;
    else
      piece = Piece::right_quarter, lo = 0.5 * pi, hi = flat_ ? 1e-9 : 0.0;
    for (int i = 0; i < 100; ++i) {
      const double mid = 0.5 * (lo + hi);
      (y(piece, mid) < 0 ? lo : hi) = mid;
    }
    return boundary_point(e_, k, piece, 0.5 * (lo + hi)).z < 0;
  }

  Covered<double> covered_at(double k, const std::vector<Crossing>& crossings) const {
    if (crossings.empty()) return {contains_axis(k) ? pi * r_ * r_ : 0.0, 0.0};
    std::vector<double> t;
    for (const Crossing& c : crossings) t.push_back(c.t);
    return covered(e_, k, r_, crossings, t);
  }

  double lowest_k() const { return -r_ - std::fabs(e_.shear) * e_.rho; }
  double highest_k() const { return r_ + std::fabs(e_.shear) * e_.rho + e_.depth + e_.fillet; }

private:
  double gap(double k, Piece piece, double t) const {
    const auto p = boundary_point(e_, k, piece, t);
    return (p.y * p.y + p.z * p.z - r_ * r_) / (r_ * r_);
  }
  std::vector<double> quarter_stationary(double k, double sign) const {
    std::vector<double> roots;
    isolate(DistanceSlope(e_, k, sign), 0.0, 0.5 * pi, roots);
    return roots;
  }
  /// On a corner's arc the distance is stationary where the normal points along the corner's radius.
  std::vector<double> fan_stationary(double k, double sign) const {
    const double y = e_.side + sign * e_.rho, z = k + sign * e_.shear * e_.rho;
    const double nu = std::atan2(y, -z); // N = (sin nu, -cos nu) parallel to (y, z)
    return {nu, nu > 0 ? nu - pi : nu + pi};
  }

  Edge e_;
  double r_, scale_;
  bool flat_ = false, ball_ = false;
};

} // namespace

BoundarySolve solve_boundary(const ShadowEdge<double>& edge, double beam_radius, double fraction) {
  const Boundary boundary(edge, beam_radius);
  BoundarySolve result;
  const double target = pi * beam_radius * beam_radius * fraction;
  if (!(target < boundary.most())) {
    result.status = Status::never_covered;
    return result;
  }
  // The covered area falls with k, from `most` to nothing: Newton, kept inside a shrinking bracket.
  double lo = boundary.lowest_k(), hi = boundary.highest_k(), k = 0.5 * (lo + hi);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const auto crossings = boundary.crossings(k);
    const auto c = boundary.covered_at(k, crossings);
    const double excess = c.area - target;
    double next = k + excess / c.chord;
    (excess > 0 ? lo : hi) = k;
    const bool newton = next >= lo && next <= hi; // false for NaN too
    if (!newton) next = 0.5 * (lo + hi);
    const double step = std::fabs(next - k);
    k = next;
    const bool bracketed = hi - lo <= 4e-16 * std::max(std::fabs(lo), std::fabs(hi));
    if ((newton && step < 1e-9 * beam_radius) || bracketed) {
      result.k = k;
      result.crossings = boundary.crossings(k);
      if (result.crossings.empty() || result.crossings.size() % 2) break;
      // The step just made squared the error; what is left is rounding, of products as large as depth rho and
      // k (rho + fillet), over the chord that turns area into height. Flat bottoms seen edge-on need more digits.
      const double products = edge.depth * edge.rho + std::fabs(k) * (edge.rho + edge.fillet);
      if (2e-16 * products > 1e-14 * c.chord) {
        const ShadowEdge<long double> fine{edge.rho, edge.depth, edge.shear, edge.fillet, edge.side};
        result.k = static_cast<double>(refine_height<long double>(fine, beam_radius, fraction, result));
        if (!(1e-19 * products < 1e-13 * c.chord)) break;
      }
      return result;
    }
  }
  result.status = Status::not_converged;
  return result;
}

} // namespace gumshoe::models::rod_gauging
