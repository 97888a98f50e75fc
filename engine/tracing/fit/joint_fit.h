#pragma once
/// The declared model and the effects found so far, fitted to some of the readings with the full non-linear model.
#include <map>
#include <optional>
#include <set>

#include "tracing/candidates/candidates.h"
#include "tracing/fit/scan.h"
#include "tracing/noise/by_label.h"
#include "tracing/noise/declared_response.h"
#include "tracing/noise/growth.h"
#include "tracing/noise/replicates.h"

namespace gumshoe::tracing {

/// A candidate that is part of the fit, with its sizes.
struct Term {
  Candidate candidate;
  Vector size; ///< one per amplitude, SI
};

/// A candidate over a finite step as a term, from the sizes over which it was taken.
Term at_start(const Candidate& candidate);

struct JointFit {
  std::vector<Term> terms;
  Points at; ///< all quantities, sizes of terms and fitted declared draws included
  /// By declared draw of the fitter: its most likely value given the readings, in standard uncertainties and before
  /// draws are tied; 0 where it is not fitted.
  Vector drawn;
  /// Measured minus simulated without the declared draws, which the design's random columns therefore explain as a
  /// whole; SI, in the order of measurement, all readings.
  Vector residual;
  Design design;                    ///< linearised there; the terms' columns are its last fixed ones
  std::vector<std::size_t> draw_of; ///< by random column of the design: the declared draw
  Matrix covariance;                ///< covariance of all fixed columns, SI; NaN if no reading is sensitive
  double noise = 1;                 ///< scale of the declared noise that the design holds
  CovarianceModel covariance_model; ///< model of the noise
  double variance = 1;              ///< variance of the whitened residuals, in units of the design's noise
  double criterion = 0;             ///< minus 2 ln likelihood, comparable between fits of equal noise
  bool valid = true;                ///< false: the model has no value there
  bool converged = true, kink = false;
  int iterations = 0;
};

/// First column of a term among the fixed columns of the fit.
Index first_column(const JointFit& fit, std::size_t term);
/// Standard uncertainty of each size of a term, SI.
Vector uncertainties(const JointFit& fit, std::size_t term);

/// How large a term is with which readings jump, or was when it was started: the length of all its sizes, SI.
double found_size(const Term& term);

/// Share of the sizes of terms with which readings jump over which better ones are sought, given the fit before.
double jump_reach(const std::vector<Term>& terms, const JointFit* before);

/// A free unknown: a quantity marked estimated that has no prior, or one of its entries.
struct FreeUnknown {
  std::string name;
  std::size_t quantity = 0, entry = 0;
  std::vector<bool> holds; ///< by reading
  bool is_size = false;    ///< size of an effect
  double jump = 0;         ///< where readings jump with it, and an earlier trace found it: how large, SI
};

/// What the readings say of declared draws, in standard uncertainties as declared.
struct DrawsGivenReadings {
  std::vector<std::size_t> draws; ///< by position in the plan's variates
  Vector mean;
  Matrix covariance;              ///< of the fit's fixed columns (SI; zero where not fitted), then of the draws
  bool informed = false;          ///< true if the readings say anything of them
  double largest_correlation = 0; ///< of a fixed column and a draw: a length that was measured against a reference
};

/// A component of an indication's noise that is not declared.
struct MoreNoise {
  std::size_t indication = 0;
  double u = 0;                    ///< SI
  const Grouping* group = nullptr; ///< readings that share a draw; none: each has its own
};

/// Fits the declared model and terms to some of the readings, with the whole non-linear model.
class Fitter {
public:
  /// @param experiment  experiment of the extended scenario
  /// @param rows        rows of the readings that are fitted
  Fitter(const propagation::Experiment& experiment, const Simulator& simulator, const Observations& observations,
         std::vector<Index> rows, int threads);

  /// Starts every fit where an earlier trace of these readings ended: from what they said of declared draws, whose
  /// quantities stand in [trace] priors as they were declared. Just these draws are fitted.
  /// @param scenario  as it states what they said; without the extension, which holds what was declared
  void start_from(const scenario::Scenario& scenario);

  /// Gauss-Newton with winsorised residuals; from `start` where it is given. `noise` 0: its scale is fitted, too.
  JointFit fit(const std::vector<Term>& terms, double noise, const JointFit* start = nullptr) const;
  /// Where no noise is declared and none grows with a condition: whether it differs by a label, by what a fit leaves.
  /// Readings are weighted so from here on. What the model lacks may differ by a label as well: it must be found first.
  bool weigh_by_label(const JointFit& found);
  /// The same without some of the rows.
  Fitter without_rows(const std::vector<Index>& rows) const;
  /// The same as if no groups of readings could scatter.
  Fitter without_scatter() const;
  /// A fit as it is of a scenario that declares more noise.
  JointFit with_noise(const JointFit& found, const std::vector<MoreNoise>& more) const;
  /// The declared model at its estimates, not fitted.
  JointFit linearised(double noise) const;
  /// Fits unknowns to which only readings outside the fit are sensitive, such as the offset of a held-out block, with
  /// all others as fitted, and adds them to the covariance.
  void settle(JointFit& fit) const;
  /// Where readings jump, seeks better sizes near those of a fit that stays, until there are none.
  void refine(JointFit& fit) const;
  /// If readings jump with a term's size, its tangent does not give its uncertainty. Replaces it in the covariance by
  /// that of the likelihood along the size or of the straight line through the jumps, whichever is larger.
  void widen_jumping(JointFit& fit) const;
  /// Changes of the predictions of all readings (rows, SI) by draws of the sizes with which readings jump (columns), in
  /// proportion to their likelihood, all else fitted: a mill may trigger with another tooth. Zero if no size jumps.
  Matrix across_jumps(const JointFit& fit, Index draws) const;
  /// Where readings jump with a candidate's size: the best of these sizes (columns), and of others between them, in
  /// addition to a fit, by the exact model, all else fitted. None if the model has no value there.
  std::optional<Start> best_start(const JointFit& fit, const Candidate& candidate, const Matrix& sizes,
                                  double step) const;
  /// What the readings say of the declared draws that move the point of the fit, except those that are tied. Settled
  /// unknowns then follow these draws, in the fit's covariance as well.
  DrawsGivenReadings draws_given_readings(JointFit& fit) const;
  /// The point of a fit with every declared draw at null, as a scenario states its values.
  Points without_draws(JointFit fit) const;
  const std::vector<FreeUnknown>& unknowns() const { return unknowns_; }
  bool noise_declared() const { return noise_declared_; }
  /// Whether the noise of each indication is estimated by itself.
  bool noise_of_each() const { return spread_.minCoeff() < spread_.maxCoeff(); }
  const std::optional<NoiseGrowth>& noise_growth() const { return growth_; }
  const std::optional<NoiseByLabel>& noise_by_label() const { return by_label_; }
  /// Mean variance of an indication's noise that is not declared, in units of relative_variance().
  double mean_variance(std::size_t indication) const {
    return growth_ ? growth_->variance.mean() : by_label_ ? by_label_->variance.col(index(indication)).mean() : 1;
  }
  const std::vector<Index>& rows() const { return rows_; }
  const Replicates& replicates() const { return replicates_; }

private:
  /// A declared draw with the (reading, quantity) pairs that it changes.
  struct Draw {
    std::string name;
    double u = 0;
    std::vector<std::pair<std::size_t, std::size_t>> moves;
    bool local = false;  ///< acts on one reading only
    bool fitted = false; ///< moves the point of linearisation, as priors of the model's quantities do
  };
  /// A fitted size: of a term, or found by an earlier trace.
  struct Size {
    Index column = 0; ///< among the fixed ones
    std::size_t quantity = 0;
    std::vector<bool> holds; ///< by reading
    double at = 0, low = -1e300, high = 1e300;
  };
  Size size_of(const JointFit& fit, std::size_t term, Index amplitude) const;
  Size size_of(const JointFit& fit, std::size_t unknown) const;
  struct Profile;
  class JumpingSizes;
  std::vector<Index> jumping_unknowns() const; ///< columns
  bool any_jumps(const JointFit& fit) const;
  /// True if a profile is needed: readings jump with the size, or do not follow its tangent.
  enum class Worth { jumps, tangent_wrong };

  /// Unknowns to which no fitted reading is sensitive, and the rows that are.
  struct Settled {
    std::vector<Index> columns, rows;
  };
  Settled settled_columns(const JointFit& fit) const;
  /// How settled unknowns follow the draws, in both covariances. @param place  columns known: fixed, then
  /// draws
  void follow_draws(JointFit& fit, const std::vector<Index>& place, DrawsGivenReadings& out) const;

  void find_unknowns();
  void find_draws();
  void find_fitted();
  /// Quantities whose steps (of both signs) the readings do not follow like a smooth function.
  std::set<std::size_t> not_smooth(const std::map<std::size_t, double>& steps) const;
  /// Whether the noise of any indication is declared by more than its display, or nothing else can be known of it.
  bool declares_noise() const;
  /// Throws InputError if noise is declared, and an indication has none that differs from reading to reading.
  void need_independent_noise() const;
  /// Computes the responses to declared draws of effects over their values, at the estimates.
  void find_responses();
  void find_covariance_models();
  /// Whether readings were recorded in steps so coarse that rounding repeats, by the scatter of readings that come
  /// back.
  void find_coarse();
  double mean_readouts() const; ///< of a reading
  /// Where no noise is declared: whether one indication scatters more than another, from what does not repeat.
  struct Scatter {
    Vector size;  ///< by indication, SI
    bool unequal; ///< surely
  };
  /// Scatter of readings about the means of their conditions; none, if too few repeat or they do not scatter.
  std::optional<Scatter> scatter_about_cells() const;
  void find_spread();
  /// Where no noise is declared: whether it grows with a condition.
  void find_growth();
  /// How noise grows by the training rows without these.
  std::optional<NoiseGrowth> growth_without(const std::vector<Index>& bad) const;
  /// Rows about the fit and the means of equal conditions, in units of the noise so far; none if too few repeat.
  std::optional<Vector> about_cells(const JointFit& fit, const std::vector<Index>& rows,
                                    const Replicates& replicates) const;
  std::optional<NoiseByLabel> by_label_without(const std::vector<Index>& bad, const JointFit& found,
                                               const Replicates& replicates);
  /// Training rows of readings that stand out among those of equal conditions.
  std::vector<Index> outlying_in_cells(const JointFit& fit, const Replicates& replicates) const;

  /// Variance of a reading's noise that is not declared, by indication, over the least: 1 where it is equal.
  Vector relative_variance(std::size_t reading) const;
  bool linearise(JointFit& fit) const;
  void set_fixed(const Matrix& derivative, const std::vector<std::size_t>& wanted, JointFit& fit) const;
  void set_local_noise(const Matrix& derivative, JointFit& fit) const;
  void set_declared(const Matrix& derivative, JointFit& fit) const;
  /// Part of the readings that the fitted draws give by the random columns, by row of the design.
  Vector drawn_part(const JointFit& fit) const;
  /// True if a draw is of just the readings at which a term shifts its quantity; its prior is then released.
  bool released(const Draw& draw, const JointFit& fit) const;
  /// Column of a quantity among the derivatives of `needed_`.
  Index needed(std::size_t quantity) const;

  void converge(JointFit& fit, double noise) const;
  /// Moves fitted draws, by their column in `draws_`, and the point with them.
  void move_draws(JointFit& fit, const Vector& change) const;
  Vector released_draws(const JointFit& fit) const;   ///< the change that undoes those of quantities that are terms
  Vector sizes(const std::vector<Term>& terms) const; ///< after a zero for every unknown
  Points without_terms(JointFit fit) const;
  void apply(JointFit& fit, const Vector& change, double share) const;
  double objective(const JointFit& fit, const CovarianceModel& model, const Scan& scan) const;
  /// If readings jump, Gauss-Newton may end in a poor optimum: sets the last term to a nearby size that fits better,
  /// with all others fitted. Returns false if there is none or nothing jumps.
  bool explore(JointFit& fit) const;
  /// The same for all terms that start where readings jump, together. @param reach  share of their sizes tried, 0: none
  bool cross_jumps(JointFit& fit, double noise, double reach) const;
  void widen_across_jumps(JointFit& fit) const;
  /// @param unit  scale of the uncertainty of the size
  std::optional<Profile> profile(const JointFit& fit, const Size& size, double unit, Worth worth) const;
  /// @param u  as it is, by the tangent. Returns 0 where that serves.
  double widened(const JointFit& fit, const Size& size, double u) const;

  const propagation::Experiment& experiment_;
  const Simulator& simulator_;
  const Observations& observations_;
  std::vector<Index> rows_;
  Replicates replicates_;
  std::vector<CovarianceModel> covariance_models_; ///< those that the scatter about what repeats admits; empty: all
  int threads_;
  std::vector<FreeUnknown> unknowns_;
  std::vector<Draw> draws_;
  bool noise_declared_ = false;
  bool groups_scatter_ = true; ///< whether variance components are tried
  Vector earlier_; ///< by draw: what an earlier trace of these readings said of it, in standard uncertainties
  Vector spread_;  ///< by indication: standard deviation of noise that is not declared, over that of the first
  std::vector<bool> coarse_;          ///< as Design::coarse
  std::optional<NoiseGrowth> growth_; ///< of noise that is not declared; this or the next
  std::optional<NoiseByLabel> by_label_;
  std::vector<std::size_t> needed_;         ///< quantities whose derivatives are used, ascending
  std::vector<DeclaredResponse> responses_; ///< one per column of `needed_`
  Vector offset_;                           ///< shift of the readings' mean over these draws, by row of the simulator
};

} // namespace gumshoe::tracing
