#pragma once
/// A scenario: what is measured and what is known of each input quantity. A plain value, validated.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/card.h"
#include "base/error.h"
#include "math/least_squares.h"
#include "models/model.h"
#include "quantities/input_quantity.h"
#include "scenario/earlier.h"
#include "scenario/choose_options.h"
#include "scenario/trace_options.h"

namespace gumshoe::scenario {

struct Plan;

enum class Method {
  propagation,        ///< propagation of distributions, JCGM 101
  virtual_experiment, ///< draw the truth, simulate, evaluate: distribution of the error
  prediction,         ///< draw the quantities, simulate: distribution of the readings, before they are taken
};
enum class Design { monte_carlo, latin_hypercube, sobol };
/// How many samples: as many as asked for, or until the results are known to a number of digits.
enum class StoppingRule {
  fixed,
  jcgm_101, ///< JCGM 101 7.9, as printed
  stein,    ///< two stages: Wuebbeler, Harris, Cox, Elster 2010
};
/// As written in a scenario.
constexpr const char* name(Method m) {
  return m == Method::propagation ? "propagation" : m == Method::prediction ? "prediction" : "virtual_experiment";
}
constexpr const char* name(StoppingRule r) {
  return r == StoppingRule::fixed ? "fixed" : r == StoppingRule::jcgm_101 ? "jcgm_101" : "stein";
}
constexpr const char* name(Design d) {
  return d == Design::monte_carlo ? "monte_carlo" : d == Design::latin_hypercube ? "latin_hypercube" : "sobol";
}

struct Adaptive {
  StoppingRule rule = StoppingRule::fixed;
  int digits = 2;                   ///< n_dig, significant digits of u regarded as meaningful
  std::uint64_t most = 100'000'000; ///< samples; the rule gives up there and says so
  bool validation = false;          ///< aim at a fifth of the tolerance, which clause 8 of JCGM 101 needs
};

struct RunOptions {
  std::uint64_t samples = 1'000'000;
  std::uint64_t seed = 1;
  Design design = Design::monte_carlo;
  double max_failed_share = 0.01;
  bool store_samples = true;
  bool store_inputs = false; ///< the drawn values of the input quantities, too
  Adaptive adaptive;
};

/// d = a - b between the readings of two label values, E_n = d / U(d) from joint samples.
struct Comparison {
  std::string measurand;
  std::string between; ///< label compared, e.g. "rod"
  std::string within;  ///< label held fixed, e.g. "setup"; may be empty
};

/// A published figure shown next to the computed one, e.g. from the paper that reported the readings.
struct Printed {
  std::string measurand;
  quantities::Labels labels;
  double value = 0; ///< SI
  std::string source;
};

struct SensitivityOptions {
  std::uint64_t sobol = 0;      ///< base size N of the pick-freeze design; 0: none
  bool second_order = false;    ///< second-order Sobol' indices too
  bool by_quantity = false;     ///< Sobol' indices of quantities, all draws of one together
  std::uint64_t shapley = 0;    ///< rows of the Shapley design; 0: none
  std::uint64_t given_data = 0; ///< stored samples to compute given-data indices from; 0: none
  std::uint64_t morris = 0;     ///< trajectories; 0: no screening
  std::uint64_t dgsm = 0;       ///< points of the derivative-based measures; 0: none
};

/// Every named quantity in turn is moved by its step, up and down, the others at their estimates.
struct OneAtATime {
  struct Step {
    std::string quantity;
    double step = 0; ///< SI
  };
  std::string title;
  std::vector<Step> steps;
};

/// Does a measurand conform to its limits? JCGM 106.
/// Decision rules by name; each fixes the guard band w (JCGM 106 clause 8).
enum class DecisionRule {
  stated,            ///< by guard_band and guard_factor; w = 0 without them
  simple_acceptance, ///< w = 0: shared risk
  iso_14253_1,       ///< the guard band at which the specific risk at an acceptance limit is 5 %
  ilac_g8,           ///< w = U
};
constexpr const char* name(DecisionRule r) {
  return r == DecisionRule::simple_acceptance ? "simple_acceptance"
         : r == DecisionRule::iso_14253_1     ? "iso_14253_1"
         : r == DecisionRule::ilac_g8         ? "ilac_g8"
                                              : "stated";
}

struct ConformityTest {
  std::string measurand;
  quantities::Labels labels;
  std::optional<double> lower, upper; ///< tolerance limits, SI; at least one
  double guard_band = 0;              ///< w, SI; the acceptance limits lie this far inside
  double guard_factor = 0;            ///< r of w = r U, added to guard_band
  DecisionRule rule = DecisionRule::stated;
  /// What is known of the measurand before measuring, e.g. of the process that makes the parts: value + deviation.
  std::optional<quantities::Distribution> process;
  double process_value = 0;
};

/// Which standard uncertainties would give this expanded uncertainty?
struct Target {
  std::string measurand;
  quantities::Labels labels;
  double expanded_uncertainty = 0;                   ///< SI
  std::vector<std::pair<std::string, double>> costs; ///< of a quantity at its present u; at u / 2 twice that
};

struct AnalysisOptions {
  double coverage_probability = 0.95;
  int validation_digits = 2; ///< n_dig of JCGM 101 8.1
  std::vector<std::string> measurands; ///< those printed and reported; empty: all
  SensitivityOptions sensitivity;
  std::vector<OneAtATime> one_at_a_time;
  std::vector<ConformityTest> conformity;
  std::vector<Target> targets;
  /// Measurands whose joint coverage regions are wanted; empty: those of each reading, if there are two to eight.
  std::vector<std::vector<std::string>> joint;
  std::vector<Comparison> comparisons;
  std::vector<Printed> printed;
};

/// A published or exact figure to compare ours with: `gumshoe gauge`.
struct Expected {
  std::string figure; ///< as in analysis/figures.h: "standard_uncertainty", "gum.expanded_uncertainty", "first[x1]"
  std::string of;     ///< measurand; empty: the only one
  quantities::Labels labels;
  std::string value; ///< as given, with its unit: the last digit sets the tolerance
  std::string source;
  std::string tolerance, why; ///< instead of half a unit of the last digit; and the reason
  std::string note;           ///< why ours is known to differ: then a difference is a NOTE
  Location where;
};

/// How `gumshoe estimate` fits the quantities marked `estimated`.
struct EstimateOptions {
  least_squares::Loss loss = least_squares::Loss::squared;
  double width = 0;      ///< of the loss, in standard deviations of a residual; 0: the usual one
  int iterations = 2000; ///< of each attempt of the solver
  bool t = true;         ///< posterior as t where the noise is estimated: as normal otherwise
};

/// A condition that goes evenly from `first`, to `last` excluded, over the readings.
struct Spread {
  std::size_t condition; ///< by position in the model's card
  double first, last;    ///< SI
};

struct Scenario {
  std::string file;
  std::string text; ///< as read, kept in the result
  std::string data; ///< file that stands for every data file of readings (Overrides); empty: those of the scenario
  std::string hash; ///< 16 hex digits over everything that fixes the numbers: the text and the data files
  std::string title;
  std::string model;
  models::MadeModel made; ///< the model itself, if the scenario describes it; null: one of the catalogue
  std::string external;   ///< code that it names, with a hash of its files: "model.command python3 m.py 0123..."
  Method method = Method::propagation;
  std::string evaluation; ///< one of the model's evaluations
  /// Every quantity of the model in card order (defaults filled in), then the freed quantities of
  /// effects ("effect.quantity", catalogue order, each with all quantities of its effect), then the
  /// indications' noise, then the sizes of stated effects ("NAME.size").
  std::vector<quantities::InputQuantity> quantities;
  std::vector<quantities::Correlation> correlations;
  std::vector<quantities::Reading> readings; ///< at least one
  std::vector<Spread> spreads;               ///< of the readings' conditions
  RunOptions run;
  AnalysisOptions analysis;
  std::vector<Expected> expected;
  EstimateOptions estimate;
  std::optional<Choose> choose;
  std::shared_ptr<const Plan> plan; ///< [plan] (plan_options.h); null: none
  std::vector<StatedEffect> stated_effects;
  TraceOptions trace;
  /// True if the evaluation acts on single readings and its result is the mean over all of them (`gumshoe choose`).
  bool mean_of_readings = false;
  /// By place of a column of clock times, such as "data.conditions.time": its earliest, from which seconds count where
  /// the scenario does not say from when.
  std::map<std::string, std::string> since;
  std::vector<std::string>
      notes; ///< decisions and warnings a reader must see ("resolution used, not repeatability: ...")
};

/// What a parser must know of models and effects; passed in, because this layer may not include them.
struct Catalogue {
  std::vector<const ModelCard*> models;
  std::vector<const EffectCard*> effects; ///< in the order in which they act
  /// Effects that a model's stages can carry.
  bool (*applies)(const ModelCard& model, const EffectCard& effect) = nullptr;
  /// Whether a scenario file may start a program or load a library; null: any may.
  bool (*trusts)(const std::string& scenario) = nullptr;
  ReadOutput read_output = {}; ///< of earlier results; none: they cannot be read
};

/// The card as an evaluation sees it: with the measurands that the evaluation yields.
ModelCard evaluated_card(const ModelCard& model, const std::string& evaluation);

/// The notes, and those on quantities marked `estimated` that a run, which does not fit them, takes as exact.
std::vector<std::string> notes_of_a_run(const Scenario& scenario);

/// The same scenario, asked for the readings themselves before they are taken, whatever it measures. What [analysis]
/// says of measurands is left out.
void predict_readings(Scenario& scenario);

/// What a command says in place of the scenario.
struct Overrides {
  std::string data = {}; ///< data file of every indication, relative to the current directory; empty: as the scenario says
  /// Scenario::external of a result: other code is not started. Absent: any may be.
  std::optional<std::string> external = {};
};

/// Reads and validates a file. Throws InputError with every problem found, located.
Scenario read(const std::string& path, const Catalogue& catalogue, const Overrides& overrides = {});

/// The scenario as understood, in SI, with every default: what `gumshoe check --explain` prints.
std::string explain(const Scenario& scenario, const Catalogue& catalogue);

} // namespace gumshoe::scenario
