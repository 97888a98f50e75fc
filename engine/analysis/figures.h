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
FigureName parse_figure(const std::string& text);

/// Names, `x` and `y` standing for inputs, `a` and `b` for measurands:
///   estimate, standard_uncertainty, symmetric_low, symmetric_high, symmetric_length, shortest_low, shortest_high,
///   shortest_length, skewness, kurtosis, failed;
///   gum.estimate, gum.standard_uncertainty, gum.expanded_uncertainty, gum.low, gum.high, gum.coverage_factor,
///   gum.degrees_of_freedom, gum.second_order_uncertainty, gum.applicable, gum.contribution[x], gum.sensitivity[x];
///   validation.verdict, validation.d_low, validation.d_high, validation.delta;
///   first[x], total[x], second[x, y], shapley[x], rank_first[x], delta[x], dgsm_bound[x];
///   joint.k_p, joint.k_q, joint.correlation[a, b], joint.gum_correlation[a, b];
///   circular.mean_direction, circular.standard_deviation, circular.resultant_length;
///   conformity.probability, conformity.decision, conformity.specific_consumer_risk,
///   conformity.specific_producer_risk, conformity.global_consumer_risk, conformity.global_producer_risk;
///   target.allowed[x], target.allowed_gum[x], target.cheapest[x]; trials.
/// `output` is the position of the output among Results::summaries. Throws InputError for a name that is none, or a
/// study that the scenario does not ask for.
Figure figure(const Results& results, std::size_t output, const std::string& name);

} // namespace gumshoe::analysis
