#pragma once
/// A scenario: what is measured and what is known of each input quantity. A plain value, validated.
#include <cstdint>
#include <string>
#include <vector>

#include "base/card.h"
#include "quantities/input_quantity.h"

namespace gumshoe::scenario {

enum class Method {
  propagation,        ///< propagation of distributions, JCGM 101
  virtual_experiment, ///< draw the truth, simulate, evaluate: distribution of the error
};
enum class Design { monte_carlo, latin_hypercube, sobol };
/// As written in a scenario.
constexpr const char* name(Method m) { return m == Method::propagation ? "propagation" : "virtual_experiment"; }
constexpr const char* name(Design d) {
  return d == Design::monte_carlo ? "monte_carlo" : d == Design::latin_hypercube ? "latin_hypercube" : "sobol";
}

struct RunOptions {
  std::uint64_t samples = 1'000'000;
  std::uint64_t seed = 1;
  Design design = Design::monte_carlo;
  double max_failed_share = 0.01;
  bool store_samples = true;
};

/// d = a - b between the readings of two label values, E_n = d / U(d) from joint samples.
struct Comparison {
  std::string measurand;
  std::string between; ///< label compared, e.g. "rod"
  std::string within;  ///< label held fixed, e.g. "setup"; may be empty
};

/// A printed figure shown beside ours, e.g. from the paper that reported the readings.
struct Printed {
  std::string measurand;
  quantities::Labels labels;
  double value = 0; ///< SI
  std::string source;
};

struct AnalysisOptions {
  double coverage_probability = 0.95;
  int validation_digits = 2;       ///< n_dig of JCGM 101 8.1
  std::uint64_t sobol_samples = 0; ///< base size N of the pick-freeze design; 0: no Sobol' indices
  std::vector<Comparison> comparisons;
  std::vector<Printed> printed;
};

struct Scenario {
  std::string file;
  std::string text; ///< as read, kept in the result
  std::string hash; ///< 16 hex digits over everything that fixes the numbers: the text and the data files
  std::string title;
  std::string model;
  Method method = Method::propagation;
  std::string evaluation; ///< one of the model's evaluations
  /// Every quantity of the model in card order (defaults filled in), then the freed quantities of
  /// effects ("effect.quantity", catalogue order, each with all quantities of its effect), then the
  /// indications' noise.
  std::vector<quantities::InputQuantity> quantities;
  std::vector<quantities::Correlation> correlations;
  std::vector<quantities::Reading> readings; ///< at least one
  RunOptions run;
  AnalysisOptions analysis;
  std::vector<std::string>
      notes; ///< decisions and warnings a reader must see ("resolution used, not repeatability: ...")
};

/// What a parser must know of models and effects; handed in, since this layer lies beside them.
struct Catalogue {
  std::vector<const ModelCard*> models;
  std::vector<const EffectCard*> effects; ///< in the order in which they act
  /// Effects that a model's stages can carry.
  bool (*applies)(const ModelCard& model, const EffectCard& effect) = nullptr;
};

/// Reads and validates a file. Throws InputError with every problem found, located.
Scenario read(const std::string& path, const Catalogue& catalogue);

/// The scenario as understood, in SI, with every default: what `gumshoe check --explain` prints.
std::string explain(const Scenario& scenario, const Catalogue& catalogue);

} // namespace gumshoe::scenario
