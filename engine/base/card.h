#pragma once
/// Cards: what models and effects say of themselves. Everything shown by `gumshoe models` and
/// `gumshoe effects`, checked by the scenario parser, and written into result files comes from here.
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

/// What tracing may do with a quantity of an effect.
enum class Role {
  plain,     ///< a quantity of a model
  amplitude, ///< an effect's size: has a null value at which it changes nothing
  shape,     ///< a time constant, a phase: profiled over a grid, no derivative at amplitude zero
  pair,      ///< one of two components (x, y) of a vector amplitude
};

struct QuantityCard {
  std::string_view name;    ///< public interface: "rod_radius"
  std::string_view unit;    ///< shown to people: "mm"
  std::string_view si_unit; ///< used inside: "m"
  double default_value;     ///< SI; for an effect its null value
  Limits limits;            ///< SI
  std::string_view symbol;  ///< of the source: "R_r"
  std::string_view meaning;
  Role role = Role::plain;
  std::string_view typical = {}; ///< typical magnitude, in words: "0.1-5 ms"
};

/// A condition (commanded, exact), an indication or a measurand.
struct VariableCard {
  std::string_view name;
  std::string_view unit;
  std::string_view si_unit;
  double default_value;
  std::string_view meaning;
};

/// Another way to evaluate the measurands; the first one of a model is the default.
struct EvaluationCard {
  std::string_view name;
  std::string_view meaning;
  /// Of a *joint* evaluation, which uses all readings together and yields these once. Empty: the model's measurands at
  /// each reading.
  std::span<const VariableCard> measurands = {};
  /// How long measuring takes so, for `gumshoe choose`: formulas of the expression language over the conditions, the
  /// quantities and ModelCard::timing; of every reading, and once.
  std::string_view time_per_reading = {};
  std::string_view time_once = {};
  constexpr bool joint() const { return !measurands.empty(); }
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
  std::span<const std::string_view> stages;  ///< of the measuring chain that the model has: effects acting there apply
  std::span<const QuantityCard> timing = {}; ///< what else the duration depends on: rapid feed, orientation time
};

struct EffectCard {
  std::string_view name;
  std::string_view title;
  std::string_view stage;  ///< motion, pose, contact, trigger or reading
  int rank;                ///< order within the stage (scale before rounding does not commute)
  std::string_view iso230; ///< ISO 230-1/-7 symbol where there is one
  std::string_view meaning;
  std::string_view confused_with;
  std::string_view source;
  std::span<const QuantityCard> quantities;
};

} // namespace gumshoe
