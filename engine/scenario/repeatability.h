#pragma once
/// How an indication scatters from indication to indication: by its own repeats, as declared, or pooled over all cells.
#include "base/card.h"
#include "scenario/readouts.h"

namespace gumshoe::scenario {

struct Scatter {
  double s = 0;                  ///< experimental standard deviation of one indication, SI
  double degrees_of_freedom = 0; ///< 0 means infinite
};

struct Repeatability {
  enum class Kind { none, readings, declared } kind = Kind::none;
  Scatter scatter;     ///< declared or pooled; degrees_of_freedom 0 means infinite
  bool pooled = false; ///< from the data, not declared
  char evaluation = 'A';
  std::string source;
};

/// The key "repeatability" of an indication.
Key repeatability_key();
Repeatability read_repeatability(Table& table, const VariableCard& card, const IndicationReadouts& readouts,
                                 Context& context);

/// Sum of squared deviations from the mean.
double sum_of_squares(const std::vector<double>& x);
/// Pooled experimental standard deviation: s^2 = sum of squares / sum of (n_i - 1), GUM 4.2.4.
Scatter pooled_scatter(const std::vector<Readouts>& cells);
/// A scatter in the indication's unit; lengths in um.
std::string shown_scatter(double value, const VariableCard& card);

} // namespace gumshoe::scenario
