#include <algorithm>
#include <cmath>

#include "base/kernel_choice.h"
#include "models/tool_length/trigger/insert_descent.h"
#include "models/tool_length/trigger/insert_trigger.h"
#include "models/tool_length/trigger/insert_walk_kernels.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::models::tool_length::WalkKernels, insert_walk)

namespace gumshoe::models::tool_length {

const WalkKernels& walk_kernels() { return *GUMSHOE_BEST_KERNELS(insert_walk); }

InsertTrigger TriggerSolver::solve(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                   const InsertMotion& motion) {
  if (const auto found = walk(flutes, beam, motion)) return *found;
  return searched(flutes, beam, motion);
}

void TriggerSolver::solve(std::span<const TriggerQuestion> questions, InsertTrigger* answers) {
  bool found[most_questions];
  for (std::size_t i = 0; i < questions.size(); i += most_questions) {
    const auto some = questions.subspan(i, std::min(most_questions, questions.size() - i));
    walk_kernels().walk(some.data(), some.size(), answers + i, found);
    for (std::size_t j = 0; j < some.size(); ++j)
      if (!found[j]) answers[i + j] = solve(some[j].flutes, some[j].beam, some[j].motion);
  }
}

std::optional<InsertTrigger> TriggerSolver::walk(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                                 const InsertMotion& m) {
  if (flutes.empty() || flutes.size() > most_inserts) return std::nullopt;
  // Flutes with one insert share its windows.
  DescentFlute<double> all[most_inserts];
  for (std::size_t k = 0; k < flutes.size(); ++k) {
    std::size_t first = 0;
    while (!(flutes[first].insert == flutes[k].insert) && first < k) ++first;
    all[k] = {first < k ? all[first].pass : k, flutes[k].azimuth, flutes[k].raise};
    if (all[k].pass == k) pass(k, flutes[k].insert, beam);
  }
  InsertDescent<double, InsertPass> descent({all, flutes.size()}, num::cos(beam.pitch),
                                            {m.start_angle, m.start_height, m.drop, m.not_before},
                                            [&](std::size_t i) -> const InsertPass& { return *passes_[i].pass; });
  const double whole = descent.whole();
  for (const double share : shares(flutes.size())) {
    for (std::size_t k = 0; k < flutes.size(); ++k) {
      if (all[k].pass != k) continue;
      Pass& p = passes_[k];
      if (const double below = descent.below(k, share); p.below != below || p.whole != whole) {
        p.below = below, p.whole = whole;
        p.open = p.pass->open(below);
        if (p.open) p.pass->sharpen(true, share * whole, whole);
      }
      if (!p.open) return std::nullopt;
    }
    if (!descent.begin()) return std::nullopt;
    const auto found = descent.down(true);
    if (found.found) return trigger_of(found, m);
    if (found.unproved) return std::nullopt;
  }
  return std::nullopt;
}

InsertTrigger TriggerSolver::alone(const Flute<double>& flute, const Beam<double>& beam, double level, double drop) {
  // from whole turns above the highest point, no more of them than it takes
  const double top = pass(0, flute.insert, beam).pass->highest() / num::cos(beam.pitch) - flute.raise;
  const double turns = std::ceil((top - level) / (2 * pi * drop)) + 1;
  InsertTrigger found = solve({&flute, 1}, beam, {0, level + turns * (2 * pi * drop), drop});
  found.turned -= turns * (2 * pi);
  return found;
}

TriggerSolver::Pass& TriggerSolver::pass(std::size_t flute, const Insert<double>& insert, const Beam<double>& beam) {
  Pass& p = passes_[flute];
  if (!(p.pass && p.insert == insert && p.beam == beam))
    p = {insert, beam, InsertPass(insert_body(insert, beam), DiscShare(beam.radius, beam.fraction)), -1, 0, false};
  return p;
}

} // namespace gumshoe::models::tool_length
