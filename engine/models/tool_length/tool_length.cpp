#include "models/tool_length/tool_length.h"

namespace gumshoe::models::tool_length {

std::vector<Intermediate> ToolLength::explain(const At<double>& at, const Rows::Indications<double>& read) {
  const auto& q = at.q;
  TriggerSolver solver;
  const auto o = tool_length::evaluate(solver, at, read.spindle_z);
  const auto& event = o.event;
  const auto m = motion(at, event);
  auto out = laser_setter::intermediates(event, event.tool_y - q.offset);
  out.insert(out.end(), {{"true height when the feed begins", "mm", m.height / mm},
                         {"true angle of the first insert when the feed begins", "deg", m.angle / deg},
                         {"descent per revolution", "mm", 2 * pi * m.drop / mm},
                         {"delay from the trigger to the latch", "s", event.latch_delay}});
  if (at.evaluation == full && o.trigger.height.status == Status::ok) {
    const auto flute = tool_length::flute(q, event, o.trigger.insert);
    const double highest = solver.heights(flute.insert, laser_setter::beam(q)).highest().height;
    out.insert(out.end(), {{"highest trigger height of this insert, unworn", "mm", highest / mm},
                           {"insert that triggers", "1", o.trigger.insert + 1.0},
                           {"spindle turned until the trigger", "deg", o.trigger.turned / deg}});
  }
  out.insert(out.end(), {{"trigger_height", "mm", o.trigger.height.value / mm},
                         {"spindle height, effects removed", "mm", chain::actual_of(read.spindle_z, event) / mm},
                         {"tool_length", "mm", o.length / mm},
                         {"effective_length", "mm", o.effective_length / mm}});
  return out;
}

} // namespace gumshoe::models::tool_length
