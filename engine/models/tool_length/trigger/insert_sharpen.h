#pragma once
/// Lower limits of the windows' heights, for doubles and for lanes: with them, turns that no insert reaches are passed
/// at once. `Pass` is an InsertWindows<V> with `first_crossing`.
#include "models/tool_length/trigger/insert_windows.h"

namespace gumshoe::models::tool_length {

/// No height k from `from` to `to` is above `highest`.
template <class V> struct TopOf { V from = V(0.0), to = V(-1.0), highest = V(0.0); };

template <class V> TopOf<V> select(const Mask<V>& mask, const TopOf<V>& a, const TopOf<V>& b) {
  return {num::select(mask, a.from, b.from), num::select(mask, a.to, b.to), num::select(mask, a.highest, b.highest)};
}

/// Lowers the windows' own `highest` to about `margin` above their crests where that can be proved.
template <class V, class Pass> void lower(Pass& pass, const Mask<V>& wanted, const V& margin) {
  for (WindowOf<V>& w : pass.windows()) {
    const V to = w.crest.k + 0.05 * (w.highest - w.crest.k) + margin;
    const auto tried = wanted && w.exists && to < w.highest;
    if (!num::any(tried)) continue;
    const auto at = pass.first_crossing(tried, w, to, V(0.0), V(0.0), w.from, w.to);
    w.highest = num::select(tried && !at.crossed && !at.unproved, to, w.highest);
  }
}

/// How high the pass stands about a crest that lies far below its highest(): of the geometry alone.
template <class V, class Pass> TopOf<V> top_of(const Pass& pass, const Mask<V>& wanted, const CrestOf<V>& crest) {
  const V deep = pass.highest() - crest.k;
  TopOf<V> top;
  Pass wide(pass);
  const auto open = wanted && deep < V(HUGE_VAL) && wide.open(2.2 * deep);
  for (const WindowOf<V>& w : wide.windows()) {
    const auto tried = open && w.exists && ((w.crest.rises && crest.rises) || (!w.crest.rises && !crest.rises));
    if (!num::any(tried)) continue;
    const V to = crest.k + 0.1 * deep;
    const auto at = wide.first_crossing(tried, w, to, V(0.0), V(0.0), w.from, w.to);
    const auto none = tried && !at.crossed && !at.unproved;
    top.from = num::select(none, w.from, top.from);
    top.to = num::select(none, w.to, top.to);
    top.highest = num::select(none, to, top.highest);
  }
  return top;
}

/// Lowers windows whose crests lie further than `far` below `highest()` to near their crests where that is proved.
/// `top(wanted, crest)` is top_of.
template <class V, class Pass, class Top>
void lower_far(Pass& pass, const Mask<V>& wanted, const V& far, const Top& top) {
  for (WindowOf<V>& w : pass.windows()) {
    const auto lies_far = wanted && w.exists && w.crest.k < pass.highest() - far;
    if (!num::any(lies_far)) continue;
    const TopOf<V> t = top(lies_far, w.crest);
    w.highest = num::select(lies_far && t.from <= w.from && w.to <= t.to, smaller(w.highest, t.highest), w.highest);
  }
}

} // namespace gumshoe::models::tool_length
