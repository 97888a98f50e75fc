#include "models/tool_length/trigger/insert_height.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gumshoe::models::tool_length {

namespace {

/// Lowest and highest z, and the extent in y, of the shadow.
struct Extent {
  double low, high, left, right;
};
Extent extent_of(const InsertShadow<double>& s) {
  const double dy = std::hypot(s.a.y, s.b.y), dz = std::hypot(s.a.z, s.b.z);
  return {std::min(s.rake.z - s.rake_radius * dz, s.back.z - s.back_radius * dz),
          std::max(s.rake.z + s.rake_radius * dz, s.back.z + s.back_radius * dz),
          std::min(s.rake.y - s.rake_radius * dy, s.back.y - s.back_radius * dy),
          std::max(s.rake.y + s.rake_radius * dy, s.back.y + s.back_radius * dy)};
}

} // namespace

InsertHeight::InsertHeight(const Insert<double>& insert, const Beam<double>& beam)
    : body_(insert_body(insert, beam)), beam_radius_(beam.radius),
      target_(beam.fraction * pi * beam.radius * beam.radius), bound_(body_, DiscShare(beam.radius, beam.fraction)) {
  const auto reach = [](const auto& v, double r) { return std::hypot(v.x, v.y) + r; };
  const double outermost = std::max(reach(body_.rake, body_.rake_radius), reach(body_.back, body_.back_radius));
  // The beam smooths Zc over its own width; an insert is passed in no less than its radius.
  const double wanted = std::min(pi / 36, 0.25 * (insert.radius + beam.radius) / outermost);
  const int size = static_cast<int>(std::clamp(std::ceil(2 * pi / wanted), 72.0, 720.0));
  const double step = 2 * pi / size;
  resolution_ = std::min(step, std::max(0.25 * beam.radius / outermost, 1e-4));
  // The most promising first: most others then drop out by their bound.
  std::vector<std::pair<double, double>> parts;
  for (int i = 0; i < size; ++i) parts.emplace_back(bound_.lines().at(step * (i + 0.5)), step * i);
  std::ranges::sort(parts, [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& part : parts) {
    if (ever_covered_ && bound_.below(part.second, part.second + step, 0, highest_.height * body_.cos_pitch)) continue;
    const HeightNode a = at(part.second, std::nan("")), b = at(part.second + step, std::nan(""));
    consider(a);
    consider(b);
    search(a, b);
  }
  if (!ever_covered_ && widest_.most > 0) seek_narrow_cover(widest_.angle, resolution_);
}

/// The insert may reach the beam only between two angles: climb to where it covers most.
void InsertHeight::seek_narrow_cover(double angle, double step) {
  double lo = angle - step, hi = angle + step;
  for (int i = 0; i < 60; ++i) {
    const double a = lo + 0.382 * (hi - lo), b = hi - 0.382 * (hi - lo);
    const HeightNode na = at(a, std::nan("")), nb = at(b, std::nan(""));
    if (na.covered || nb.covered) {
      ever_covered_ = true;
      highest_ = na.covered ? na : nb;
      return;
    }
    (na.most > nb.most ? hi : lo) = na.most > nb.most ? b : a;
  }
}

void InsertHeight::consider(const HeightNode& n) {
  if (n.most > widest_.most) widest_ = n;
  if (!n.covered || (ever_covered_ && n.height <= highest_.height)) return;
  ever_covered_ = true;
  highest_ = n;
}

void InsertHeight::search(const HeightNode& a, const HeightNode& b) {
  if (ever_covered_ && bound_.below(a.angle, b.angle, 0, highest_.height * body_.cos_pitch)) return;
  if (b.angle - a.angle > resolution_) {
    const HeightNode middle = at(0.5 * (a.angle + b.angle), a.covered ? a.height : b.height);
    consider(middle);
    search(a, middle);
    search(middle, b);
    return;
  }
  if (!(a.covered && b.covered && a.slope > 0 && b.slope < 0)) return;
  const HeightNode top = hump(*this, a, b, 0.0);
  consider(top);
}

HeightNode InsertHeight::at(double angle, double hint) const {
  HeightNode node;
  node.angle = angle;
  const InsertShadow<double> s = insert_shadow(body_, angle);
  const Extent e = extent_of(s);
  if (e.left >= beam_radius_ || e.right <= -beam_radius_) return node;
  const Joints<double> j = joints(s);
  // k between lo (covered, or too low) and hi (not covered, too high); the covered area's square root is concave in k
  // where it is positive (Brunn-Minkowski), so its slope tells on which side of the largest cover k lies.
  double lo = -beam_radius_ - e.high, hi = beam_radius_ - e.low;
  double k = hint == hint ? hint * body_.cos_pitch : std::nan("");
  if (!(k > lo && k < hi)) k = std::clamp(-e.low, lo + 0.25 * (hi - lo), hi - 1e-3 * (hi - lo));
  const double root_target = std::sqrt(target_);
  InsertParts parts;
  InsertCover<double> cover{0, 0};
  bool found = false;
  for (int i = 0; i < 200; ++i) {
    parts = insert_parts(s, j, k, beam_radius_);
    cover = insert_cover(s, j, k, beam_radius_, parts);
    node.most = std::max(node.most, cover.area);
    double next = std::nan("");
    if (cover.area >= target_) {
      lo = k;
      found = true;
    } else if (cover.area > 0 ? cover.slope > 0 : !parts.above) {
      lo = k;
    } else {
      hi = k;
    }
    if (cover.area > 0 && cover.slope < 0)
      next = k - (std::sqrt(cover.area) - root_target) * 2 * std::sqrt(cover.area) / cover.slope;
    if (std::fabs(next - k) < 1e-15 + 1e-14 * beam_radius_) {
      found = true;
      break;
    }
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (hi - lo < 1e-16 + 4e-16 * std::fabs(hi)) break;
    k = next;
  }
  if (!found) return node;
  if (!(cover.slope < 0)) { // the bracket closed from below: no slope there
    parts = insert_parts(s, j, lo, beam_radius_);
    cover = insert_cover(s, j, lo, beam_radius_, parts);
    k = lo;
  }
  node.covered = true;
  node.height = k / body_.cos_pitch;
  using D = Dual<double, 1>;
  const InsertShadow<D> turned = insert_shadow(converted<D>(body_), D::variable(angle, 0));
  const auto by_angle = insert_cover(turned, joints(turned), D(k), D(beam_radius_), parts);
  node.slope = cover.slope < 0 ? -by_angle.area.d[0] / (cover.slope * body_.cos_pitch) : 0;
  return node;
}

HeightNode hump(const InsertHeight& heights, HeightNode a, HeightNode b, double drift, double wanted) {
  const auto value = [&](const HeightNode& n) { return n.height + drift * n.angle; };
  HeightNode best = value(a) > value(b) ? a : b;
  for (int i = 0; i < 100 && b.angle - a.angle > 1e-12; ++i) {
    const double fa = a.slope + drift, fb = b.slope + drift, width = b.angle - a.angle;
    // one hump: its top lies below both tangents
    if (value(best) >= wanted || value(a) + fa * width < wanted || value(b) - fb * width < wanted) break;
    // regula falsi kept away from the ends, with a halving every third step
    double share = std::clamp(fa / (fa - fb), 1e-4, 1 - 1e-4);
    if (i % 3 == 2) share = 0.5;
    const HeightNode middle = heights.at(a.angle + share * width, guess(a.angle + share * width, best));
    if (!middle.covered) break;
    if (value(middle) > value(best)) best = middle;
    const double f = middle.slope + drift;
    if (std::fabs(f) < 1e-15) break;
    (f > 0 ? a : b) = middle;
  }
  return best;
}

} // namespace gumshoe::models::tool_length
