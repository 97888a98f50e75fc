#include "models/kernel_choice.h"
#include "models/tool_length/procedures.h"

GUMSHOE_DECLARE_KERNELS(tool_length)

namespace gumshoe::models {

namespace {

constexpr double pi = 3.14159265358979323846, mm = 1e-3, deg = pi / 180, huge = 1e3;

#define GUMSHOE_WEAR(k)                                                                                                \
  { "wear_" #k, "mm", "m", 0, {-huge, huge}, "W_" #k, "flute " #k " is shorter by this; ignored beyond `inserts`" }
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
    GUMSHOE_WEAR(1),
    GUMSHOE_WEAR(2),
    GUMSHOE_WEAR(3),
    GUMSHOE_WEAR(4),
    GUMSHOE_WEAR(5),
    GUMSHOE_WEAR(6),
    GUMSHOE_WEAR(7),
    GUMSHOE_WEAR(8),
    GUMSHOE_WEAR(9),
    GUMSHOE_WEAR(10),
    GUMSHOE_WEAR(11),
    GUMSHOE_WEAR(12),
    {"holder_angle", "deg", "rad", 0, {-huge, huge}, "theta_t", "from the spindle's X to the first insert"},
    {"tool_length",
     "mm",
     "m",
     150 * mm,
     {0, huge, true},
     "L_t",
     "from the spindle reference point to the unworn tool's centre; only simulation reads it"},
    {"offset", "mm", "m", 4 * mm, {-huge, huge}, "d", "of the spindle axis beside the beam: it stands at Y = -d"},
    {"beam_yaw", "deg", "rad", 0, {-huge, huge}, "alpha", "of the beam about Z, from machine X"},
    {"beam_pitch",
     "deg",
     "rad",
     0,
     {-90 * deg, 90 * deg, true, true},
     "beta",
     "of the beam out of the horizontal, positive upwards along the beam"},
    {"beam_radius", "mm", "m", 0.2 * mm, {0, huge, true}, "R_l", "radius of the beam's disc on the receiver"},
    {"trigger_fraction",
     "1",
     "1",
     0.5,
     {0, 1, true, true},
     "eta",
     "share of the disc that is covered when the trigger fires"},
    {"laser_z", "mm", "m", 0, {-huge, huge}, "Z_ts", "height of the beam's axis, from its calibration"},
};
#undef GUMSHOE_WEAR
static_assert(std::size(quantities) == mill::count);
constexpr VariableCard conditions[] = {
    {"spindle_speed", "rpm", "rad/s", 1000 * 2 * pi / 60, "counter-clockwise seen from above"},
    {"feed", "mm/min", "m/s", 30 * mm / 60, "of the spindle towards the beam"},
    {"start_angle", "deg", "rad", 0, "spindle angle when the feed begins"},
    {"start_height", "mm", "m", 5 * mm, "of the tool's centre above the beam's axis when the feed begins"},
    {"time", "s", "s", 0, "since the start of the work"},
    {"direction", "1", "1", -1, "of approach along Z: -1 downwards"},
};
constexpr VariableCard indications[] = {{"spindle_z", "mm", "m", 0, "spindle height latched at the trigger, Z'_s"}};
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
     mill::length_measurands, GUMSHOE_RUN, GUMSHOE_ONCE},
    {"slow", "the same at high spindle speed and low feed", mill::length_measurands, GUMSHOE_RUN, GUMSHOE_ONCE},
    {"characteristic_curve", "readouts at several start angles: the model's curve fitted, its phase free",
     mill::curve_measurands, "orientation_time + " GUMSHOE_RUN, GUMSHOE_ONCE},
    {"peaks",
     "readouts at several start angles, connected by lines: the highest peaks are the flutes (Fang 2022, 3.5.2)",
     mill::peak_measurands, "orientation_time + " GUMSHOE_RUN, GUMSHOE_ONCE},
};
constexpr std::string_view stages[] = {"pose", "motion", "trigger"};

constexpr ModelCard card{
    "tool_length",
    "Length of a round-insert mill on a laser tool setter",
    "A turning mill with round inserts is fed into a laser beam; the trigger fires the first time that an insert's "
    "shadow covers a share of the beam's disc; from the spindle height at that moment follows the tool's length.",
    "Fang 2022, chapter 3 (eqs 3.1 to 3.29), derived anew; see reports/errata.md",
    quantities,
    conditions,
    indications,
    measurands,
    evaluations,
    stages,
    timing};
#undef GUMSHOE_RUN
#undef GUMSHOE_ONCE

template <class T> struct Point {
  T condition[mill::conditions];
  chain::ProbingEvent<T> event;
  chain::Solved<T> height{T(0.0)};
};

template <class T> Point<T> solve_point(const PointCall<T>& call, bool with_solve) {
  Point<T> p;
  double q[mill::count];
  for (int i = 0; i < mill::count; ++i) q[i] = num::value(call.quantities[i]);
  for (int i = 0; i < mill::conditions; ++i) p.condition[i] = T(call.conditions[i]);
  p.event = mill::probing_event<T>(call.quantities, p.condition, call.effects, call.active);
  if (mill::impossible(q, call.conditions)) {
    p.height = {T(std::nan("")), chain::SolveStatus::out_of_domain};
    return p;
  }
  if (!with_solve) return p;
  chain::TriggerSolver solver;
  const auto trigger = mill::trigger(solver, call.quantities, p.event, call.conditions);
  if (trigger.status != chain::SolveStatus::ok) {
    p.height = {T(std::nan("")), trigger.status};
    return p;
  }
  p.height.value = chain::differentiable_trigger_height<T>(
      mill::flute(call.quantities, p.event, trigger.insert), mill::beam(call.quantities),
      {call.quantities[mill::holder_angle] + call.conditions[mill::start_angle], T(call.conditions[mill::start_height]),
       T(mill::drop(call.conditions))},
      trigger);
  return p;
}

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const Point<T> p = solve_point(call, call.evaluation == mill::full);
  const T length = mill::evaluate(call.indications[0], call.quantities, p.height.value, p.event);
  call.measurands[mill::trigger_height_row] = p.height.value;
  call.measurands[mill::length_row] = length;
  call.measurands[mill::effective_row] = mill::effective_length(call.quantities, length);
  return {static_cast<std::uint8_t>(p.height.status), p.height.kink};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  const Point<T> p = solve_point(call, true);
  call.simulated[0] = mill::simulate(call.quantities, p.height.value, p.event);
  return {static_cast<std::uint8_t>(p.height.status), p.height.kink};
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const double* q = call.quantities;
  const Point<double> p = solve_point(call, call.evaluation == mill::full);
  std::vector<Intermediate> out{
      {"tool axis beside the beam's reference point, X", "mm", p.event.tool_x / mm},
      {"tool axis beside the beam's reference point, Y", "mm", (p.event.tool_y - q[mill::offset]) / mm},
      {"tool growth", "mm", p.event.tool_growth / mm},
      {"axis error", "mm", p.event.axis_error / mm},
      {"axis scale", "um/m", p.event.axis_scale * 1e6},
      {"latch delay", "s", p.event.latch_delay},
      {"descent per revolution", "mm", 2 * pi * mill::drop(call.conditions) / mm},
  };
  if (call.evaluation == mill::full && p.height.status == chain::SolveStatus::ok) {
    chain::TriggerSolver solver;
    const auto trigger = mill::trigger(solver, q, p.event, call.conditions);
    const double highest =
        solver.heights(mill::flute(q, p.event, trigger.insert).insert, mill::beam(q)).highest().height;
    out.insert(out.end(), {{"highest trigger height of this insert, unworn", "mm", highest / mm},
                           {"insert that triggers", "1", trigger.insert + 1.0},
                           {"spindle turned until the trigger", "deg", trigger.turned / deg}});
  }
  const double length = mill::evaluate(call.indications[0], q, p.height.value, p.event);
  out.insert(out.end(), {{"trigger_height", "mm", p.height.value / mm},
                         {"spindle height, effects removed", "mm", chain::actual_of(call.indications[0], p.event) / mm},
                         {"tool_length", "mm", length / mm},
                         {"effective_length", "mm", mill::effective_length(q, length) / mm}});
  return out;
}

std::string check(const PointCall<double>& call) {
  const char* problem = mill::impossible(call.quantities, call.conditions);
  return problem ? problem : "";
}

bool solve_reads(std::size_t quantity) { return quantity != mill::length && quantity != mill::laser_z; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(tool_length); }

} // namespace

extern const Model tool_length;
const Model tool_length{&card,
                        &kernels,
                        &evaluate_point<Gradient>,
                        &evaluate_point<Curvature>,
                        &simulate_point<Gradient>,
                        &explain,
                        &check,
                        &solve_reads,
                        nullptr,
                        0,
                        &mill::measurands_in_use,
                        &mill::check_readings};

} // namespace gumshoe::models
