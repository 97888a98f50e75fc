#pragma once
/// Evidence of one round of the search: its candidates, their assessment by the bootstrap, and figures that require a
/// fit or a simulation.
#include <functional>
#include <set>

#include "tracing/fit/trace_context.h"
#include "tracing/judgement/assess.h"
#include "tracing/judgement/holdout.h"

namespace gumshoe::tracing {

/// A candidate as a term of the whole non-linear model.
struct Trial {
  std::size_t candidate = 0;
  JointFit fit;
  double ratio = 0;         ///< likelihood ratio (2 ln) against the fit without it
  double score = 0;         ///< the ratio minus twice its expectation by chance
  bool implausible = false; ///< no such effect has the size that fits

  /// The score less what is improbable of such a size: order of physical candidates.
  double worth() const;
};

/// "polynomial:feed^2 (zero in the middle)"
std::string with_shape(const Candidate& candidate);

/// Whether what one fit removes and another leaves is of a few successive readings (criteria.h): outliers, and no
/// shape.
bool explains_few(const TraceContext& context, const JointFit& without, const JointFit& with);

class Evidence {
public:
  /// Finds the candidates at the point of `fit` (kept by reference) and assesses them. @param round keys the draws
  /// @param dropped  names of candidates that are not tried again
  /// @param wide     true: tables of many cells are candidates, too
  Evidence(const TraceContext& context, const JointFit& fit, std::size_t round, const std::set<std::string>& dropped,
           bool wide = false);

  const std::vector<Candidate>& candidates() const { return candidates_; }
  const Assessment& assessment() const { return assessment_; }
  const Scan& scan() const { return *scan_; }
  const std::vector<const Candidate*>& pointers() const { return pointers_; }
  const JointFit& fit() const { return fit_; }

  /// Candidates of these that explain something, one of each name, the best first. @param most  so many at most
  std::vector<std::size_t> best_of(const std::function<bool(const Candidate&)>& fits, std::size_t most) const;
  double score(std::size_t candidate) const;  ///< its linear fit's ratio minus twice that by chance
  double chance(std::size_t candidate) const; ///< twice the ratio by chance, and what the sizes tried cost
  double limit(std::size_t candidate) const;  ///< likelihood ratio that it must exceed
  /// @param least  score that they must exceed
  std::vector<std::string>
  jumping(double least = -1e300) const; ///< candidates with whose sizes readings jump, best first
  /// Physical candidates that the declared model does not absorb almost completely.
  bool testable(std::size_t candidate) const;
  /// The linear fit of one candidate; its sizes are the start values for the whole model.
  Term linear_term(std::size_t candidate) const;
  /// The fit with one more term, or more, by the whole model. Not `valid` where the model has no value.
  JointFit with(const std::vector<Term>& more) const;
  /// The same with the shape parameters of these terms fitted, where the data determine them.
  JointFit with_shapes(const std::vector<Term>& more) const;
  /// With its shape parameters fitted, where the data determine them.
  Trial trial(std::size_t candidate) const;

  /// Whether parts of the training readings, left out in turn, are predicted better by `other`, both under one
  /// covariance model: judged in that way, or in either.
  bool predicts_better(const JointFit& other, const CovarianceModel& model, Judged judged) const;
  bool predicts_better(const JointFit& other, const CovarianceModel& model) const {
    return predicts_better(other, model, Judged::as_declared) ||
           predicts_better(other, model, Judged::given_the_others);
  }
  bool predicts_better(const JointFit& other, Judged judged) const {
    return predicts_better(other, other.covariance_model, judged);
  }
  bool predicts_better(const JointFit& other) const { return predicts_better(other, other.covariance_model); }
  /// The same of the fit and another one.
  bool of_few(const JointFit& other) const { return explains_few(c_, fit_, other); }
  /// Probability that `better` would lead `than` by so much if `than` were true; by simulation.
  double chance_of_lead(std::size_t better, std::size_t than, double lead) const;
  /// Cosine of two projected signatures.
  double correlation(std::size_t a, std::size_t b) const;
  /// Likelihood ratios of the first of some candidates with all of them, in pairs, each minus twice its expectation by
  /// chance: [a][b] by their places in `some`. The noise is as it is without a signature, or plain: two that hide each
  /// other pass for correlation.
  Matrix pair_scores(const std::vector<std::size_t>& some, std::size_t first) const;
  /// The same of draws of the noise, and scores of all candidates alone in these.
  struct ScoresOfNoise {
    Matrix alone;              ///< [candidate][draw]
    std::vector<Matrix> pairs; ///< [draw]
  };
  ScoresOfNoise scores_of_noise(const std::vector<std::size_t>& some, std::size_t first) const;
  /// What the second adds to the likelihood ratio of the first.
  double gain_beside(std::size_t best, std::size_t other) const;
  const Vector& residuals() const { return data_; } ///< residuals of the training readings
  /// Draws of the noise, its variance component included, as the best covariance model without a signature has it.
  Matrix noise(std::size_t draws, std::uint64_t key) const;

private:
  /// Waves and steps in time whose periods and instants explain most of what the fit leaves, under its covariance
  /// model.
  void add_sought(const std::set<std::string>& dropped);
  /// Shape of draws of the seat of a clamping: if readings jump with the seat, so do the draws.
  Matrix scatter_response(const CovarianceModel& model, double variance) const;
  Trial trial(std::size_t candidate, const Term& term) const;
  /// A term whose shape parameters are free, or none where it has none.
  std::optional<Term> freed(const Term& term) const;
  /// Pair criteria of data sets that have these without a signature, as scores.
  std::vector<Matrix> pair_scores(const std::vector<std::size_t>& some, std::size_t first, const Matrix& data,
                                  const Vector& criterion) const;

  const TraceContext& c_;
  const JointFit& fit_;
  std::vector<Candidate> candidates_;
  std::vector<const Candidate*> pointers_;
  std::unique_ptr<Scan> scan_;
  Vector data_;
  Assessment assessment_;
};

/// Likelihood ratio (2 ln) that some terms of a fit add to all others, all fitted again without them.
/// @param in_place_of_scatter  true: no variance component may take their place
double gain_of(const TraceContext& context, const JointFit& fit, const std::vector<std::size_t>& terms,
               bool in_place_of_scatter = false);
/// Minus 2 ln likelihood of what a fit leaves, comparable between fits of different terms.
double criterion_without_terms(const TraceContext& context, const JointFit& fit);
/// The fit without some of its terms.
JointFit without(const TraceContext& context, const JointFit& fit, const std::vector<std::size_t>& terms);

} // namespace gumshoe::tracing
