#include "models/tool_length/trigger/trigger_curve.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

namespace {
constexpr double turn = 2 * pi;
/// Midpoint error at which a cell is halved once more and then good: 16 times less.
constexpr double tolerance = 1.6e-11;
constexpr double narrowest = 1e-10; ///< rad: cover begins at once
/// Tolerance of a piece's t: heights are read from the line, x - drop psi, so 1e-9 of 0.1 rad leaves 1e-10 drop.
constexpr double settled = 1e-9;

/// Angles that see every pass of the insert: four while it passes, 72 in a turn at least.
int cells(const InsertBody<double>& b) {
  const double outermost =
      std::max(std::hypot(b.rake.x, b.rake.y) + b.rake_radius, std::hypot(b.back.x, b.back.y) + b.back_radius);
  return static_cast<int>(std::clamp(std::ceil(4 * turn * outermost / b.rake_radius), 72.0, 720.0));
}
} // namespace

TriggerCurve::TriggerCurve(const InsertHeight& heights, double drop)
    : heights_(&heights), drop_(drop), period_(turn * drop), highest_(heights.highest().height) {
  // The highest point is a record of every turn: nothing before it stands higher.
  HeightNode a = heights.highest();
  begin_ = a.angle;
  record_ = a.height + drop_ * a.angle;
  const double step = turn / cells(heights.body()), first = record_;
  int i = static_cast<int>(std::floor(a.angle / step)) + 1;
  for (;; ++i) {
    const double angle = step * i;
    if (angle >= begin_ + turn - 1e-3 * step) break;
    if (angle < begin_ + 1e-3 * step) continue;
    const HeightNode b = heights.at(angle, a.covered ? a.height : std::nan(""));
    cover(a, b);
    a = b;
  }
  HeightNode last = heights.highest();
  last.angle += turn;
  cover(a, last);
  pieces_.back().x1 = first + period_;
  join_runs();
  heights_ = nullptr;
  tabulate(first);
}

void TriggerCurve::tabulate(double first) {
  table_.drop = drop_, table_.period = period_, table_.per_period = 1 / period_;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& p = pieces_[i];
    const Run& run = runs_[p.run];
    const Run& last = runs_[p.run > 0 ? p.run - 1 : runs_.size() > 1 ? runs_.size() - 2 : 0];
    const double end = p.angle + p.width * p.t1, begin = p.angle + p.width * p.t0;
    CurvePiece piece{p.x0, begin, p.x1, end, p.width, 0, 0, 0, p.t1 - p.t0, run.from, run.to, last.end};
    if (p.t0 != p.t1) {
      piece.x = reach(p, p.t1);
      piece.rise = p.c[1] + p.t1 * (2 * p.c[2] + p.t1 * 3 * p.c[3]) + drop_ * p.width;
      piece.bend = -(p.c[2] + p.t1 * 3 * p.c[3]);
      piece.third = p.c[3];
    }
    table_.pieces.push_back(piece);
  }
  const auto spread = [&](CurveTable::Start& start, double from, double whole, auto end_of) {
    start.from = from;
    start.first.resize(8 * pieces_.size());
    const double step = whole / static_cast<double>(start.first.size());
    start.per_unit = 1 / step;
    std::size_t p = 0;
    for (std::size_t k = 0; k < start.first.size(); ++k) {
      while (p + 1 < pieces_.size() && end_of(pieces_[p]) < from + step * static_cast<double>(k)) ++p;
      start.first[k] = static_cast<std::uint32_t>(p);
    }
  };
  spread(table_.by_x, first, period_, [](const Piece& p) { return p.x1; });
  spread(table_.by_angle, begin_, turn, [](const Piece& p) { return p.angle + p.width * p.t1; });
}

/// The first run begins with the first piece and may go on from the last one, a turn before.
void TriggerCurve::join_runs() {
  const auto begins = [](const Piece& p) { return p.angle + p.width * p.t0; };
  const auto ends = [](const Piece& p) { return p.angle + p.width * p.t1; };
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    Piece& p = pieces_[i];
    if (i == 0 || begins(p) > ends(pieces_[i - 1]) + narrowest) runs_.push_back({p.x0, p.x1, 0});
    p.run = runs_.size() - 1;
    runs_.back().to = p.x1;
    runs_.back().end = p.x1 - drop_ * ends(p);
  }
  // The highest point lies on a rising side or on top: what precedes it belongs to its run.
  if (runs_.size() == 1) {
    runs_[0].from = -1e300, runs_[0].to = 1e300;
    return;
  }
  runs_.front().from = runs_.back().from - period_;
  runs_.back().to = runs_.front().to + period_;
  runs_.back().end = runs_.front().end;
}

double TriggerCurve::reach(const Piece& p, double t) const {
  return p.c[0] + t * (p.c[1] + t * (p.c[2] + t * p.c[3])) + drop_ * (p.angle + p.width * t);
}

/// reach = x between t0 and t1, where it rises.
double TriggerCurve::solve(const Piece& p, double t0, double t1, double x) const {
  double t = t0 + (t1 - t0) * std::clamp((x - p.x0) / (p.x1 - p.x0), 0.0, 1.0);
  if (!(t >= t0 && t <= t1)) t = 0.5 * (t0 + t1);
  for (int i = 0; i < 80; ++i) {
    const double f = reach(p, t) - x, rise = p.c[1] + t * (2 * p.c[2] + t * 3 * p.c[3]) + drop_ * p.width;
    (f >= 0 ? t1 : t0) = t;
    double next = t - f / rise;
    if (!(next >= t0 && next <= t1) || i % 16 == 15) next = 0.5 * (t0 + t1);
    if (std::fabs(next - t) < settled) return next;
    t = next;
  }
  return t;
}

void TriggerCurve::cover(const HeightNode& a, const HeightNode& b) {
  if (!a.covered && !b.covered) return;
  const double width = b.angle - a.angle;
  const auto bound = [&](const HeightNode& n) {
    return n.covered ? n.height + drop_ * n.angle + width * std::fabs(n.slope + drop_) : -1e300;
  };
  if (std::max(bound(a), bound(b)) < record_) return;
  if (width < narrowest) return wall(b);
  const HeightNode m = heights_->at(0.5 * (a.angle + b.angle), a.covered ? a.height : b.height);
  if (a.covered && b.covered && m.covered) {
    const double middle = 0.5 * (a.height + b.height) + 0.125 * width * (a.slope - b.slope);
    if (std::fabs(middle - m.height) < tolerance) {
      add(a, m);
      add(m, b);
      return;
    }
  }
  cover(a, m);
  cover(m, b);
}

void TriggerCurve::wall(const HeightNode& b) {
  if (!b.covered) return;
  const double x = b.height + drop_ * b.angle;
  if (x <= record_) return;
  pieces_.push_back({record_, x, 0, 0, b.angle, 0, {b.height, 0, 0, 0}});
  record_ = x;
}

void TriggerCurve::add(const HeightNode& a, const HeightNode& b) {
  const double w = b.angle - a.angle, rise = b.height - a.height;
  Piece p{0,
          0,
          0,
          0,
          a.angle,
          w,
          {a.height, w * a.slope, 3 * rise - w * (2 * a.slope + b.slope), w * (a.slope + b.slope) - 2 * rise}};
  double split[4] = {0, 1, 1, 1}; // where G turns, in order
  int parts = 1;
  const double q2 = 3 * p.c[3], q1 = 2 * p.c[2], q0 = p.c[1] + drop_ * w, root = q1 * q1 - 4 * q2 * q0;
  if (root > 0) {
    const double s = -0.5 * (q1 + std::copysign(std::sqrt(root), q1));
    double t[2] = {q0 / s, s / q2};
    if (!(t[0] < t[1])) std::swap(t[0], t[1]);
    for (const double x : t)
      if (x > 0 && x < 1) split[parts++] = x;
    split[parts] = 1;
  }
  for (int i = 0; i < parts; ++i) {
    const double from = reach(p, split[i]), to = reach(p, split[i + 1]);
    if (!(to > record_)) continue;
    if (from > record_) wall({p.angle + w * split[i], from - drop_ * (p.angle + w * split[i]), 0, true, 0});
    p.x0 = from, p.x1 = to;
    p.t0 = from < record_ ? solve(p, split[i], split[i + 1], record_) : split[i];
    p.t1 = split[i + 1];
    p.x0 = record_;
    pieces_.push_back(p);
    record_ = to;
  }
}

TriggerCurve::Point TriggerCurve::at(double x) const {
  Point p;
  curve_table_kernels().at(table_, 1, &x, {&p.height, &p.slope, &p.from, &p.to, &p.before});
  return p;
}

void TriggerCurve::at(std::span<const double> x, const CurvePoints& out) const {
  curve_table_kernels().at(table_, x.size(), x.data(), out);
}

void TriggerCurve::record(std::span<const double> angle, double* out) const {
  curve_table_kernels().record(table_, angle.size(), angle.data(), out);
}

double TriggerCurve::record(double angle) const {
  double out;
  record({&angle, 1}, &out);
  return out;
}

} // namespace gumshoe::models::tool_length
