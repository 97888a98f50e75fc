#include "models/tool_length/trigger/insert_trigger.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

namespace {

/// One insert's search over its spindle angle: G = Zc + drop (angle - start) - height, first angle with G >= 0.
class Search {
public:
  Search(const InsertHeight& heights, double start, double height, double drop)
      : heights_(heights), start_(start), height_(height), drop_(drop) {}

  /// Spindle angle turned until G >= 0, from `not_before` to `limit`; NaN if later.
  double first(double not_before, double limit, bool& starts_inside) {
    const double highest = heights_.highest().height;
    const double skip = std::max(not_before, (height_ - highest) / drop_ - 1e-9);
    if (skip > limit) return std::nan("");
    // Angles in the turn that begins there; drop_ is per rad, so whole turns move only the level.
    const double angle = start_ + skip, turn = 2 * pi * std::floor(angle / (2 * pi));
    start_ -= turn;
    const double begin = angle - turn;
    last_ = heights_.at(begin, std::nan(""));
    if (last_.covered && excess(last_) >= 0) {
      starts_inside = skip == 0;
      return skip;
    }
    // a little more than a turn, since the highest point may stand at the very end; split where that is, since it may
    // be the only angle with cover far and wide
    const double end = begin + 2 * pi + 0.1, step = pi / 16;
    double top = heights_.highest().angle;
    top += 2 * pi * std::ceil((begin - top) / (2 * pi));
    for (double a = begin; a < end;) {
      double b = a + step;
      if (top > a && top < b) b = top;
      if (top == a) top += 2 * pi;
      if (a - start_ > limit) return std::nan("");
      if (between(a, b)) return found_ - start_;
      a = b;
    }
    return std::nan("");
  }

private:
  double excess(const HeightNode& n) const { return n.height + drop_ * (n.angle - start_) - height_; }
  HeightNode near(double angle, const HeightNode& n) const { return heights_.at(angle, guess(angle, n)); }
  HeightNode node(double angle) const { return angle == last_.angle ? last_ : near(angle, last_); }

  bool between(double from, double to) {
    const double cosine = heights_.body().cos_pitch;
    if (heights_.bound().below(from, to, cosine * drop_, cosine * (height_ - drop_ * (from - start_)))) return false;
    if (to - from > heights_.resolution()) {
      const double middle = 0.5 * (from + to);
      return between(from, middle) || between(middle, to);
    }
    const HeightNode a = node(from), b = near(to, a);
    last_ = b;
    if (b.covered && excess(b) >= 0) return root(a, b);
    if (a.covered && b.covered && a.slope + drop_ > 0 && b.slope + drop_ < 0) {
      const HeightNode top = hump(heights_, a, b, drop_, height_ + drop_ * start_);
      if (top.covered && excess(top) >= 0) return root(a, top);
    }
    return false;
  }

  /// G < 0 at a, or no cover there; G >= 0 at b.
  bool root(HeightNode a, HeightNode b) {
    HeightNode x = b;
    for (int i = 0; i < 100 && b.angle - a.angle > 1e-14; ++i) {
      double next = x.covered ? x.angle - excess(x) / (x.slope + drop_) : std::nan("");
      if (!(next > a.angle && next < b.angle) || i % 8 == 7) next = 0.5 * (a.angle + b.angle);
      // What is left after a step that short is of second order.
      const bool close = drop_ * std::fabs(next - x.angle) < 1e-14;
      x = near(next, b);
      (x.covered && excess(x) >= 0 ? b : a) = x;
      if (close) { // Newton's limit, from whichever side
        b = x;
        break;
      }
    }
    found_ = b.angle;
    return true;
  }

  const InsertHeight& heights_;
  double start_, height_, drop_, found_ = 0;
  HeightNode last_;
};

} // namespace

const InsertHeight& TriggerSolver::heights(const Insert<double>& insert, const Beam<double>& beam) {
  const auto known =
      std::ranges::find_if(remembered_, [&](const Remembered& r) { return r.insert == insert && r.beam == beam; });
  if (known == remembered_.end()) {
    if (remembered_.size() >= most_inserts) remembered_.pop_back();
    remembered_.push_front({insert, beam, InsertHeight(insert, beam)});
  } else {
    remembered_.splice(remembered_.begin(), remembered_, known);
  }
  return remembered_.front().heights;
}

InsertTrigger TriggerSolver::searched(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                      const InsertMotion& motion) {
  // Asked again by every lot of derivatives, and by every variation of what acts after the trigger only.
  std::vector<double> question{motion.start_angle, motion.start_height, motion.drop, motion.not_before};
  const auto add = [&](std::initializer_list<double> more) { question.insert(question.end(), more); };
  add({beam.yaw, beam.pitch, beam.radius, beam.fraction});
  for (const Flute<double>& f : flutes) {
    const Insert<double>& i = f.insert;
    add({i.tool_radius, i.radius, i.thickness, i.clearance, i.radial_angle, i.axial_angle, i.axis_x, i.axis_y, i.seat});
    add({f.azimuth, f.raise});
  }
  // NaN has no place in an order.
  if (!std::ranges::all_of(question, [](double x) { return std::isfinite(x); })) return search(flutes, beam, motion);
  if (const auto known = answers_.find(question); known != answers_.end()) return known->second;
  if (answers_.size() >= most_answers) answers_.clear();
  return answers_.emplace(std::move(question), search(flutes, beam, motion)).first->second;
}

InsertTrigger TriggerSolver::search(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                    const InsertMotion& motion) {
  InsertTrigger result;
  double least = 1e300;
  bool ever_covered = false;
  for (std::size_t k = 0; k < flutes.size(); ++k) {
    const InsertHeight& zc = heights(flutes[k].insert, beam);
    if (!zc.ever_covered()) continue;
    ever_covered = true;
    bool inside = false;
    Search search(zc, motion.start_angle + flutes[k].azimuth, motion.start_height + flutes[k].raise, motion.drop);
    const double turned = search.first(motion.not_before, least, inside);
    if (!(turned < least)) continue;
    least = turned;
    result.insert = static_cast<int>(k);
    if (inside) {
      result.status = Status::already_covered;
      return result;
    }
  }
  if (!ever_covered || least == 1e300) {
    result.status = ever_covered ? Status::not_converged : Status::never_covered;
    return result;
  }
  result.turned = least;
  result.height = motion.start_height - motion.drop * least;
  const Flute<double>& first = flutes[static_cast<std::size_t>(result.insert)];
  result.slope =
      heights(first.insert, beam).at(motion.start_angle + first.azimuth + least, result.height + first.raise).slope;
  return result;
}

} // namespace gumshoe::models::tool_length
