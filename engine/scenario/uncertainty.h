#pragma once
/// Reads one component of uncertainty: a distribution with its parameters, `u`, `U` with `k`, or
/// observations.
#include <optional>
#include <string>

#include "scenario/context.h"

namespace gumshoe::scenario {

struct Uncertainty {
  quantities::Component component; ///< a deviation
  double value = 0;                ///< what the deviation is from
  bool exact = false;              ///< no uncertainty in fact (equal observations): nothing to draw
};

/// How the parameters of a component stand in the file.
struct Form {
  std::string si_unit;
  bool absolute = false;       ///< locations are values of the quantity, not deviations
  std::optional<double> value; ///< `value`, where it was given
  double fallback = 0;         ///< the value otherwise, for families that need one
  std::optional<double> reference = {};  ///< to which a relative uncertainty refers: the quantity's stated value
  const Node* reference_node = nullptr; ///< where that is written
};

/// The keys that read_uncertainty() may ask for, by what the distribution needs.
std::vector<Key> uncertainty_keys();
/// Members of the schema of a table with these keys: U and k stand together.
extern const char* const uncertainty_rules;

/// Reads distribution, parameters, evaluation, degrees_of_freedom, per and source from the table;
/// nullopt and problems if something is wrong. Does not call refuse_unknown().
///
/// Absolute forms become a value and a deviation around it: rectangular(low, high) has the value
/// (low + high)/2, a truncated normal the mean that is left after truncation. Exponential, gamma,
/// lognormal, discrete and empirical keep their distribution and the value 0, or `value` if given.
std::optional<Uncertainty> read_uncertainty(Table& table, const Form& form, Context& context);

/// Degrees of freedom that a t distribution can be drawn with: what the schema says of the key, and its reader.
Shape degrees_of_freedom_shape();
std::optional<double> read_degrees_of_freedom(Table& table);

} // namespace gumshoe::scenario
