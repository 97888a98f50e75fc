#pragma once
/// Readings whose triggers are solved together, in SIMD lanes.
#include <algorithm>
#include <optional>
#include <span>

#include "models/tool_length/readout.h"

namespace gumshoe::models::tool_length {

struct Prepared {
  Readout<double> first; ///< at the reading, or where its evaluation begins
  TriggerSolver* solver = nullptr;
};

/// The readout of each reading; `read` are the indications, or empty for the machine.
inline void prepare(std::span<const At<double>* const> readings, std::span<const Rows::Indications<double>> read,
                    TriggerSolver& solver, Prepared* prepared) {
  constexpr std::size_t at_once = 16;
  Flute<double> flutes[at_once][chain::most_inserts];
  InsertMotionOf<double> motions[at_once];
  TriggerQuestion questions[at_once];
  InsertTrigger answers[at_once];
  std::size_t asked[at_once], waiting = 0;
  const auto answer = [&] {
    solver.solve({questions, waiting}, answers);
    for (std::size_t j = 0; j < waiting; ++j) {
      Readout<double>& o = prepared[asked[j]].first;
      o.trigger = trigger_of<double>(*readings[asked[j]], o.event, motions[j], answers[j]);
    }
    waiting = 0;
  };
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const bool with_solve = read.empty() || readings[i]->evaluation == full;
    std::optional<At<double>> as_it_reads;
    if (!read.empty()) as_it_reads = as_read(*readings[i], read[i].spindle_z);
    const At<double>& at = as_it_reads ? *as_it_reads : *readings[i];
    Prepared& p = prepared[i];
    p.solver = &solver;
    Readout<double>& o = p.first;
    o.event = with_solve ? probing_event(at) : event_without_trigger(at);
    o.trigger = {};
    auto& all = flutes[waiting];
    const std::size_t n = plain_flutes(at, o.event, all);
    o.least_raise = all[0].raise;
    for (std::size_t k = 1; k < n; ++k) o.least_raise = std::min(o.least_raise, all[k].raise);
    if (!with_solve) continue;
    const auto m = motion(at, o.event);
    if (!finite(m) || m.lag != 0) {
      o.trigger = trigger(solver, at, o.event);
      continue;
    }
    motions[waiting] = m;
    questions[waiting] = {{all, n}, laser_setter::beam(at.q), {m.angle, m.height, m.drop}};
    asked[waiting++] = i;
    if (waiting == at_once) answer();
  }
  answer();
}

} // namespace gumshoe::models::tool_length
