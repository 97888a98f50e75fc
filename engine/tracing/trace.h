#pragma once
/// Analyses the residuals of a scenario's model fitted to its readings, and traces them to effects that the scenario
/// holds at null. All values are SI; names and units are those shown to people. Method: README.md.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "calibration/estimate.h"
#include "propagation/experiment.h"
#include "tracing/campaigns/campaign.h"

namespace gumshoe::tracing {

enum class Kind {
  named,             ///< one effect, which beats its rivals
  equivalence_class, ///< effects that these data cannot distinguish
  scatter,           ///< a variance component by label
  not_in_catalogue,  ///< structure that no known effect explains
};
/// "named", "class", "scatter", "not_in_catalogue"
const char* name(Kind kind);

/// Size of an effect, with an interval that allows for the search (README.md) where it is the only one.
struct SizedQuantity {
  std::string name; ///< "delay"; for a declared quantity its name
  std::string unit, si_unit;
  double value = 0, u = 0, low95 = 0, high95 = 0;
  /// Name in a scenario: "trigger_latency.delay", "rod_length"; empty: none (scatter, a shape).
  std::string scenario_name;
  std::vector<std::pair<std::string, std::string>> labels; ///< readings with these labels have it; empty: all
  bool shift = false; ///< true: a difference to what was declared, not a value of the quantity
};

/// A table for plotting: size of an unknown effect against one condition.
struct Curve {
  std::string against, unit, si_unit; ///< condition or column; or a label, then `levels` name the points
  std::vector<std::string> levels;
  std::vector<double> x, y, u; ///< y and u in the indication's unit
  std::string indication, indication_unit, indication_si_unit;
};

/// An unknown effect at each combination of all that it depends on, as a table of compensation needs it.
struct CellTable {
  struct Key {
    std::string name, unit, si_unit; ///< condition or column; or a label, then `levels`
    std::vector<double> x;           ///< by row, SI
    std::vector<std::string> levels; ///< by row
  };
  std::vector<Key> keys;
  std::vector<double> y, u, readings; ///< by row; y and u in the indication's unit
  std::string indication, indication_unit, indication_si_unit;
};

/// A shape that describes the readings as well as the one of a finding does.
struct RivalShape {
  std::string shape;        ///< "step:machine M2", with what was held fixed of it
  bool never_apart = false; ///< it rises and falls with the finding's own in every reading
};

struct Finding {
  Kind kind = Kind::named;
  std::string name; ///< "trigger_latency", "declared:rod_length[rod 2]", "scatter:rod,setup", "not in the catalogue"
  std::vector<std::string> members;    ///< members of a class, the best first; otherwise the effect itself
  double p_value = 1;                  ///< p-value of the largest statistic over all candidates tried
  std::vector<std::string> depends_on; ///< conditions, columns or labels
  std::string suggestion;              ///< the measurement that would distinguish the members
  std::vector<SizedQuantity> quantities;
  /// Sizes for every member of a class, as if it were the cause; the first are `quantities`.
  std::vector<std::vector<SizedQuantity>> alternatives;
  /// Root mean square by which the members' predictions differ over the training data, SI of the first indication.
  double spread = 0;
  /// Share of the training residuals' mean square, as declared, that comes back if this finding alone is left out and
  /// all others are fitted again: it depends on no order.
  double removed_share = 0;
  std::vector<Curve> curves;        ///< curves of an unknown effect
  std::vector<CellTable> tables;    ///< the same by all that it depends on, where this was set again and again
  std::string implausible;          ///< why no such effect has its size: likely an alias of another; or empty
  std::string fits_better;          ///< unknown effect that fits better, as chance could have it; or empty
  std::string described_by;         ///< shape of an unknown effect: "table:position*direction"; else empty
  std::vector<RivalShape> rivals;   ///< of an unknown effect
  std::vector<std::string> remarks; ///< implausible size, kept shapes, also described by ...
  bool by_default = false;          ///< the declared value is the model's, because the scenario states none
};

/// A candidate as the ranking lists it.
struct RankedCandidate {
  std::string name;   ///< "trigger_latency", "declared:rod_length[rod 2]", "polynomial:feed^2"
  std::string shape;  ///< shape parameters held fixed: "time_constant 30 min"
  std::string family; ///< effect, declared, stated, shape, omnibus, scatter
  int parameters = 1;
  double statistic = 0;    ///< likelihood ratio, 2 ln
  double p_single = 1;     ///< p-value if it were the only candidate tried
  double identifiable = 1; ///< share of its signature that the declared model does not absorb
  std::string absorbed_by; ///< estimated or declared quantity that absorbs almost all of it
  double correlation = 0;  ///< correlation of its projected signature with that of the best
  std::string outcome;     ///< "named", "in the class", "refused: ..."
};

/// The smallest size that is detected in nine cases of ten.
struct DetectionLimit {
  std::string effect, quantity, unit, si_unit;
  double value = 0; ///< infinity: not detectable with these data
};

/// Root mean squares of residuals, SI of the first indication. NaN where there is none.
struct Rms {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::string unit, si_unit;
  double before = none, after = none, noise = none; ///< training data, in sample
  double noise_low = none, noise_high = none;       ///< 95 % limits for noise alone
  /// Scatter of readings of equal conditions, free of slow drift (noise/pure_error.h), with 95 % limits; training data.
  double replicate_floor = none, replicate_floor_low = none, replicate_floor_high = none;
  double holdout_before = none, holdout_after = none, holdout_noise = none;
  /// The same, but readings that are bad before and after are cut to 3.5 robust standard deviations.
  double holdout_before_winsorised = none, holdout_after_winsorised = none;
  double holdout_noise_low = none, holdout_noise_high = none;
  double worst_block_before = none, worst_block_after = none; ///< hold-out block with the largest
  std::string worst_block;
  double worst_point_before = none, worst_point_after = none; ///< largest residual of a hold-out reading
  std::string worst_point;
  /// (before^2 - after^2) / (before^2 - floor^2) of the hold-out; the floor is that of replicates, else the declared
  /// noise
  double share_removed = none;
  std::string holdout; ///< the hold-out: "setup 3, 4", "each block left out in turn", "none: one block"
};

/// The root mean squares of one of several indications, SI; degrees of freedom count as in those of all.
struct IndicationError {
  std::string name, unit, si_unit;
  double before = Rms::none, after = Rms::none, holdout_before = Rms::none, holdout_after = Rms::none;
};

/// One reading of one indication.
struct Row {
  std::size_t reading = 0, indication = 0;
  double order = 0;
  std::string block;
  bool held_out = false; ///< "final" in the result file
  double measured = 0;
  double before = 0, after = 0; ///< residuals minus the block offsets; NaN if not scored
  double noise_u = 0;
  double weight = 1; ///< below 1: winsorised
};

/// The noise as fitted.
struct Noise {
  double scale = 1; ///< factor on the declared standard uncertainties; SI where none are declared
  bool declared = true;
  double correlation = 0;   ///< correlation of successive readings in the order of measurement
  std::string scatter;      ///< labels of the variance component in use, or empty
  double scatter_u = 0;     ///< SI
  double chi_squared_p = 1; ///< p-value of the size of the residuals under the declared noise
  int outliers = 0;
};

/// What still comes back with the conditions after everything found, against the scatter of readings of equal
/// conditions.
struct LackOfFit {
  bool found = false;                  ///< more repeats than chance gives, and nothing that was found explains it
  double p_value = Rms::none;          ///< over all tests of the last round; NaN: too few readings repeat
  double size = Rms::none;             ///< root mean square of what repeats, SI of the first indication
  std::vector<std::string> depends_on; ///< conditions, columns, labels or "place in the block"
  int cells = 0;                       ///< sets of equal conditions
  double freedom = 0;                  ///< degrees of freedom of the replicate floor
};

/// A block whose readings scatter about what the other blocks show by more than theirs do.
struct AnomalousBlock {
  std::string name;          ///< "cycle 3"
  double p_value = 1;        ///< over all tests of the last round
  double spread = Rms::none; ///< typical scatter of its readings, SI of the first indication
  double others = Rms::none; ///< the same of the other blocks
};

/// A reading of reduced weight.
struct Outlier {
  std::string reading; ///< "reading 80 (cycle 5, x 350 mm)"
  std::string block, indication, unit, si_unit;
  double residual = 0, weight = 1;
};

/// How one parameter of the estimate enters the traced scenario.
struct Taken {
  bool block_offset = false; ///< offset of a block, or another free unknown: free again in a further trace
  quantities::Labels labels; ///< readings at which the quantity is shifted; empty: all
  std::string source;
  bool fitted = false; ///< also where it is held without an uncertainty: fitted again in a further trace
};

/// A shape that no known effect explains, as a stated effect of the traced scenario: one for each of its sizes, or one
/// with a size for each value of a label.
struct Correction {
  struct Key {
    std::string name, unit, si_unit; ///< condition or column
    std::vector<double> levels;      ///< by row, SI
  };
  std::string name, shape, indication, unit, si_unit, meaning, source; ///< shape: "table:position*direction"
  std::vector<Key> keys;       ///< empty: the size differs by label, and the loading is 1
  std::vector<double> loading; ///< by row
};

/// A declared component of a quantity of the model that readings share: what they say of it.
struct KnownDraw {
  std::string quantity, unit, si_unit;
  quantities::Labels labels; ///< of the entry
  std::size_t component = 0; ///< by position in the entry
  std::string name;          ///< of the component; empty: the entry has one alone
  double value = 0;          ///< of the entry with it, SI
  double u = 0;              ///< SI
};

/// A variance component that the scenario lacks.
struct Addition {
  std::string quantity; ///< "reclamp.shift", or an indication for its noise
  std::string unit, si_unit;
  double u = 0;
  std::vector<std::string> per; ///< none: one draw for each value of `labels`
  std::string source;
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
  quantities::Labels labels = {}; ///< the readings that have it, "*": that have no value of their own; empty: all
  double value = 0;               ///< about which it varies
};

/// A size found where readings jump, and how large, as [trace] jumping states it.
struct JumpingSize {
  std::string quantity, unit, si_unit;
  double size = 0;
};

enum class Outcome { found, nothing_found, insufficient_data };

struct Trace {
  Outcome outcome = Outcome::nothing_found;
  std::vector<Finding> findings;
  double p_anything = 1; ///< p-value of the whole search
  Rms rms;
  std::vector<IndicationError> of_indications; ///< where there are several
  Noise noise;
  LackOfFit lack_of_fit;
  std::vector<AnomalousBlock> anomalous_blocks;
  std::vector<Outlier> outliers; ///< the largest first
  bool capped = false;           ///< true if the search ended at its largest number of findings, with more to be found
  /// True if readings jump with sizes that were tried, and more is left than noise: better sizes may not have been
  /// found.
  bool jumps_not_crossed = false;
  std::vector<DetectionLimit> detection_limits;
  std::vector<RankedCandidate> candidates; ///< candidates of the first round, best first
  std::vector<Row> rows;
  int tried = 0, draws = 0;
  double alpha = 0.05;
  bool vetoed = false;                 ///< true if the hold-out blocks rejected the findings: nothing was added
  bool unconfirmed = false;            ///< true if they could neither confirm nor reject the findings
  std::vector<std::string> statements; ///< what these data leave undetermined, and every decision a reader must see
  std::vector<std::string> plain;      ///< two sentences for a machinist
  /// The scenario with the effects found marked as estimated quantities, and what traced_scenario.h writes: their joint
  /// estimate with the free unknowns, and how each parameter enters. Empty: nothing to add.
  scenario::Scenario extended;
  calibration::Estimate estimate;
  std::vector<Taken> taken;
  std::vector<JumpingSize> jumping;
  std::vector<KnownDraw> known;    ///< declared draws of which the readings say something
  std::vector<double> correlation; ///< of the estimate's parameters, then of `known`, row-major; empty without these
  std::vector<Addition> additions;
  std::vector<Correction> corrections;
  std::vector<Correction> noise_effects; ///< noise that is not equal; its sizes are among the additions
  Campaign campaign; ///< where Settings::scores
};

/// What one of several rounds added; what it found is in the scenario that the next one traces.
struct Round {
  std::vector<std::string> added; ///< findings; empty: nothing
  std::vector<std::string> told;  ///< the same, in words
  Rms rms;
  bool vetoed = false;
  std::vector<RankedCandidate> candidates; ///< best first
};

struct Settings {
  int threads = 0; ///< 0: all processors
  std::function<void(const std::string& what)> progress = {};
  bool scores = false; ///< fills Trace::campaign
};

/// Traces a scenario with readings. Throws InputError for bad input. The result says what the data leave undetermined.
Trace trace(const scenario::Scenario& scenario, const Settings& settings);

} // namespace gumshoe::tracing
