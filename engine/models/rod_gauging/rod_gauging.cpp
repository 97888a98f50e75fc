#include "models/rod_gauging/rod_gauging.h"

namespace gumshoe::models::rod_gauging {

std::vector<Intermediate> RodGauging::explain(const At<double>& at, const Rows::Indications<double>& read) {
  const auto event = probing_event(at);
  const auto body = rod(at.q, event);
  const auto beam = laser_setter::beam(at.q);
  auto out = laser_setter::intermediates(event, event.tool_y);
  out.insert(out.end(), {{"latch delay", "s", event.latch_delay}});
  Outcome<double> outcome;
  check(at, outcome);
  if (at.evaluation == full && !outcome.failed) {
    const auto edge = shadow_edge(body, beam);
    const auto chord = solve_chord<double>(edge, beam.radius, beam.fraction);
    out.insert(out.end(), {{"shrunk radius rho", "mm", edge.rho / mm},
                           {"shadow edge: depth of the half-ellipse", "mm", edge.depth / mm},
                           {"shadow edge: shear", "1", edge.shear},
                           {"shadow edge: sideways", "mm", edge.side / mm},
                           {"solved by the fast chord iteration", "1", chord.failed == 0 ? 1.0 : 0.0}});
    if (chord.failed == 0)
      out.insert(out.end(), {{"covered chord: left end, sin w", "1", chord.left},
                             {"covered chord: right end, sin w", "1", chord.right}});
  }
  const double height = outcome.failed ? std::nan("") : solve(at, outcome);
  const auto found = evaluate(at, height, read, outcome);
  out.insert(out.end(), {{"bottom_height", "mm", found.bottom_height / mm},
                         {"spindle height, effects removed", "mm", chain::actual_of(read.spindle_z, event) / mm},
                         {"laser_z", "mm", found.laser_z / mm}});
  return out;
}

} // namespace gumshoe::models::rod_gauging
