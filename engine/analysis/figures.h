#pragma once
/// Any single figure of a result by its name, for comparison with published ones.
#include <string>
#include <vector>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// A number with its Monte Carlo standard error (0 where none is involved), SI; or a word (a verdict, "none").
struct Figure {
  double value = 0, standard_error = 0;
  std::string unit, si_unit; ///< as people read it, and inside
  bool difference = true;    ///< converts by scale alone (an uncertainty), not as a point on a scale
  std::string word;          ///< not empty: the figure is a word
};

/// "second[x1, x3]" -> second, {x1, x3}. Arguments may hold brackets themselves: beam_pitch[setup 1].
struct FigureName {
  std::string word;
  std::vector<std::string> arguments;
};
/// Splits at brackets and commas; does not know which figures exist.
FigureName parse_figure(const std::string& text);

/// The figure of an output by its name: that of a field (result_fields.h; the tables in engine/store/README.md list them),
/// of an input, a component or a quantity `x` with its name as argument: first[x], gum.contribution[x], target.allowed[x],
/// second[x, y]. Computed from several fields:
///   symmetric_length, shortest_length, trials, gum.low, gum.high, gum.degrees_of_freedom ("refused", "infinite"),
///   joint.correlation[a, b], joint.gum_correlation[a, b] of measurands a and b, conformity.decision.
/// `output` is the position of the output among Results::summaries. Throws InputError for a name that is none, or a
/// study that the scenario does not ask for.
Figure figure(const Results& results, std::size_t output, const std::string& name);

} // namespace gumshoe::analysis
