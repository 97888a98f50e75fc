#pragma once
/// Every decision of the search, as a function of statistics alone: no model, no fit, no random numbers.
///
/// A figure that costs a simulation is passed as a function and called only where the other figures leave the question
/// open. Scores and leads are likelihood ratios (2 ln) minus twice their expectation by chance (README.md). Thresholds:
/// criteria.h.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tracing/judgement/assess.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// Target of one round of the search, given the false-alarm rate alpha.
bool look_for_signature(const Assessment& assessment, double alpha);
bool look_for_scatter(const Assessment& assessment, double alpha);
/// True if another round follows, given the number of findings and whether the last round added one.
bool search_goes_on(bool took_one, std::size_t findings);

/// The figures of a candidate that decisions use.
struct Scored {
  std::string name;
  double score = 0;
  bool eligible = true;
};
/// Indices of the best eligible candidates of different names, best first, `most` at most.
std::vector<std::size_t> best_of(const std::vector<Scored>& candidates, std::size_t most);
/// Indices of the candidates, the best of each name, whose gain is at least that of a variance component: best first.
std::vector<std::size_t> explain_scatter(const std::vector<Scored>& candidates, double gain_of_scatter);

/// Whether a candidate is refitted with the whole model once another was. @param best score of the first in order
bool could_still_win(double score, double best);
/// Whether a finding still counts given all others, by the ratio that it adds and the one that it had to exceed.
bool still_counts(double gain, double limit);
/// Whether a refitted candidate counts: by its p-value in the linear fit, or its ratio in the whole model.
bool passes(double p, double threshold, double ratio, double limit);

/// Probability of so large a lead if the trailing candidate were true.
using Chance = std::function<double()>;

/// Whether a plain shape's lead over the best effect excludes that effect.
bool shape_excludes(double lead, const Chance& chance);

/// Relation of a rival to the best candidate.
enum class Standing {
  excluded, ///< the best fits better
  separate, ///< it counts in addition to the best: another effect, for a later round
  member,   ///< these data cannot distinguish the two: one class
};
/// @param lead         lead of the best over the rival, 2 ln L
/// @param correlation  cosine of their projected signatures
/// @param added        likelihood ratio that the rival adds to the best
/// @param limit        smallest ratio at which the rival counts as another effect
Standing standing(double lead, double correlation, const Chance& chance, const std::function<double()>& added,
                  double limit);

/// Whether an effect's lead over a variance component that it explains excludes the component.
bool excludes_scatter(double lead, const Chance& chance);

/// Whether two effects together are found where neither passes alone: they explain more than any shape, and each counts
/// in addition to the other. `scores` and `limits` of the two alone.
bool pair_found(double pair, const double (&scores)[2], const double (&limits)[2], double best_shape);

/// Whether an effect and a simpler shape are there rather than one shape of many sizes: the two are of equal merit or
/// better, the effect adds to the simpler shape what it must exceed, and the simpler shape adds to the effect what it
/// must.
/// @param both    score of the two together   @param scores, limits  of the effect and the simpler shape alone
/// @param added   likelihood ratio that the effect adds to the simpler shape
/// @param whole   score of the one shape
bool counts_beside(double both, const double (&scores)[2], double added, const double (&limits)[2], double whole);

/// Whether one plain shape is there rather than a named effect and a shape that was found with it.
/// @param lead  of the one shape over the two
bool explains_both(double lead);

/// The variance component that was found: the largest, if its p-value allows it.
std::optional<std::size_t> scatter_found(const Assessment& assessment, double alpha);
/// Whether the noise of single readings is larger than declared and nothing else explains that.
bool larger_noise_found(const Assessment& assessment, double alpha);

/// Errors of the hold-out blocks: sum of squares in units of all that is declared, and root mean square.
struct HoldoutError {
  double whitened = 0, rms = 0;
};
/// By how many standard deviations the change c that a prediction gains on another is larger than the readings show:
/// -sum(c r) / sqrt(sum(c^2 r^2)) of its residuals r, and the standard normal number that is as improbable for so many
/// readings. Were the change true, that would be one, however unequal the noise. 0 where nothing changes.
struct Overstated {
  double plain = 0;    ///< in units of the noise of readings, declared draws as fitted
  double weighted = 0; ///< by the covariance of all that is declared: scatter of blocks hides nothing
};
/// What the hold-out blocks say of findings to which they are sensitive.
enum class Holdout {
  confirms, ///< they are predicted better, by more than one of forty false findings gives
  /// They are predicted better, but by no more than chance gives: they can neither confirm nor reject them.
  favours,
  /// They are predicted no better, but by no more than chance were the findings true: they can neither confirm nor
  /// reject them.
  unsure,
  /// They alone would reject them; the training data show them by far more.
  outweighed,
  vetoes
};
/// They also veto if the error does not fall and noise alone seldom gives one as large, however uncertain the sizes
/// are.
/// @param noise_high  upper end of the root mean squares that noise alone gives, in the unit of `rms`
/// @param beyond      likelihood ratio (2 ln) of the findings in the training data, less what they had to exceed
Holdout judge_holdout(const HoldoutError& before, const HoldoutError& after, const Overstated& overstated,
                      double noise_high, const std::function<double()>& beyond);
/// Kind of a finding after a veto: scatter if it was a member of the class and is not another finding; none for an
/// effect. A shape is reported, though not added: what it describes is there, in some blocks.
std::optional<Kind> left_by_veto(Kind kind, bool scatter_in_class, bool scatter_found_alone);

/// Reason why a candidate was not pursued. @param absorbed_by  quantity that absorbs almost all of it, or empty
std::string refusal(double identifiable, const std::string& absorbed_by, double p, double threshold);

} // namespace gumshoe::tracing
