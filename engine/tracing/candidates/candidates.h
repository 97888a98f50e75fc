#pragma once
/// Candidates for what the model lacks: effects at null, shifted declared quantities, effects stated as formulas.
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

enum class Family {
  effect,   ///< an effect of the catalogue, at null in the scenario
  declared, ///< a quantity that is not what was declared
  stated,   ///< a formula stated by the user
  shape,    ///< polynomial, harmonic, step, ...: a description without a cause
  omnibus,  ///< any dependence on one or two conditions
};
const char* name(Family family);

/// The quantity of the extended scenario that an amplitude changes, and the readings at which it does.
struct Amplitude {
  std::size_t quantity = 0; ///< npos: the amplitude of a shape, which is not a quantity
  std::string name, unit, si_unit, scenario_name;
  std::vector<std::pair<std::string, std::string>> labels; ///< only where readings have these
  double low = -1e300, high = 1e300;                       ///< limits of its card, SI
  /// Ends of the card's typical magnitude, SI, 0: not stated; and whether a negative size is no such effect's.
  double typical = 0, least_typical = 0;
  bool positive = false;
  double declared = 0; ///< standard uncertainty declared for a quantity that may be shifted, SI
  /// A shape parameter that is fitted: its size is the shift from `held`, and zero is no null.
  bool is_shape = false;
  double held = 0;
  static constexpr std::size_t npos = ~std::size_t{0};

  /// Whether a size lies far above the card's typical ones, or has a sign that no such effect has.
  bool far_too_large(double size) const;
  bool of_wrong_sign(double size) const { return positive && size < 0; }
  /// Whether a fitted size ended at a limit of the card.
  bool at_limit(double size) const { return size == low || size == high; }
};

/// One signature that is tried.
/// A shape of one unknown parameter, over the range of what it runs along: the cycles of a wave, the logarithm of the
/// time constant of a drift that levels off, or of a condition that acts late.
enum class Form { fixed, wave, drift, lag };

struct Candidate {
  std::string name;  ///< "trigger_latency", "rod_runout[rod 2]", "declared:rod_length[rod 2]", "polynomial:feed^2"
  std::string shape; ///< shape parameters held fixed, in words; or "at +5 um" for a signature taken over a finite step
  Family family = Family::effect;
  Matrix columns; ///< rows in the order of measurement x amplitudes, per SI unit of each
  std::vector<Amplitude> amplitudes;
  std::vector<std::pair<std::size_t, double>> held; ///< shape quantities, SI
  std::vector<std::string> depends_on;
  double finite = 0; ///< size over which the signature was taken; 0: the derivative
  /// Where readings jump: the sizes of all amplitudes, SI, over which its one column was taken, and from which the
  /// whole model is fitted. Empty: readings do not jump, or it is the derivative.
  std::vector<double> start;
  Matrix tried;           ///< amplitudes x sizes from which that was sought
  double exact_ratio = 0; ///< 2 ln L of these sizes over none, by the exact model
  Form form = Form::fixed;
  double parameter = 0, parameter_u = 0; ///< of its form, and the standard uncertainty
  double size_u = 0;                     ///< of a single size, whatever the parameter is; 0: not known
  double searched = 1;                   ///< independent forms of which this is the best; the p-value counts as often
  /// An effect at some of the readings only: of one rod, of one set-up.
  bool in_part() const { return family == Family::effect && rare(); }
  /// Whether it acts on some of the readings only, and is therefore one of many.
  bool rare() const { return !amplitudes[0].labels.empty(); }
  bool physical() const { return family == Family::effect || family == Family::declared || family == Family::stated; }
};

/// The sizes that explain the readings best where readings jump with them.
struct Start {
  Vector sizes;     ///< by amplitude, SI
  double ratio = 0; ///< 2 ln L over none, by the exact model
  double tries = 1; ///< as how many independent sizes all that were tried count
};
/// Tries sizes, each column a set of the candidate's amplitudes `step` from its neighbours, by the exact model, and
/// others between the best.
using BestStart = std::function<std::optional<Start>(const Candidate&, const Matrix& sizes, double step)>;

/// Signatures of all physical candidates at a point, from exact derivatives and, where the model is not linear, also
/// over finite steps.
/// @param step  change of the indications by a finite step, SI
/// @param skip  true for candidates that are terms already
/// @param choose  where readings jump with a size; empty: no sizes are tried there
std::vector<Candidate> physical_candidates(const propagation::Experiment& experiment, const Simulator& simulator,
                                           const Points& at, const Observations& observations, double step,
                                           const std::function<bool(const Candidate&)>& skip,
                                           const BestStart& choose = {});

/// A candidate with the shape parameters of its effect among those that are held, at their values at a point.
Candidate with_held_shape(const Candidate& candidate, const propagation::Experiment& experiment, const Points& at);
/// A candidate whose shape parameters are sizes, too, from the values at which they were held.
Candidate with_free_shape(const Candidate& candidate, const propagation::Experiment& experiment);

/// Labels that name a part: a rod, a tool. Blocks and acts done anew are no parts, as what they leave behind scatters.
std::vector<const Grouping*> part_labels(const Observations& observations);

/// Whether a recorded column has one level of its own in each group of a label, or of a set-up step that was repeated,
/// such as the number of the day: any value at each of its levels is any value of each group, or scatter between them.
bool numbers_groups(const Observations& observations, const Covariate& covariate);

/// "polynomial:t_room" of "polynomial:t_room of z": a shape without the indication that it moves, where there are
/// several.
std::string without_indication(const std::string& name, const Observations& observations);

/// Names of the covariates, else of the labels, on which a signature depends. What those named explain is no dependence
/// on another that happens to go along with them.
std::vector<std::string> dependence(const Observations& observations, const Matrix& columns);

/// The covariates with which the formulas of a stated effect change; empty where one cannot be evaluated elsewhere.
std::vector<std::string> dependence(const Observations& observations, const propagation::Experiment& experiment,
                                    const scenario::StatedEffect& effect);

} // namespace gumshoe::tracing
