#pragma once
/// Length of a round-insert mill, measured turning on a laser tool setter.
///
/// The mill turns and is fed into the beam; the trigger fires when any insert's shadow covers a share of the beam's
/// disc; the control latches the spindle height Z'_s. With the height Z_t of the unworn tool's centre above the laser
/// reference point at that moment, the tool length is L_t = Z'_s - laser_z - Z_t.
/// Source: Fang 2022, chapter 3 (eqs 3.1 to 3.29), solved anew: trigger/insert_trigger.h.
#include <tuple>

#include "models/tool_length/prepared.h"
#include "models/tool_length/procedures.h"

namespace gumshoe::models::tool_length {

struct ToolLength {
  using Rows = tool_length::Rows;
  static constexpr ModelCard card{
      .name = "tool_length",
      .title = "Length of a round-insert mill on a laser tool setter",
      .summary =
          "A turning mill with round inserts is fed into a laser beam; the trigger fires when the shadow of an insert "
          "first covers a given fraction of the beam; the spindle height at that moment gives the tool's length.",
      .source = "Fang 2022, chapter 3 (eqs 3.1 to 3.29), derived anew; see reports/errata.md#fang-3",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = laser_setter::indications,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages,
      .timing = timing_cards};

  static constexpr bool scalar = true;
  template <class> using Memory = TriggerSolver; ///< remembers the geometry from reading to reading
  using Joint = std::tuple<Single, Single, Curve, Peaks>;

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    outcome.refuse(!(at.c.feed > T(0.0)), "feed is not positive: the tool does not descend");
    outcome.refuse(!(at.c.spindle_speed > T(0.0)),
                   "spindle_speed is not positive: the tool must turn, counter-clockwise seen from above");
    outcome.refuse(at.c.direction != T(-1.0), "direction is not -1: a mill is fed downwards");
  }
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) { check_together(at, outcome); }

  template <class T> static Rows::Measurands<T> measurands(const Readout<T>& o, Outcome<T>& outcome) {
    outcome.fail(o.trigger.height.status);
    outcome.kink = o.trigger.height.kink;
    return {o.trigger.height.value, o.length, o.effective_length};
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, TriggerSolver& solver, Outcome<T>& outcome) {
    const auto o = tool_length::simulate(solver, at);
    return {{o.spindle_z}, measurands(o, outcome)};
  }
  static Shown shown(const Readout<double>& o, Outcome<double>& outcome) {
    return {{{o.spindle_z}, measurands(o, outcome)}, o.event, o.trigger.insert};
  }
  static Shown simulate(const At<double>& at, TriggerSolver& solver, Outcome<double>& outcome) {
    return shown(tool_length::simulate(solver, at), outcome);
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, TriggerSolver& solver, const Rows::Indications<T>& read,
                                      Outcome<T>& outcome) {
    return measurands(tool_length::evaluate(solver, at, read.spindle_z), outcome);
  }

  using Prepared = tool_length::Prepared;
  static void prepare(std::span<const At<double>* const> readings, std::span<const Rows::Indications<double>> read,
                      TriggerSolver& solver, Prepared* prepared) {
    tool_length::prepare(readings, read, solver, prepared);
  }
  static Shown simulate(const At<double>& at, Prepared& prepared, Outcome<double>& outcome) {
    tool_length::simulate(prepared.first, at);
    return shown(prepared.first, outcome);
  }
  static Rows::Measurands<double> evaluate(const At<double>& at, const Prepared& prepared,
                                           const Rows::Indications<double>& read, Outcome<double>& outcome) {
    const double z = read.spindle_z;
    return measurands(tool_length::evaluate(*prepared.solver, as_read(at, z), z, prepared.first), outcome);
  }

  static std::vector<Intermediate> explain(const At<double>& at, const Rows::Indications<double>& read);
};

} // namespace gumshoe::models::tool_length
