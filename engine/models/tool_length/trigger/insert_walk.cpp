/// The first trigger of a whole tool by its inserts' windows: the earliest window is searched first, until no window
/// that is left opens before the trigger found.
#include <algorithm>
#include <cmath>

#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::models::tool_length {

namespace {

constexpr double turn = 2 * pi;
constexpr int most_windows = 100;

/// A window in the turn that comes next: angles turned `first` to `last`, angle = turned - shift.
struct Opening {
  std::size_t flute;
  int window;
  double first, last, shift;
};

} // namespace

/// The windows of a tool's flutes, and down them.
class TriggerSolver::Walk {
public:
  Walk(TriggerSolver& solver, std::span<const Flute<double>> flutes, const Beam<double>& beam, const InsertMotion& m)
      : passes_(solver.passes_), flutes_(flutes), m_(m), cosine_(num::cos(beam.pitch)), fall_(cosine_ * m.drop),
        whole_(turn * fall_) {
    // Flutes with one insert share its windows.
    for (std::size_t k = 0; k < flutes.size(); ++k) {
      geometry_[k] = k;
      for (std::size_t j = 0; j < k; ++j)
        if (flutes[j].insert == flutes[k].insert) {
          geometry_[k] = geometry_[j];
          break;
        }
      if (geometry_[k] == k) solver.pass(k, flutes[k].insert, beam);
    }
  }

  /// Opens the windows down to `share` of a turn's descent below the highest; false where no proof is had.
  bool open(double share) {
    for (std::size_t k = 0; k < flutes_.size(); ++k) {
      if (geometry_[k] != k) continue;
      Pass& p = passes_[k];
      // the tool may start below the highest
      double start = HUGE_VAL;
      for (std::size_t j = k; j < flutes_.size(); ++j)
        if (geometry_[j] == k) start = std::min(start, level(j) - fall_ * m_.not_before);
      const double below = 1.02 * share * whole_ + std::max(p.pass->slack(), p.pass->highest() - start);
      if (p.below != below || p.whole != whole_) {
        p.below = below, p.whole = whole_;
        p.open = p.pass->open(below);
        if (p.open) p.pass->lower_far(share * whole_);
        // turns that no insert reaches are better passed at once
        if (p.open && p.pass->slack() > whole_) p.pass->lower(0.1 * whole_);
      }
      if (!p.open) return false;
    }
    return true;
  }

  /// The first opening of each window; false where there is none, or where turn by turn from where a window might begin
  /// down to the crests there are too many: the search passes most at once.
  bool begin() {
    size_ = 0;
    double top = -HUGE_VAL, crest = -HUGE_VAL;
    for (std::size_t k = 0; k < flutes_.size(); ++k)
      for (int i = 0; i < pass(k).size(); ++i) {
        openings_[size_] = {k, i, 0, 0, 0};
        advance(openings_[size_++], m_.not_before);
        top = std::max(top, pass(k).window(i).highest);
        crest = std::max(crest, pass(k).window(i).crest.k);
      }
    return size_ > 0 && !((top - crest) * static_cast<double>(size_) > most_windows * whole_);
  }

  /// Down the openings; nothing where they do not reach down to a trigger, or where one has no proof.
  std::optional<InsertTrigger> down() {
    // Levels below those for which a window holds prove nothing.
    double valid = HUGE_VAL;
    for (std::size_t k = 0; k < flutes_.size(); ++k)
      valid = std::min(valid, (level(k) - pass(k).highest() + pass(k).below()) / fall_);
    InsertTrigger result;
    double least = HUGE_VAL;
    for (int n = 0; n < most_windows; ++n) {
      Opening& next = *std::min_element(openings_.begin(), openings_.begin() + static_cast<std::ptrdiff_t>(size_),
                                        [](const Opening& a, const Opening& b) { return a.first < b.first; });
      if (next.first >= std::min(least, valid)) {
        if (!(least <= valid)) return std::nullopt;
        result.turned = least;
        result.height = m_.start_height - m_.drop * least;
        return result;
      }
      if (const double last = std::min(next.last, least); next.first < last) {
        const InsertPass& p = pass(next.flute);
        const auto crossing =
            p.first_crossing(p.window(next.window), level(next.flute), fall_, next.shift, next.first, last);
        unproved_ = crossing.found == InsertPass::Found::unproved;
        if (unproved_) return std::nullopt;
        if (crossing.found != InsertPass::Found::none) {
          least = crossing.turned;
          result.insert = static_cast<int>(next.flute);
          result.slope = crossing.slope / cosine_;
          if (crossing.found == InsertPass::Found::inside && crossing.turned == 0) {
            result.status = Status::already_covered;
            return result;
          }
        }
      }
      advance(next, next.last + 1e-9);
    }
    return std::nullopt;
  }
  bool unproved() const { return unproved_; }

private:
  const InsertPass& pass(std::size_t flute) const { return *passes_[geometry_[flute]].pass; }
  double level(std::size_t flute) const { return cosine_ * (m_.start_height + flutes_[flute].raise); }
  void advance(Opening& o, double not_before) const {
    const InsertPass::Window& w = pass(o.flute).window(o.window);
    const double seat = m_.start_angle + flutes_[o.flute].azimuth;
    const double earliest = std::max(not_before, (level(o.flute) - w.highest) / fall_);
    o.shift = turn * std::ceil((earliest - (w.to - seat)) / turn) - seat;
    o.first = std::max(w.from + o.shift, earliest);
    o.last = w.to + o.shift;
  }

  std::array<Pass, most_inserts>& passes_;
  std::span<const Flute<double>> flutes_;
  const InsertMotion& m_;
  double cosine_, fall_, whole_; ///< descent in a turn
  std::array<std::size_t, most_inserts> geometry_{};
  std::array<Opening, std::size_t{2} * most_inserts> openings_;
  std::size_t size_ = 0;
  bool unproved_ = false;
};

InsertTrigger TriggerSolver::solve(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                   const InsertMotion& motion) {
  if (const auto found = walk(flutes, beam, motion)) return *found;
  return searched(flutes, beam, motion);
}

std::optional<InsertTrigger> TriggerSolver::walk(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                                 const InsertMotion& m) {
  if (flutes.empty() || flutes.size() > most_inserts) return std::nullopt;
  Walk walk(*this, flutes, beam, m);
  // As deep below the highest as one flute alone may wait; less serves when others come between.
  for (const double share : {1.0 / static_cast<double>(flutes.size()), 1.0, 2.0}) {
    if (!walk.open(share) || !walk.begin()) return std::nullopt;
    if (const auto found = walk.down(); found || walk.unproved()) return found;
  }
  return std::nullopt;
}

InsertTrigger TriggerSolver::alone(const Flute<double>& flute, const Beam<double>& beam, double level, double drop) {
  // from whole turns above the highest point, no more of them than it takes
  const double top = pass(0, flute.insert, beam).pass->highest() / num::cos(beam.pitch) - flute.raise;
  const double turns = std::ceil((top - level) / (turn * drop)) + 1;
  InsertTrigger found = solve({&flute, 1}, beam, {0, level + turns * (turn * drop), drop});
  found.turned -= turns * turn;
  return found;
}

TriggerSolver::Pass& TriggerSolver::pass(std::size_t flute, const Insert<double>& insert, const Beam<double>& beam) {
  Pass& p = passes_[flute];
  if (!(p.pass && p.insert == insert && p.beam == beam))
    p = {insert, beam, InsertPass(insert_body(insert, beam), DiscShare(beam.radius, beam.fraction)), -1, 0, false};
  return p;
}

} // namespace gumshoe::models::tool_length
