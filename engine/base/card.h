#pragma once
/// Cards: what models and effects say of themselves. Everything shown by `gumshoe models` and
/// `gumshoe effects`, checked by the scenario parser, and written into result files comes from here.
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace gumshoe {

/// The values a quantity may take, SI; an open end excludes the limit itself. Limits refuse, never truncate.
struct Limits {
  double low;
  double high;
  bool low_open = false;
  bool high_open = false;
  constexpr bool contain(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};

/// Stages of the measuring chain, in the order in which effects act. A model has some of them.
enum class Stage {
  standing,
  pose,
  insert,
  spindle,
  motion,
  timing,
  scanning,
  rotary,
  slides,
  slide_directions,
  axis,
  surface,
  sensor,
  contouring,
  bar,
  contact,
  trigger,
};
struct StageRow {
  Stage stage;
  std::string_view name; ///< in files and to people
  std::string_view meaning;
};
inline constexpr StageRow stage_table[] = {
    {Stage::standing, "standing", "a tool that stands still in the spindle"},
    {Stage::pose, "pose", "place and length of the tool"},
    {Stage::insert, "insert", "each insert of a turning tool, and how the tool sits"},
    {Stage::spindle, "spindle", "speed and axial place of a turning spindle"},
    {Stage::motion, "motion", "the slide Z"},
    {Stage::timing, "timing", "from the start of the feed to the latch, with a turning tool"},
    {Stage::scanning, "scanning", "the moment at which a scanner reads its sensor, and that at which it reads its axes"},
    {Stage::rotary, "rotary", "the rotary axes B and C"},
    {Stage::slides, "slides", "the slides X, Y and Z where all three are read"},
    {Stage::slide_directions, "slide_directions", "the slides X and Y where it is known from which side each came"},
    {Stage::axis, "axis", "one linear axis that a reference measures"},
    {Stage::surface, "surface", "the form of the surface that a beam meets"},
    {Stage::sensor, "sensor", "a displacement sensor"},
    {Stage::contouring, "contouring", "slides that follow a contour"},
    {Stage::bar, "bar", "the length of a ball bar as it is read"},
    {Stage::contact, "contact", "a probe's tip, from contact to trigger"},
    {Stage::trigger, "trigger", "delay from the trigger to the latch"},
};
constexpr std::string_view name(Stage stage) { return stage_table[static_cast<std::size_t>(stage)].name; }

/// What tracing may do with a quantity of an effect.
enum class Role {
  plain,     ///< a quantity of a model
  amplitude, ///< an effect's size: has a null value at which it changes nothing
  shape,     ///< a time constant, a phase: profiled over a grid, no derivative at amplitude zero
  pair,      ///< one of two components (x, y) of a vector amplitude
};

/// Magnitudes found on machines, SI, 0 <= low <= high; high = 0: not known.
struct Typical {
  double low = 0;
  double high = 0;
  std::string_view note = {}; ///< what it means in a case, or where it comes from
  bool positive = false;      ///< a negative one is not physical, whatever `limits` let a fit try
};

struct QuantityCard {
  std::string_view name;     ///< public interface: "rod_radius"
  std::string_view unit;     ///< shown to people: "mm"
  std::string_view si_unit;  ///< used inside: "m"
  double default_value = 0;  ///< SI; for an effect its null value
  Limits limits;             ///< SI
  std::string_view symbol{}; ///< of the source: "R_r"
  std::string_view meaning{};
  Role role = Role::plain;
  Typical typical = {};
};

/// A condition (commanded, exact), an indication or a measurand.
struct VariableCard {
  std::string_view name;
  std::string_view unit;
  std::string_view si_unit;
  double default_value;
  std::string_view meaning;
  bool diagnostic = false; ///< of a measurand: it says how the evaluation went, such as a count; no uncertainty is asked of it
};

/// A measurement equation as people read it, in the language of formulas with `=`; a function stands for what the model
/// solves, `norm`, `sum` and an index (`x_i`) for what they say. The report typesets it.
struct EquationCard {
  std::string_view text;
  std::string_view where = {}; ///< what its own symbols mean
};

/// Another way to evaluate the measurands; the first one of a model is the default.
struct EvaluationCard {
  std::string_view name;
  std::string_view meaning;
  /// Measurands of a *joint* evaluation, which uses all readings together and yields these once. Empty: the model's
  /// measurands, at each reading.
  std::span<const VariableCard> measurands = {};
  /// Measuring time, for `gumshoe choose`: formulas of the expression language with the conditions, the quantities and
  /// ModelCard::timing; per reading, and once.
  std::string_view time_per_reading = {};
  std::string_view time_once = {};
  std::span<const EquationCard> equations = {};
  constexpr bool joint() const { return !measurands.empty(); }
};

/// An axis of the machine on which the model measures, from the bed outwards.
struct AxisCard {
  std::string_view name;
  bool carries_workpiece; ///< else the tool
  bool rotary;
  int direction;               ///< 0, 1, 2: moves along, or turns about, X, Y, Z
  std::array<double, 3> point; ///< a design point on a rotary axis, m
};

struct ModelCard {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  std::string_view source;
  std::span<const QuantityCard> quantities;
  std::span<const VariableCard> conditions;
  std::span<const VariableCard> indications;
  std::span<const VariableCard> measurands;
  std::span<const EvaluationCard> evaluations;
  std::span<const Stage> stages;             ///< stages of the measuring chain; only their effects apply
  std::span<const QuantityCard> timing = {}; ///< further inputs of the measuring time: rapid feed, orientation time
  std::span<const AxisCard> axes = {};       ///< of the machine, if the model moves one
};

struct EffectCard {
  std::string_view name;
  std::string_view title;
  Stage stage;
  std::string_view iso230 = {}; ///< ISO 230-1/-7 symbol where there is one
  std::string_view meaning;
  std::string_view adds; ///< to which fields of the event, as a formula: "latch_delay += delay"
  std::string_view confused_with;
  std::string_view source;
  std::span<const QuantityCard> quantities;
  /// Its first quantity takes another value at every clamping of the tool: a scatter by clampings is this quantity's.
  bool scatters_between_clampings = false;
  /// Where readings have a derivative by its amplitudes they follow it over the whole typical range, without jumps.
  bool follows_derivative = false;
  /// Readings move in steps: the derivatives are those of their mean, which no difference of two readings shows.
  bool moves_in_steps = false;
};

} // namespace gumshoe
