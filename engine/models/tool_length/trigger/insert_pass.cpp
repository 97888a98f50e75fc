#include "models/tool_length/trigger/insert_pass.h"

#include <algorithm>

namespace gumshoe::models::tool_length {

InsertPass::Crossing InsertPass::search(const Crest& crest, double level, double fall, double shift, double first,
                                        double last, double more) const {
  const auto past = [&](double& clear, double& ahead, bool) {
    ahead = std::min(2 * ahead, last - clear);
    while (!lines_.below(clear - shift, clear + ahead - shift, fall, level - fall * clear)) {
      if (ahead <= 0.05) return false;
      ahead = std::max(0.5 * ahead, 0.05);
    }
    clear += ahead;
    return true;
  };
  return walk(true, crest, level, fall, shift, first, last, more, past);
}

/// Everywhere from `from` to `to` Phi holds, or it is proved that k + fall (angle - from) < limit.
bool InsertPass::cleared(const Window& w, double from, double to, double facing, double fall, double limit) const {
  if (to - from < widest_stretch) {
    const ShowsOf<double> s = facing != 0 ? shows(from, to) : ShowsOf<double>{};
    if (s.facing == facing && facing != 0 && s.flank == 0) return true;
    if (lines_.below(from, to, fall, limit)) return true;
    // What the flank adds to the area covered it adds at most at every angle.
    if (s.flank > 0) {
      const Crossing with = search(w.crest, limit + fall * from, fall, 0, from, to, s.flank);
      if (!with.crossed && !with.unproved) return true;
    }
    if (to - from < 0.01) return false;
  }
  const double middle = 0.5 * (from + to);
  return cleared(w, from, middle, facing, fall, limit) &&
         cleared(w, middle, to, facing, fall, limit - fall * (middle - from));
}

void InsertPass::lower(double margin) { tool_length::lower<double>(*this, true, margin); }

void InsertPass::lower_far(double far) {
  tool_length::lower_far<double>(*this, true, far, [&](bool, const Crest& crest) {
    auto& top = top_[crest.rises ? 0 : 1];
    if (!top) top = top_of<double>(*this, true, crest);
    return *top;
  });
}

InsertPass::Crossing InsertPass::first_crossing(bool, const Window& w, double level, double fall, double shift,
                                                double first, double last) const {
  Crossing found = search(w.crest, level, fall, shift, first, last);
  const double to = found.crossed ? found.turned : last;
  if (found.unproved || only_edge_shows(true, first - shift, to - shift, found.facing)) return found;
  found.unproved = !cleared(w, first - shift, to - shift, found.facing, fall, level - fall * first);
  return found;
}

bool InsertPass::below(double from, double to, double fall, double limit) const {
  if (lines_.below(from, to, fall, limit)) return true;
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
