#pragma once
/// The first trigger of a whole tool by its inserts' windows, for doubles and for lanes: the earliest window is
/// searched first, until no window that is left opens before the trigger found.
#include <optional>
#include <span>

#include "chain/turning_tool.h"
#include "models/tool_length/trigger/insert_windows.h"

namespace gumshoe::models::tool_length {

/// A flute's windows are those of pass `pass`; its azimuth and raise as in Flute.
template <class V> struct DescentFlute {
  std::size_t pass = 0;
  V azimuth = V(0.0), raise = V(0.0);
};

/// The descent of the tool's centre: InsertMotion.
template <class V> struct DescentMotion { V start_angle, start_height, drop, not_before; };

template <class V> struct DescentTrigger {
  Mask<V> found = everywhere<V>(false), unproved = everywhere<V>(false);
  Mask<V> inside = everywhere<V>(false); ///< covered before anything moves
  V insert = V(0.0), turned = V(0.0), slope = V(0.0);
};

template <class V>
DescentTrigger<V> select(const Mask<V>& mask, const DescentTrigger<V>& a, const DescentTrigger<V>& b) {
  const auto either = [&](const Mask<V>& x, const Mask<V>& y) { return (mask && x) || (!mask && y); };
  return {either(a.found, b.found),
          either(a.unproved, b.unproved),
          either(a.inside, b.inside),
          num::select(mask, a.insert, b.insert),
          num::select(mask, a.turned, b.turned),
          num::select(mask, a.slope, b.slope)};
}

/// @tparam Pass InsertPassOf<V>
template <class V, class Pass> class InsertDescent {
  static constexpr double turn = 2 * pi;
  static constexpr int most_windows = 100;

public:
  /// `passes(i)` is the pass i.
  template <class Passes>
  InsertDescent(std::span<const DescentFlute<V>> flutes, const V& cosine, const DescentMotion<V>& m,
                const Passes& passes)
      : flutes_(flutes), m_(m), cosine_(cosine), fall_(cosine * m.drop), whole_(turn * fall_) {
    for (std::size_t k = 0; k < flutes.size(); ++k) {
      passes_[k] = &passes(flutes[k].pass);
      level_[k] = cosine_ * (m_.start_height + flutes[k].raise);
    }
  }

  const V& whole() const { return whole_; } ///< descent in a turn
  /// How deep below the highest the windows of pass i have to be for `share` of a turn's descent.
  V below(std::size_t i, double share) const {
    // the tool may start below the highest
    V start(HUGE_VAL);
    for (std::size_t j = i; j < flutes_.size(); ++j)
      if (flutes_[j].pass == i) start = smaller(start, V(level_[j] - fall_ * m_.not_before));
    return 1.02 * share * whole_ + larger(passes_[i]->slack(), V(passes_[i]->highest() - start));
  }

  /// The first opening of each window; false where there is none, or where turn by turn from where a window might begin
  /// down to the crests there are too many: the search passes most at once.
  Mask<V> begin() {
    size_ = 0;
    V top(-HUGE_VAL), crest(-HUGE_VAL), count(0.0);
    for (std::size_t k = 0; k < flutes_.size(); ++k)
      for (int i = 0; i < 2; ++i) {
        const WindowOf<V>& w = passes_[k]->window(i);
        if (!num::any(w.exists)) continue;
        Opening& o = openings_[size_++];
        o = {k, i, V(HUGE_VAL), V(0.0), V(0.0)};
        advance(o, w.exists, m_.not_before);
        top = num::select(w.exists, larger(top, w.highest), top);
        crest = num::select(w.exists, larger(crest, w.crest.k), crest);
        count = count + num::select(w.exists, V(1.0), V(0.0));
      }
    return count > V(0.0) && !((top - crest) * count > most_windows * whole_);
  }

  /// Down the openings, where `wanted`; neither found nor unproved where they do not reach down to a trigger.
  DescentTrigger<V> down(const Mask<V>& wanted) {
    // Levels below those for which a window holds prove nothing.
    V valid(HUGE_VAL);
    for (std::size_t k = 0; k < flutes_.size(); ++k)
      valid = smaller(valid, V((level_[k] - passes_[k]->highest() + passes_[k]->opened()) / fall_));
    DescentTrigger<V> result;
    V least(HUGE_VAL);
    auto active = wanted;
    for (int n = 0; n < most_windows && num::any(active); ++n) {
      const Next next = earliest();
      const Pass& pass = pass_of(next.flute);
      const auto ends = active && next.first >= smaller(least, valid);
      result.found = result.found || (ends && least <= valid);
      active = active && !ends;
      const V last = smaller(next.last, least);
      const auto searched = active && next.first < last;
      if (num::any(searched)) {
        const auto crossing =
            pass.first_crossing(searched, next.window, next.level, fall_, next.shift, next.first, last);
        result.unproved = result.unproved || (searched && crossing.unproved);
        const auto met = searched && crossing.crossed && !crossing.unproved;
        least = num::select(met, crossing.turned, least);
        result.insert = num::select(met, next.flute, result.insert);
        result.slope = num::select(met, V(crossing.slope / cosine_), result.slope);
        const auto inside = met && crossing.inside && crossing.turned == V(0.0);
        result.inside = result.inside || inside;
        result.found = result.found || inside;
        active = active && !(inside || result.unproved);
      }
      for (std::size_t j = 0; j < size_; ++j)
        if (const auto here = active && next.opening == V(static_cast<double>(j)); num::any(here))
          advance(openings_[j], here, openings_[j].last + 1e-9);
    }
    result.turned = least;
    return result;
  }

private:
  /// A window in the turn that comes next: angles turned `first` to `last`, angle = turned - shift. `first` is infinite
  /// where the window does not exist.
  struct Opening {
    std::size_t flute;
    int window;
    V first, last, shift;
  };
  /// The opening with the least `first`, each number its own.
  struct Next {
    V opening, flute, first, last, shift, level;
    WindowOf<V> window;
  };
  Next earliest() const {
    const auto of = [&](std::size_t j) {
      const Opening& o = openings_[j];
      return Next{V(static_cast<double>(j)), V(static_cast<double>(o.flute)),   o.first, o.last, o.shift,
                  level_[o.flute],           passes_[o.flute]->window(o.window)};
    };
    if constexpr (std::is_same_v<V, double>) {
      std::size_t least = 0;
      for (std::size_t j = 1; j < size_; ++j)
        if (openings_[j].first < openings_[least].first) least = j;
      return of(least);
    } else {
      Next next = of(0);
      for (std::size_t j = 1; j < size_; ++j) {
        const auto sooner = openings_[j].first < next.first;
        if (!num::any(sooner)) continue;
        const Next other = of(j);
        const auto take = [&](V& x, const V& y) { x = num::select(sooner, y, x); };
        take(next.opening, other.opening), take(next.flute, other.flute), take(next.first, other.first);
        take(next.last, other.last), take(next.shift, other.shift);
        take(next.level, other.level);
        take(next.window.from, other.window.from), take(next.window.to, other.window.to);
        next.window.crest = select<V>(sooner, other.window.crest, next.window.crest);
      }
      return next;
    }
  }
  /// That of each lane's flute.
  const Pass& pass_of(const V& flute) {
    if constexpr (std::is_same_v<V, double>) {
      return *passes_[static_cast<std::size_t>(flute)];
    } else {
      const Pass* only = nullptr;
      bool mixed = false;
      for (std::size_t k = 0; k < flutes_.size(); ++k) {
        const auto here = flute == V(static_cast<double>(k));
        if (only == passes_[k] || !num::any(here)) continue;
        if (!only) {
          only = passes_[k];
          continue;
        }
        if (!mixed) mixed_ = *only;
        mixed = true;
        mixed_->take(here, *passes_[k]);
      }
      return mixed ? *mixed_ : *only;
    }
  }
  void advance(Opening& o, const Mask<V>& where, const V& not_before) const {
    const WindowOf<V>& w = passes_[o.flute]->window(o.window);
    const V seat = m_.start_angle + flutes_[o.flute].azimuth;
    const V earliest = larger(not_before, V((level_[o.flute] - w.highest) / fall_));
    const V shift = turn * rounded_up(V((earliest - (w.to - seat)) / turn)) - seat;
    o.shift = num::select(where, shift, o.shift);
    o.first = num::select(where, larger(V(w.from + shift), earliest), o.first);
    o.last = num::select(where, V(w.to + shift), o.last);
  }

  std::span<const DescentFlute<V>> flutes_;
  DescentMotion<V> m_;
  V cosine_, fall_, whole_;
  std::array<const Pass*, chain::most_inserts> passes_{};
  std::optional<Pass> mixed_; ///< of lanes whose flutes are of different passes
  std::array<V, chain::most_inserts> level_;
  std::array<Opening, std::size_t{2} * chain::most_inserts> openings_;
  std::size_t size_ = 0;
};

} // namespace gumshoe::models::tool_length
