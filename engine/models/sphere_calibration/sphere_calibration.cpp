#include "models/sphere_calibration/sphere_calibration.h"

#include <algorithm>
#include <array>

#include "models/kernel_choice.h"
#include "models/sphere_calibration/procedures.h"

GUMSHOE_DECLARE_KERNELS(sphere_calibration)

namespace gumshoe::models {

namespace {

constexpr double mm = 1e-3, um = 1e-6, deg = 3.14159265358979323846 / 180, huge = 1e3;
constexpr Limits any{-huge, huge}, positive{0, huge, true}, below_90{-90 * deg, 90 * deg, true, true};

constexpr QuantityCard quantities[] = {
    {"probe_x", "mm", "m", 85.564 * mm, any, "d_rpx", "from the origin O_r to the tip's centre, along X"},
    {"probe_y", "mm", "m", 287.428 * mm, any, "d_rpy", "from the origin O_r to the tip's centre, against Y"},
    {"probe_z", "mm", "m", 454.220 * mm, any, "d_rpz", "from the origin O_r to the tip's centre, against Z"},
    {"E_X0B", "mm", "m", -0.406 * mm, any, "E_X0B", "offset of the B axis: D_rbx - d_rbx, along X"},
    {"E_Z0B", "mm", "m", 0.544 * mm, any, "E_Z0B", "offset of the B axis: D_rbz - d_rbz, so against Z; minus ISO's"},
    {"E_X0C", "mm", "m", 0.230 * mm, any, "E_X0C", "offset of the C axis: D_rcx - d_rcx, along X"},
    {"E_Y0C", "mm", "m", 0.369 * mm, any, "E_Y0C", "offset of the C axis: D_rcy - d_rcy, along Y"},
    {"E_A0B", "deg", "rad", -0.267 * deg, below_90, "E_A0B", "squareness of B to Z; b ~ (-tan E_C0B, 1, tan E_A0B)"},
    {"E_C0B", "deg", "rad", -0.184 * deg, below_90, "E_C0B", "squareness of B to X; b ~ (-tan E_C0B, 1, tan E_A0B)"},
    {"E_A0C", "deg", "rad", 0.0433 * deg, below_90, "E_A0C", "squareness of C to Y; c ~ (tan E_B0C, -tan E_A0C, 1)"},
    {"E_B0C", "deg", "rad", 0.0121 * deg, below_90, "E_B0C", "squareness of C to X; c ~ (tan E_B0C, -tan E_A0C, 1)"},
    {"link_B_x", "mm", "m", -120 * mm, any, "d_rbx", "design, O_r to the B axis along X; inferred, not printed"},
    {"link_B_z", "mm", "m", 110 * mm, any, "d_rbz", "design, O_r to the B axis against Z; inferred, not printed"},
    {"link_C_x", "mm", "m", 50 * mm, any, "d_rcx", "design, O_r to the C axis along X; inferred, not printed"},
    {"link_C_y", "mm", "m", 180 * mm, any, "d_rcy", "design, O_r to the C axis along Y; inferred, not printed"},
    {"sphere_distance", "mm", "m", 184.183 * mm, any, "d_s", "from the A axis' flange to the sphere's centre"},
    {"sphere_radius", "mm", "m", 12.5 * mm, positive, "R_c", "of the sphere"},
    {"tip_radius", "mm", "m", 3 * mm, positive, "R_p", "of the probe's tip"},
    {"sphere_y", "mm", "m", 0, any, "", "sphere's centre beside the A axis, along Y at A = 0; turns with A"},
    {"sphere_z", "mm", "m", 0, any, "", "sphere's centre beside the A axis, along Z at A = 0; turns with A"},
    {"E_AA", "deg", "rad", 0, any, "E_AA", "positioning error of A; only a sphere beside the axis feels it"},
    {"E_BB", "deg", "rad", 0, any, "E_BB", "positioning error of B, actual minus commanded (eq 4.49)"},
    {"E_CC", "deg", "rad", 0, any, "E_CC", "positioning error of C, actual minus commanded (eq 4.50)"},
#define GUMSHOE_LINEAR(name, what)                                                                                     \
  { name, "mm", "m", 0, any, name, what }
    GUMSHOE_LINEAR("E_XX", "positioning of X; adds to the recorded X (eq 4.51)"),
    GUMSHOE_LINEAR("E_XY", "straightness of Y along X; adds to the recorded X"),
    GUMSHOE_LINEAR("E_XZ", "straightness of Z along X; adds to the recorded X"),
    GUMSHOE_LINEAR("E_YX", "straightness of X along Y; adds to the recorded Y"),
    GUMSHOE_LINEAR("E_YY", "positioning of Y; adds to the recorded Y"),
    GUMSHOE_LINEAR("E_YZ", "straightness of Z along Y; adds to the recorded Y"),
    GUMSHOE_LINEAR("E_ZX", "straightness of X along Z; adds to the recorded Z"),
    GUMSHOE_LINEAR("E_ZY", "straightness of Y along Z; adds to the recorded Z"),
    GUMSHOE_LINEAR("E_ZZ", "positioning of Z; adds to the recorded Z"),
#undef GUMSHOE_LINEAR
    {"S_XY", "um/m", "rad", 0, any, "S_XY", "squareness of Y to X: adds -S_XY times the nominal Y to the recorded X"},
    {"S_XZ", "um/m", "rad", 0, any, "S_XZ", "squareness of Z to X: adds S_XZ times the nominal Z to the recorded X"},
    {"S_YZ", "um/m", "rad", 0, any, "S_YZ", "squareness of Z to Y: adds -S_YZ times the nominal Z to the recorded Y"},
};
static_assert(std::size(quantities) == sphere_calibration::count);
constexpr VariableCard conditions[] = {
    {"A", "deg", "rad", 0, "commanded; turns the workpiece about +X (eq 4.1)"},
    {"B", "deg", "rad", 0, "commanded; about +Y"},
    {"C", "deg", "rad", 0, "commanded; about +Z"},
    {"pattern", "1", "1", 0,
     "a label: 1 where C moves at B = 0, 2 where B moves at C = 90 deg; only closed_form reads it"},
    {"repeat", "1", "1", 0, "a label: which repetition"},
    {"direction", "1", "1", -1, "of approach along Z: -1 downwards"},
    {"time", "s", "s", 0, "since the start of the work"},
    {"feed", "mm/min", "m/s", 30 * mm / 60, "of the approach; only effects read this and what follows"},
    {"B_direction", "1", "1", 1, "from which B was reached: 1 or -1, upwards or downwards; 0: neither"},
    {"C_direction", "1", "1", 1, "from which C was reached: 1 or -1, upwards or downwards; 0: neither"},
    {"B_clamped", "1", "1", 0, "1 where the brake of B holds"},
    {"C_clamped", "1", "1", 0, "1 where the brake of C holds"},
};
constexpr VariableCard indications[] = {
    {"X", "mm", "m", 0, "command recorded at the trigger"},
    {"Y", "mm", "m", 0, "command recorded at the trigger"},
    {"Z", "mm", "m", 0, "command recorded at the trigger"},
};
constexpr VariableCard measurands[] = {
    {"tip_x", "mm", "m", 0, "where the tip's centre stood by X, Y, Z: from the A axis' flange, along X"},
    {"tip_y", "mm", "m", 0, "where the tip's centre stood by X, Y, Z: from the A axis, along Y"},
    {"tip_z", "mm", "m", 0, "where the tip's centre stood by X, Y, Z: from the A axis, along Z"},
};
constexpr EvaluationCard evaluations[] = {
    {"exact", "exact rotations about the actual axes"},
    {"small_angle", "the thesis' product (4.7) to (4.10); for the reproduction study, 12 to 20 um off"},
    {"closed_form", "eqs 4.23 to 4.25 at B = 0 and 4.30 to 4.38, corrected, at C = 90 deg; for the reproduction study"},
    {"sequential",
     "orientations by planes through each pattern's poses, then the seven lengths by linear least squares",
     sphere_calibration::joint_measurands},
    {"joint", "all eleven at once by least squares, every command of equal weight", sphere_calibration::joint_measurands},
    {"joint_weighted", "all eleven at once, weighted with the covariance matrix of all that the scenario declares",
     sphere_calibration::joint_measurands},
};

constexpr Stage stages[] = {Stage::motion, Stage::rotary, Stage::slides, Stage::contact, Stage::trigger};

constexpr ModelCard card{"sphere_calibration",
                         "Calibrating a probe and two rotary axes with a sphere",
                         "A belt grinder's probe touches the top of a sphere at many angles of B and C; from the "
                         "recorded commands follow the "
                         "probe's position and the location errors of both axes.",
                         "Fang 2022, chapter 4 (eqs 4.1 to 4.51), derived anew; see reports/errata.md",
                         quantities,
                         conditions,
                         indications,
                         measurands,
                         evaluations,
                         stages};

int variant_of(int evaluation) { return evaluation < sphere_calibration::variants ? evaluation : static_cast<int>(sphere_calibration::exact); }

template <class T> struct Point {
  sphere_calibration::Contact<T> at;
  std::uint8_t status = 0;
};
template <class T> Point<T> point(const PointCall<T>& call) {
  T condition[sphere_calibration::conditions];
  for (int i = 0; i < sphere_calibration::conditions; ++i) condition[i] = T(call.conditions[i]);
  const int variant = variant_of(call.evaluation);
  const auto links = sphere_calibration::links(call.quantities);
  Point<T> p{sphere_calibration::contact(variant, call.quantities, links, condition, sphere_calibration::is_pattern_II(call.conditions), true,
                             {call.active, call.effects})};
  if (variant == sphere_calibration::closed_form && !sphere_calibration::has_closed_form(call.conditions))
    p.status = code(Status::out_of_domain);
  return p;
}

template <class T> void store(const Vector3<T>& value, T* out) { out[0] = value.x, out[1] = value.y, out[2] = value.z; }

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const Point<T> p = point(call);
  store(sphere_calibration::evaluate({call.indications[0], call.indications[1], call.indications[2]}, p.at), call.measurands);
  return {p.status};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  const Point<T> p = point(call);
  store(sphere_calibration::simulate(p.at), call.simulated);
  return {p.status};
}

void add(std::vector<Intermediate>& out, const std::string& what, const Vector3<double>& v, const char* unit = "mm",
         double factor = 1e3) {
  out.push_back({what + ", X", unit, v.x * factor});
  out.push_back({what + ", Y", unit, v.y * factor});
  out.push_back({what + ", Z", unit, v.z * factor});
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const double* q = call.quantities;
  const auto links = sphere_calibration::links(q);
  const auto at = point(call).at;
  std::vector<Intermediate> out{
      {"actual B axis from the origin, D_rbx", "mm", links.length[sphere_calibration::length_B_x] / mm},
      {"actual B axis from the origin, D_rbz", "mm", links.length[sphere_calibration::length_B_z] / mm},
      {"actual C axis from the origin, D_rcx", "mm", links.length[sphere_calibration::length_C_x] / mm},
      {"actual C axis from the origin, D_rcy", "mm", links.length[sphere_calibration::length_C_y] / mm},
  };
  add(out, "direction of the B axis", links.lines.b, "1", 1);
  add(out, "direction of the C axis", links.lines.c, "1", 1);
  out.push_back({"actual A", "deg", (call.conditions[sphere_calibration::A] + q[sphere_calibration::E_AA]) / deg});
  out.push_back({"actual B", "deg", (call.conditions[sphere_calibration::B] + q[sphere_calibration::E_BB]) / deg});
  out.push_back({"actual C", "deg", (call.conditions[sphere_calibration::C] + q[sphere_calibration::E_CC]) / deg});
  add(out, "tip above the sphere", at.tip);
  add(out, "probe from the commanded origin", at.probe);
  add(out, "nominal command", at.nominal);
  add(out, "linear axes add to the command", at.added, "um", 1 / um);
  if (at.touch) {
    const auto& [event, rotary] = *at.touch;
    out.insert(out.end(), {{"effects turn B", "arcsec", rotary.B.error[chain::E_B] / deg * 3600},
                           {"effects turn C", "arcsec", rotary.C.error[chain::E_C] / deg * 3600},
                           {"pretravel", "um", event.pretravel / um},
                           {"latch delay", "s", event.latch_delay}});
    add(out, "approach in the probe's frame", event.approach_in_probe, "1", 1);
    add(out, "effects add to the command", at.touch->reading_of(at.tip - at.probe) - (at.tip - at.probe), "um", 1 / um);
  }
  add(out, "command at the sphere's top", sphere_calibration::simulate(at));
  const auto tip = sphere_calibration::evaluate({call.indications[0], call.indications[1], call.indications[2]}, at);
  out.insert(out.end(), {{"tip_x", "mm", tip.x / mm}, {"tip_y", "mm", tip.y / mm}, {"tip_z", "mm", tip.z / mm}});
  return out;
}

std::string check(const PointCall<double>& call) {
  for (int i = 0; i < sphere_calibration::conditions; ++i)
    if (!std::isfinite(call.conditions[i])) return "a condition is not finite";
  if (call.evaluation == sphere_calibration::closed_form && !sphere_calibration::has_closed_form(call.conditions))
    return "closed_form holds at B = 0 (pattern 1) or at C = 90 deg (pattern 2) only";
  if (call.evaluation == sphere_calibration::closed_form && !call.active.empty()) return "closed_form has no place for effects";
  if (call.conditions[sphere_calibration::feed] < 0) return "feed is negative";
  for (const auto& [name, value] : {std::pair{"B_direction", call.conditions[sphere_calibration::B_direction]},
                                    {"C_direction", call.conditions[sphere_calibration::C_direction]}})
    if (value != 1 && value != -1 && value != 0) return std::string(name) + " is none of 1, -1, 0";
  for (const auto& [name, value] :
       {std::pair{"B_clamped", call.conditions[sphere_calibration::B_clamped]}, {"C_clamped", call.conditions[sphere_calibration::C_clamped]}})
    if (value != 1 && value != 0) return std::string(name) + " is neither 0 nor 1";
  return {};
}

/// There is no solve to share.
bool solve_reads(std::size_t) { return true; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(sphere_calibration); }

} // namespace

namespace sphere_calibration {
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
                               nullptr,
                               &sphere_calibration::check_readings,
                               &sphere_calibration::remarks};

} // namespace sphere_calibration
} // namespace gumshoe::models
