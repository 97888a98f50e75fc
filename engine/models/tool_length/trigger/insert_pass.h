#pragma once
/// A rigorous search in the windows of one insert (insert_windows.h) for its first trigger, for doubles and for lanes,
/// with all that is tried where the plain proof does not hold: tangents, halves of stretches, bounds on what the flank
/// may add.
#include "models/tool_length/trigger/insert_lines.h"
#include "models/tool_length/trigger/insert_sharpen.h"

namespace gumshoe::models::tool_length {

template <class V> class InsertPassOf : public InsertWindows<V> {
public:
  using Window = WindowOf<V>;
  using Crest = CrestOf<V>;
  using Crossing = CrossingOf<V>;

  InsertPassOf(const InsertBody<V>& body, const DiscShareOf<V>& disc)
      : InsertWindows<V>(body, disc), lines_(body, disc) {}
  int size() const { return this->window(0).exists + this->window(1).exists; }
  /// Lowers windows, where wanted, whose crests lie further than `far` below `highest()` to near their crests where
  /// that is proved: once for a geometry, whatever the windows.
  void lower_far(const Mask<V>& wanted, const V& far);
  /// That, and the same of every window, so that turns of a descent by `whole` that no insert reaches are passed at
  /// once.
  void sharpen(const Mask<V>& wanted, const V& far, const V& whole) {
    lower_far(wanted, far);
    lower<V>(*this, wanted && this->slack() > whole, V(0.1 * whole));
  }

  /// The first angle turned from `first` to `last` with k(angle) >= level - fall turned in a window, where the angle is
  /// turned - shift.
  Crossing first_crossing(const Mask<V>& wanted, const Window& w, const V& level, const V& fall, const V& shift,
                          const V& first, const V& last) const;

  const InsertLines<V>& lines() const { return lines_; }
  /// Becomes, where `mask`, the other insert in this beam, for first_crossing() alone.
  void take(const Mask<V>& mask, const InsertPassOf& other) {
    InsertWindows<V>::take(mask, other);
    lines_.take(mask, other.lines_);
  }
  /// True only if k(angle) + fall (angle - from) < limit at all angles from `from` to `to`: by tangents, or by Phi.
  bool below(double from, double to, double fall, double limit) const;

private:
  Crossing search(const Mask<V>& wanted, const Crest& crest, const V& level, const V& fall, const V& shift,
                  const V& first, const V& last, const V& more) const;
  Mask<V> cleared(const Mask<V>& wanted, const Crest& crest, const V& from, const V& to, const V& facing, const V& fall,
                  const V& limit) const;
  InsertLines<V> lines_;
  /// For crests that rise, and for the others; depends on the geometry alone.
  std::array<TopOf<V>, 2> top_;
  std::array<Mask<V>, 2> top_known_{everywhere<V>(false), everywhere<V>(false)};
};

using InsertPass = InsertPassOf<double>;

template <class V>
CrossingOf<V> InsertPassOf<V>::search(const Mask<V>& wanted, const Crest& crest, const V& level, const V& fall,
                                      const V& shift, const V& first, const V& last, const V& more) const {
  const auto past = [&](V& clear, V& ahead, const Mask<V>& there) {
    V step = smaller(V(2.0 * ahead), V(last - clear));
    auto led = everywhere<V>(false), tried = there;
    while (num::any(tried)) {
      const auto good = lines_.below(tried, V(clear - shift), V(clear + step - shift), fall, V(level - fall * clear));
      led = led || good;
      tried = tried && !good && step > V(0.05);
      step = num::select(tried, larger(V(0.5 * step), V(0.05)), step);
    }
    clear = num::select(led, V(clear + step), clear);
    ahead = num::select(there, step, ahead);
    return led;
  };
  return this->walk(wanted, crest, level, fall, shift, first, last, more, past);
}

/// Where everywhere from `from` to `to` Phi holds, or it is proved that k + fall (angle - from) < limit.
template <class V>
Mask<V> InsertPassOf<V>::cleared(const Mask<V>& wanted, const Crest& crest, const V& from, const V& to, const V& facing,
                                 const V& fall, const V& limit) const {
  const V zero(0.0);
  const auto narrow = wanted && to - from < V(widest_stretch);
  auto proved = everywhere<V>(false);
  if (num::any(narrow)) {
    const ShowsOf<V> s = this->shows(from, to);
    const auto faces = narrow && s.facing == facing && !(facing == zero);
    proved = faces && s.flank == zero;
    if (const auto rest = narrow && !proved; num::any(rest))
      proved = proved || lines_.below(rest, from, to, fall, limit);
    // What the flank adds to the area covered it adds at most at every angle.
    if (const auto flanked = narrow && !proved && !(facing == zero) && s.flank > zero; num::any(flanked)) {
      const auto with = search(flanked, crest, V(limit + fall * from), fall, zero, from, to, s.flank);
      proved = proved || (flanked && !with.crossed && !with.unproved);
    }
  }
  const auto rest = wanted && !proved && !(narrow && to - from < V(0.01));
  if (!num::any(rest)) return proved;
  const V middle = 0.5 * (from + to);
  const auto left = cleared(rest, crest, from, middle, facing, fall, limit);
  if (!num::any(left)) return proved;
  return proved || cleared(left, crest, middle, to, facing, fall, V(limit - fall * (middle - from)));
}

template <class V> void InsertPassOf<V>::lower_far(const Mask<V>& wanted, const V& far) {
  tool_length::lower_far<V>(*this, wanted, far, [&](const Mask<V>& some, const Crest& crest) {
    for (const std::size_t side : {0, 1}) {
      auto missing = some && (side == 0 ? crest.rises : !crest.rises) && !top_known_[side];
      if (!num::any(missing)) continue;
      top_[side] = select<V>(missing, top_of<V>(*this, missing, crest), top_[side]);
      top_known_[side] = top_known_[side] || missing;
    }
    return select<V>(crest.rises, top_[0], top_[1]);
  });
}

template <class V>
CrossingOf<V> InsertPassOf<V>::first_crossing(const Mask<V>& wanted, const Window& w, const V& level, const V& fall,
                                              const V& shift, const V& first, const V& last) const {
  Crossing found = search(wanted, w.crest, level, fall, shift, first, last, V(0.0));
  const V from = first - shift, to = num::select(found.crossed, found.turned, last) - shift;
  const auto sought = wanted && !found.unproved;
  if (const auto rest = sought && !this->only_edge_shows(sought, from, to, found.facing); num::any(rest))
    found.unproved =
        found.unproved || (rest && !cleared(rest, w.crest, from, to, found.facing, fall, V(level - fall * first)));
  return found;
}

template <> inline bool InsertPassOf<double>::below(double from, double to, double fall, double limit) const {
  if (lines_.below(true, from, to, fall, limit)) return true;
  const double half = 0.5 * (to - from);
  if (half > 0.1) return false;
  const RakeView v(body_, from + half);
  const auto proves = [&](const RakeChord& c) {
    return c.solved && c.k + fall * half + half * (std::fabs(c.slope + fall) + 0.5 * half * curve(c)) < limit;
  };
  if (!proves(rake_chord(v, body_.radius, disc_))) return false;
  const ShowsOf<double> s = shows(from, to);
  return s.facing != 0 && (s.flank == 0 || proves(rake_chord(v, body_.radius, disc_, s.flank)));
}

} // namespace gumshoe::models::tool_length
