#include "models/kernel_choice.h"
#include "models/tool_length/procedures.h"

GUMSHOE_DECLARE_KERNELS(tool_length)

namespace gumshoe::models {

namespace {

using laser_setter::deg, laser_setter::huge, laser_setter::minute, laser_setter::mm, laser_setter::rpm;

#define GUMSHOE_WEAR(k)                                                                                                \
  QuantityCard {                                                                                                       \
    "wear_" #k, "mm", "m", 0, {-huge, huge}, "W_" #k, "flute " #k " is shorter by this; ignored beyond `inserts`"      \
  }
constexpr QuantityCard quantities[] = {
    {"tool_radius",
     "mm",
     "m",
     10 * mm,
     {0, huge, true},
     "r",
     "from the tool's axis to an insert's virtual cutting point"},
    {"insert_radius", "mm", "m", 6 * mm, {0, huge, true}, "R", "of the round cutting edge"},
    {"insert_thickness", "mm", "m", 3.97 * mm, {0, huge}, "d_i", "from the rake face to the far end of the flank"},
    {"clearance_angle", "deg", "rad", 15 * deg, {0, 90 * deg, false, true}, "tau", "of the conical flank"},
    {"insert_radial_angle", "deg", "rad", -8 * deg, {-90 * deg, 90 * deg}, "theta_r", "of the rake face"},
    {"insert_axial_angle", "deg", "rad", -5 * deg, {-90 * deg, 90 * deg, true, true}, "theta_a", "of the rake face"},
    {"inserts", "1", "1", 2, {1, chain::most_inserts}, "n", "number of inserts, evenly spread; a whole number"},
    GUMSHOE_FOR_EACH_INSERT(GUMSHOE_WEAR),
    {"holder_angle", "deg", "rad", 0, {-huge, huge}, "theta_t", "from the spindle's X to the first insert"},
    {"tool_length",
     "mm",
     "m",
     150 * mm,
     {0, huge, true},
     "L_t",
     "from the spindle reference point to the unworn tool's centre; only simulation reads it"},
    {"offset", "mm", "m", 4 * mm, {-huge, huge}, "d", "of the spindle axis beside the beam: it stands at Y = -d"},
    laser_setter::beam_yaw,
    laser_setter::beam_pitch,
    laser_setter::beam_radius,
    laser_setter::trigger_fraction,
    {"laser_z", "mm", "m", 0, {-huge, huge}, "Z_ts", "height of the beam's axis, from its calibration"},
};
#undef GUMSHOE_WEAR
static_assert(std::size(quantities) == tool_length::count);
constexpr VariableCard conditions[] = {
    {"spindle_speed", "rpm", "rad/s", 1000 * rpm, "counter-clockwise seen from above"},
    {"feed", "mm/min", "m/s", 30 * mm / minute, "of the spindle towards the beam"},
    {"start_angle", "deg", "rad", 0, "spindle angle when the feed begins"},
    {"start_height", "mm", "m", 5 * mm, "of the tool's centre above the beam's axis when the feed begins"},
    laser_setter::time,
    laser_setter::direction,
};
constexpr VariableCard measurands[] = {
    {"trigger_height", "mm", "m", 0, "height of the unworn tool's centre above the beam's axis at the trigger, Z_t"},
    {"tool_length", "mm", "m", 0, "to the unworn tool's centre: spindle_z - laser_z - trigger_height"},
    {"effective_length", "mm", "m", 0, "of the longest flute: tool_length less the least wear"},
};
// Of a readout: the spindle comes to speed, the tool is fed into the beam and drawn back; an oriented one stops first.
#define GUMSHOE_RUN "spindle_speed/spindle_acceleration + start_height/feed + start_height/rapid_feed"
#define GUMSHOE_ONCE "2*approach_distance/rapid_feed + safety_time"
constexpr QuantityCard timing[] = {
    {"rapid_feed", "mm/min", "m/s", 10000 * mm / 60, {0, huge, true}, "", "of approach and retraction"},
    {"approach_distance",
     "mm",
     "m",
     200 * mm,
     {0, huge},
     "",
     "from where the tool waits to above the beam, there and back"},
    {"orientation_time", "s", "s", 1, {0, huge}, "", "to stop the spindle at the start angle"},
    {"spindle_acceleration", "rad/s2", "rad/s2", 200, {0, 1e6, true}, "", "of the spindle coming to speed"},
    {"safety_time", "s", "s", 2, {0, huge}, "", "checks of the tool setter, dwell, air blast"},
};
constexpr EvaluationCard evaluations[] = {
    {"full", "the trigger of the turning tool solved: Fang 2022, chapter 3"},
    {"conventional", "trigger_height = 0: the readout less the laser's height; what ignoring the geometry costs"},
    {"single",
     "one readout at any start angle, no curve known: effective_length is the readout less the laser's height",
     tool_length::length_measurands, GUMSHOE_RUN, GUMSHOE_ONCE},
    {"slow", "the same at high spindle speed and low feed", tool_length::length_measurands, GUMSHOE_RUN, GUMSHOE_ONCE},
    {"characteristic_curve", "readouts at several start angles: the model's curve fitted, its phase free",
     tool_length::curve_measurands, "orientation_time + " GUMSHOE_RUN, GUMSHOE_ONCE},
    {"peaks",
     "readouts at several start angles, connected by lines: the highest peaks are the flutes (Fang 2022, 3.5.2)",
     tool_length::peak_measurands, "orientation_time + " GUMSHOE_RUN, GUMSHOE_ONCE},
};
constexpr Stage stages[] = {Stage::pose,   Stage::insert, Stage::spindle,
                            Stage::motion, Stage::timing, Stage::trigger};

constexpr ModelCard card{
    "tool_length",
    "Length of a round-insert mill on a laser tool setter",
    "A turning mill with round inserts is fed into a laser beam; the trigger fires the first time that an insert's "
    "shadow covers a share of the beam's disc; from the spindle height at that moment follows the tool's length.",
    "Fang 2022, chapter 3 (eqs 3.1 to 3.29), derived anew; see reports/errata.md#fang-3",
    quantities,
    conditions,
    laser_setter::indications,
    measurands,
    evaluations,
    stages,
    timing};
#undef GUMSHOE_RUN
#undef GUMSHOE_ONCE

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  thread_local tool_length::TriggerSolver solver; // remembers the geometry from reading to reading
  const auto o = tool_length::evaluate(solver, call);
  call.measurands[tool_length::trigger_height_row] = o.trigger.height.value;
  call.measurands[tool_length::length_row] = o.length;
  call.measurands[tool_length::effective_row] = o.effective_length;
  return {code(o.trigger.height.status), o.trigger.height.kink};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  thread_local tool_length::TriggerSolver solver; // remembers the geometry from reading to reading
  const auto o = tool_length::simulate(solver, call);
  call.simulated[0] = o.spindle_z;
  return {code(o.trigger.height.status), o.trigger.height.kink};
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const double* q = call.quantities;
  thread_local tool_length::TriggerSolver solver; // remembers the geometry from reading to reading
  const auto o = tool_length::evaluate(solver, call);
  const auto& event = o.event;
  const auto m = tool_length::motion(q, event, call.conditions);
  std::vector<Intermediate> out{
      {"tool axis beside the beam's reference point, X", "mm", event.tool_x / mm},
      {"tool axis beside the beam's reference point, Y", "mm", (event.tool_y - q[tool_length::offset]) / mm},
      {"tool growth", "mm", event.tool_growth / mm},
      {"axis error", "mm", event.z.error / mm},
      {"axis scale", "um/m", event.z.scale * 1e6},
      {"true height when the feed begins", "mm", m.height / mm},
      {"true angle of the first insert when the feed begins", "deg", m.angle / deg},
      {"descent per revolution", "mm", 2 * std::numbers::pi * m.drop / mm},
      {"delay from the trigger to the latch", "s", event.latch_delay},
  };
  if (call.evaluation == tool_length::full && o.trigger.height.status == Status::ok) {
    const auto flute = tool_length::flute(q, event, o.trigger.insert);
    const double highest = solver.heights(flute.insert, tool_length::beam(q)).highest().height;
    out.insert(out.end(), {{"highest trigger height of this insert, unworn", "mm", highest / mm},
                           {"insert that triggers", "1", o.trigger.insert + 1.0},
                           {"spindle turned until the trigger", "deg", o.trigger.turned / deg}});
  }
  out.insert(out.end(), {{"trigger_height", "mm", o.trigger.height.value / mm},
                         {"spindle height, effects removed", "mm", chain::actual_of(call.indications[0], event) / mm},
                         {"tool_length", "mm", o.length / mm},
                         {"effective_length", "mm", o.effective_length / mm}});
  return out;
}

std::string check(const PointCall<double>& call) {
  double condition[tool_length::conditions];
  std::copy_n(call.conditions, static_cast<std::size_t>(tool_length::conditions), condition);
  const auto event = tool_length::probing_event<double>(call.quantities, condition, call.effects, call.active);
  const char* problem = tool_length::impossible(call.quantities, call.conditions, event);
  return problem ? problem : "";
}

bool solve_reads(std::size_t) { return true; } // even laser_z, by the scale of the axis

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(tool_length); }

} // namespace

namespace tool_length {
extern const Model model;
const Model model{&card,
                        &kernels,
                        &evaluate_point<Gradient>,
                        &evaluate_point<Curvature>,
                        &simulate_point<Gradient>,
                        &explain,
                        &check,
                        &solve_reads,
                        nullptr,
                        0,
                        &tool_length::measurands_in_use,
                        &tool_length::check_readings};

} // namespace tool_length
} // namespace gumshoe::models
