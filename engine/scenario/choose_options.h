#pragma once
/// What [choose] asks: which settings measure within a target expanded uncertainty in the least time?
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gumshoe::scenario {

class TimeModel;

/// What a setting can fix: a condition of all readings, the value of a quantity, how many readings, the evaluation.
struct Knob {
  enum class Kind { condition, quantity, readings, evaluation };
  Kind kind = Kind::condition;
  std::string name;
  std::size_t index = 0; ///< of the condition in the model's card, of the quantity in the scenario
  std::string unit = "1", si_unit = "1";
};

/// A knob's value: SI; a number of readings; of an evaluation its position in the model's card.
struct Setting {
  Knob knob;
  double value = 0;
};

/// A knob that the choice turns.
struct Variable {
  Knob knob;
  std::vector<double> values; ///< as Setting::value; for a range the coarse grid, ascending
  bool range = false;         ///< other values lie between these
  int steps = 0;              ///< number of values of a range's coarse grid, ends included
  bool logarithmic = false;   ///< the values of a range are evenly spaced on a logarithmic scale

  /// Value of a range at i of n equal parts on its scale.
  double at(int i, int n) const {
    const double low = values.front(), high = values.back(), t = static_cast<double>(i) / n;
    const double x = i == n ? high : logarithmic ? low * std::pow(high / low, t) : low + (high - low) * t;
    return knob.kind == Knob::Kind::readings ? std::round(x) : x;
  }
};

/// Quantities with these true values, known to nobody: what the evaluation takes stays as the scenario says.
struct ChooseCase {
  std::string name, source;
  std::vector<Setting> values;
};

/// A setting shown next to the recommended one; knobs that it does not name are as in the scenario.
struct ChooseCompare {
  std::string name, source;
  std::vector<Setting> settings;
};

struct Choose {
  enum class Definition {
    corrected,  ///< the mean error is added as a correction; U is half the interval about the corrected result
    uncorrected ///< U is the quantile of the error's magnitude
  };
  std::string measurand;
  std::string unit;           ///< in which the target is stated
  double target = 0;          ///< expanded uncertainty, SI
  bool worst_case = false;    ///< asked of the worst case; else of the average
  std::optional<double> bias; ///< limit of the mean error's magnitude, SI
  Definition definition = Definition::corrected;
  std::vector<Variable> variables; ///< at least one
  std::vector<ChooseCase> cases;
  std::vector<ChooseCompare> compare;
  std::uint64_t samples = 4'000; ///< of a candidate
  std::uint64_t confirm_samples = 100'000;
  double confirm_probability = 0.95; ///< of meeting the target, for a recommendation
  int refinements = 5;               ///< each halves the steps of the ranges
  double near = 0.1;                 ///< share of the time, or of U, within which settings count as near
  std::uint64_t sobol = 1024;        ///< rows of the design for the budget at the optimum
  /// By position of the evaluation in the model's card; null: not asked for.
  std::vector<std::shared_ptr<const TimeModel>> time;
};
constexpr const char* name(Choose::Definition d) {
  return d == Choose::Definition::corrected ? "corrected" : "uncorrected";
}

} // namespace gumshoe::scenario
