#pragma once
/// How long measuring takes: formulas of the expression language, from the model's card or from [choose.time].
#include "formula/compile.h"
#include "scenario/choose_options.h"
#include "scenario/context.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// The formulas of one evaluation, compiled. Names in them: the model's conditions and quantities (those of effects
/// have no name here), its timing constants, constants of [choose.time], and `readings`.
class TimeModel {
public:
  /// Seconds of a setting: `once`, at the first reading, and `per_reading` for every readout of every reading.
  /// `quantities[reading]`: values by position in the scenario. NaN or infinite where a formula has no value.
  double seconds(const std::vector<quantities::Reading>& readings,
                 const std::vector<std::vector<double>>& quantities) const;
  /// Its formulas, and the constants in them: "per_reading = 2 * t, once = 10 s; t 1 s".
  const std::string& text() const { return text_; }

private:
  friend class TimeReader;
  double value(std::size_t formula, const std::vector<double>& quantities, const quantities::Reading& reading,
               std::size_t readings) const;
  formula::Compiled formulas_;
  std::vector<std::size_t> quantities_; ///< positions of those that formulas can name
  std::vector<double> constants_;       ///< SI, after them
  int per_reading_ = -1, once_ = -1;    ///< of the formulas; -1: none
  std::string text_;
};

Shape time_shape();

/// [choose.time]: per_reading, once and constants; what it does not say is the card's. Problems: no formula for an
/// evaluation that is asked for; a formula that is no time; located at the character.
std::vector<std::shared_ptr<const TimeModel>> read_time(std::optional<Table> table, const Node& choose,
                                                        const ModelCard& model, const std::vector<bool>& asked,
                                                        Context& context);

} // namespace gumshoe::scenario
