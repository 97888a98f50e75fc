#include "models/rod_gauging/rod_gauging.h"

#include "models/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(rod_gauging)

namespace gumshoe::models {

namespace {

using laser_setter::deg, laser_setter::huge, laser_setter::minute, laser_setter::mm;

constexpr QuantityCard quantities[] = {
    {"rod_radius", "mm", "m", 5 * mm, {0, huge, true}, "R_r", "radius of the rod's cylinder"},
    {"fillet_radius",
     "mm",
     "m",
     0.03 * mm,
     {0, huge},
     "R_f",
     "radius of the rounding between cylinder and bottom; at most rod_radius (ball end)"},
    {"bottom_elevation",
     "deg",
     "rad",
     90 * deg,
     {0, std::numbers::pi, true, true},
     "phi",
     "elevation of the bottom plane's normal; 90 deg is a square end"},
    {"bottom_azimuth",
     "deg",
     "rad",
     0,
     {-huge, huge},
     "tau",
     "azimuth of the bottom plane's normal in the tool-holder frame"},
    {"rod_length",
     "mm",
     "m",
     150 * mm,
     {0, huge, true},
     "L_r",
     "from the spindle reference point to the bottom's centre, at 20 degC"},
    {"holder_angle", "deg", "rad", 0, {-huge, huge}, "theta_th", "from machine X to the tool holder's X"},
    laser_setter::beam_yaw,
    laser_setter::beam_pitch,
    laser_setter::beam_radius,
    laser_setter::trigger_fraction,
    {"laser_z",
     "mm",
     "m",
     0,
     {-huge, huge},
     "Z_ts",
     "true height of the beam's axis where it passes the spindle axis; only simulation reads it"},
};
constexpr VariableCard conditions[] = {
    {"feed", "mm/min", "m/s", 4 * mm / minute, "feed of the spindle towards the beam"},
    laser_setter::time,
    laser_setter::direction,
};
constexpr VariableCard measurands[] = {
    {"bottom_height", "mm", "m", 0, "height of the bottom's centre above the beam's axis at the trigger, Z'_d"},
    {"laser_z", "mm", "m", 0,
     "height of the beam's axis where it passes the spindle axis: spindle_z - rod_length - bottom_height"},
};
constexpr std::string_view per_reading = "approach / feed + retract", once = "rod_change";
constexpr EvaluationCard evaluations[] = {
    {"full", "the geometry of rod and beam solved: Fang 2022, section 2.4", {}, per_reading, once},
    {"conventional",
     "square rod, aligned beam: bottom_height = 0; what ignoring the geometry costs",
     {},
     per_reading,
     once},
};
constexpr QuantityCard timing[] = {
    {"approach", "mm", "m", 2 * mm, {0, huge}, "", "way at the feed before the trigger"},
    {"retract", "s", "s", 2, {0, huge}, "", "back up at rapid, and settling, of every reading"},
    {"rod_change", "s", "s", 60, {0, huge}, "", "the rod into the spindle and over the beam, once"},
};
constexpr Stage stages[] = {Stage::standing, Stage::pose, Stage::motion, Stage::trigger};

constexpr ModelCard card{
    "rod_gauging",
    "Gauging a laser tool setter with a measuring rod",
    "A rod in the spindle is lowered into a laser beam; the trigger fires when its shadow covers a share of the beam's "
    "disc; from the spindle height at that moment follows the height of the beam's axis.",
    "Fang 2022, chapter 2 (eqs 2.3 to 2.38), derived anew; see reports/errata.md",
    quantities,
    conditions,
    laser_setter::indications,
    measurands,
    evaluations,
    stages,
    timing};

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  T condition[rod_gauging::conditions];
  for (int i = 0; i < rod_gauging::conditions; ++i) condition[i] = T(call.conditions[i]);
  const auto event = rod_gauging::probing_event<T>(call.quantities, condition, call.effects, call.active);
  laser_setter::Solved<T> height{T(0.0)};
  if (call.evaluation == rod_gauging::full)
    height = rod_gauging::differentiable_height(rod_gauging::rod(call.quantities, event), rod_gauging::beam(call.quantities));
  call.measurands[rod_gauging::bottom_height_row] = height.value;
  call.measurands[rod_gauging::laser_z_row] = rod_gauging::evaluate(call.indications[0], call.quantities, height.value, event);
  return {code(height.status), height.kink};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  T condition[rod_gauging::conditions];
  for (int i = 0; i < rod_gauging::conditions; ++i) condition[i] = T(call.conditions[i]);
  const auto event = rod_gauging::probing_event<T>(call.quantities, condition, call.effects, call.active);
  const auto height = rod_gauging::differentiable_height(rod_gauging::rod(call.quantities, event), rod_gauging::beam(call.quantities));
  call.simulated[0] = rod_gauging::simulate(call.quantities, height.value, event);
  return {code(height.status), height.kink};
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const double* q = call.quantities;
  double condition[rod_gauging::conditions];
  std::copy_n(call.conditions, static_cast<std::size_t>(rod_gauging::conditions), condition);
  const auto event = rod_gauging::probing_event<double>(q, condition, call.effects, call.active);
  const auto body = rod_gauging::rod(q, event);
  const auto beam = rod_gauging::beam(q);
  std::vector<Intermediate> out{
      {"tool axis beside the beam's reference point, X", "mm", event.tool_x / mm},
      {"tool axis beside the beam's reference point, Y", "mm", event.tool_y / mm},
      {"tool growth", "mm", event.tool_growth / mm},
      {"axis error", "mm", event.z.error / mm},
      {"axis scale", "um/m", event.z.scale * 1e6},
      {"latch delay", "s", event.latch_delay},
  };
  if (call.evaluation == rod_gauging::full && rod_gauging::in_domain(body, beam)) {
    const auto edge = rod_gauging::shadow_edge(body, beam);
    const auto chord = rod_gauging::solve_chord<double>(edge, beam.radius, beam.fraction);
    out.insert(out.end(), {{"shrunk radius rho", "mm", edge.rho / mm},
                           {"shadow edge: depth of the half-ellipse", "mm", edge.depth / mm},
                           {"shadow edge: shear", "1", edge.shear},
                           {"shadow edge: sideways", "mm", edge.side / mm},
                           {"solved by the fast chord iteration", "1", chord.failed == 0 ? 1.0 : 0.0}});
    if (chord.failed == 0)
      out.insert(out.end(), {{"covered chord: left end, sin w", "1", chord.left},
                             {"covered chord: right end, sin w", "1", chord.right}});
  }
  const auto solved = rod_gauging::trigger_height(body, beam);
  const double height = call.evaluation == rod_gauging::full ? solved.value : 0.0;
  const double actual = chain::actual_of(call.indications[0], event);
  out.insert(out.end(), {{"bottom_height", "mm", height / mm},
                         {"spindle height, effects removed", "mm", actual / mm},
                         {"laser_z", "mm", rod_gauging::evaluate(call.indications[0], q, height, event) / mm}});
  return out;
}

std::string check(const PointCall<double>& call) {
  const double* q = call.quantities;
  if (q[rod_gauging::fillet] > q[rod_gauging::radius]) return "fillet_radius exceeds rod_radius";
  return {};
}

bool solve_reads(std::size_t quantity) { return quantity != rod_gauging::length && quantity != rod_gauging::laser_z; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(rod_gauging); }

} // namespace

namespace rod_gauging {
extern const Model model;
const Model model{
    &card,  &kernels,    &evaluate_point<Gradient>, &evaluate_point<Curvature>, &simulate_point<Gradient>, &explain,
    &check, &solve_reads};

} // namespace rod_gauging
} // namespace gumshoe::models
