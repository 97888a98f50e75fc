/// The first trigger of a whole tool by its inserts' windows: the earliest window is searched first, until no window
/// that is left opens before the trigger found.
#include <algorithm>
#include <cmath>

#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::models::tool_length {

namespace {

constexpr double turn = 2 * 3.14159265358979323846;
constexpr int most_windows = 100;

/// A window in the turn that comes next: angles turned `first` to `last`, angle = turned - shift.
struct Opening {
  std::size_t flute;
  int window;
  double first, last, shift;
};

} // namespace

InsertTrigger TriggerSolver::solve(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                   const InsertMotion& motion) {
  if (const auto found = walk(flutes, beam, motion)) return *found;
  return searched(flutes, beam, motion);
}

std::optional<InsertTrigger> TriggerSolver::walk(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                                 const InsertMotion& m) {
  if (flutes.empty() || flutes.size() > most_inserts) return std::nullopt;
  // Flutes with one insert share its windows.
  std::array<std::size_t, most_inserts> geometry{};
  for (std::size_t k = 0; k < flutes.size(); ++k) {
    geometry[k] = k;
    for (std::size_t j = 0; j < k; ++j)
      if (flutes[j].insert == flutes[k].insert) {
        geometry[k] = geometry[j];
        break;
      }
    if (geometry[k] == k) pass(k, flutes[k].insert, beam);
  }
  const double cosine = num::cos(beam.pitch), fall = cosine * m.drop;
  const auto level = [&](std::size_t k) { return cosine * (m.start_height + flutes[k].raise); };
  // As deep below the highest as one flute alone may wait; less serves when others come between.
  const double whole = turn * fall;
  for (const double share : {1.0 / static_cast<double>(flutes.size()), 1.0, 2.0}) {
    for (std::size_t k = 0; k < flutes.size(); ++k) {
      if (geometry[k] != k) continue;
      Pass& p = passes_[k];
      // the tool may start below the highest
      double start = HUGE_VAL;
      for (std::size_t j = k; j < flutes.size(); ++j)
        if (geometry[j] == k) start = std::min(start, level(j) - fall * m.not_before);
      const double below = 1.02 * share * whole + std::max(p.pass->slack(), p.pass->highest() - start);
      if (p.below != below || p.whole != whole) {
        p.below = below, p.whole = whole;
        p.open = p.pass->open(below);
        if (p.open) p.pass->lower_far(share * whole);
        // turns that no insert reaches are better passed at once
        if (p.open && p.pass->slack() > whole) p.pass->lower(0.1 * whole);
      }
      if (!p.open) return std::nullopt;
    }
    std::array<Opening, std::size_t{2} * most_inserts> openings;
    std::size_t size = 0;
    const auto advance = [&](Opening& o, double not_before) {
      const InsertPass::Window& w = passes_[geometry[o.flute]].pass->window(o.window);
      const double seat = m.start_angle + flutes[o.flute].azimuth;
      const double earliest = std::max(not_before, (level(o.flute) - w.highest) / fall);
      o.shift = turn * std::ceil((earliest - (w.to - seat)) / turn) - seat;
      o.first = std::max(w.from + o.shift, earliest);
      o.last = w.to + o.shift;
    };
    for (std::size_t k = 0; k < flutes.size(); ++k)
      for (int i = 0; i < passes_[geometry[k]].pass->size(); ++i) {
        openings[size] = {k, i, 0, 0, 0};
        advance(openings[size++], m.not_before);
      }
    if (size == 0) return std::nullopt;
    // Turn by turn from where a window might begin down to the crests: of too many the search passes most at once.
    double top = -HUGE_VAL, crest = -HUGE_VAL;
    for (std::size_t i = 0; i < size; ++i) {
      const InsertPass::Window& w = passes_[geometry[openings[i].flute]].pass->window(openings[i].window);
      top = std::max(top, w.highest);
      crest = std::max(crest, w.crest.k);
    }
    if ((top - crest) * static_cast<double>(size) > most_windows * whole) return std::nullopt;
    // Levels below those for which a window holds prove nothing.
    double valid = HUGE_VAL;
    for (std::size_t k = 0; k < flutes.size(); ++k) {
      const InsertPass& p = *passes_[geometry[k]].pass;
      valid = std::min(valid, (level(k) - p.highest() + p.below()) / fall);
    }
    InsertTrigger result;
    double least = HUGE_VAL;
    bool started = false, done = false;
    for (int n = 0; n < most_windows && !started && !done; ++n) {
      Opening* next = &openings[0];
      for (std::size_t i = 1; i < size; ++i)
        if (openings[i].first < next->first) next = &openings[i];
      done = next->first >= std::min(least, valid);
      if (done) break;
      const double last = std::min(next->last, least);
      if (next->first < last) {
        const InsertPass& p = *passes_[geometry[next->flute]].pass;
        const auto crossing =
            p.first_crossing(p.window(next->window), level(next->flute), fall, next->shift, next->first, last);
        if (crossing.found == InsertPass::Found::unproved) return std::nullopt;
        if (crossing.found != InsertPass::Found::none) {
          least = crossing.turned;
          result.insert = static_cast<int>(next->flute);
          result.slope = crossing.slope / cosine;
          started = crossing.found == InsertPass::Found::inside && crossing.turned == 0;
        }
      }
      advance(*next, next->last + 1e-9);
    }
    if (started) {
      result.status = Status::already_covered;
      return result;
    }
    if (done && least <= valid) {
      result.turned = least;
      result.height = m.start_height - m.drop * least;
      return result;
    }
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
