#pragma once
/// Input quantities (JCGM 200, 2.50) as a scenario states them: values, components of uncertainty,
/// scopes and correlations. Plain data, SI units; quantities of models, of effects and the noise of
/// indications are the same kind of thing.
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "quantities/distribution.h"

namespace gumshoe::quantities {

/// Label values, e.g. {{"rod", "rod 2"}, {"setup", "1"}}.
using Labels = std::vector<std::pair<std::string, std::string>>;

/// An output of an earlier run.
struct Earlier {
  std::string file, output;      ///< the file as found from the current directory
  std::vector<std::string> same; ///< quantities of its budget whose errors others have too
};

/// One source of uncertainty: a deviation added to the quantity's value.
struct Component {
  std::string name;          ///< unique within the quantity; part of the random stream's key
  Distribution distribution; ///< of the deviation, SI
  char evaluation = 'B';     ///< Type A or Type B evaluation (GUM 2.3.2, 2.3.3)
  /// Degrees of freedom of the standard uncertainty; infinite unless stated. Used for the effective degrees of freedom.
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
  std::vector<std::string> per; ///< scope: one draw per combination of these labels ("reading": per reading)
  std::string source;
  std::optional<Earlier> earlier = {}; ///< where the distribution is from
  /// Its standard uncertainty comes from one estimate in all entries of the quantity that have a component of this
  /// name.
  bool common = false;
};

/// A value, and components, that hold for the given label values (all readings if `labels` is empty).
struct Entry {
  Labels labels;
  double value = 0;
  std::vector<Component> components;
  std::string source;
};

struct InputQuantity {
  std::string name; ///< "fillet_radius", "trigger_latency.delay", indication noise: "spindle_z"
  std::string unit; ///< shown to people
  std::string si_unit;
  std::vector<Entry> entries; ///< at least one; several only with different labels (`by`)
  bool estimated = false;     ///< to be fitted to the readings: values are starts, components priors
  double display_alone = 0; ///< of an indication: the step of its display, SI, if no more is stated of single readings
};

/// Correlation between single-component quantities: through a Gaussian copula, or as a multivariate t distribution of
/// estimates that share one estimated standard deviation (JCGM 102, 5.3.2), all with its degrees of freedom; the matrix
/// is then that of the scales.
struct Correlation {
  enum class Kind { copula, pearson, spearman, multivariate_t };
  Kind kind = Kind::copula;
  std::vector<std::string> quantities; ///< names, or "quantity.component"
  std::vector<double> matrix;          ///< row-major, n x n, of the stated kind
  /// Samples drawn together in an earlier run, which keep their joint distribution: of each quantity, whose
  /// distribution is empirical, the rank of its value in each of them. Empty: tied by the matrix alone.
  std::vector<std::vector<std::uint32_t>> together = {};
  /// Coefficients that the law of propagation takes, row-major, n x n. Empty: Pearson's of the draws.
  std::vector<double> law = {};
};

/// One reading: the mean of `repeats` readouts taken under the same labels and conditions.
struct Reading {
  Labels labels;
  std::vector<double> conditions;  ///< by position in the model's card, SI
  std::vector<double> indications; ///< means, by position in the model's card, SI; empty if nothing was read
  int repeats = 1;
  std::vector<double> scatter = {}; ///< sums of squares of the readouts about their mean, by indication, SI
};

} // namespace gumshoe::quantities
