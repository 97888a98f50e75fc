#pragma once
/// What one round of the search can know: its candidates, the bootstrap's assessment of them, and figures that cost a
/// fit or a simulation.
#include "tracing/fit/trace_context.h"
#include "tracing/judgement/assess.h"

namespace gumshoe::tracing {

/// A candidate as a term of the whole non-linear model.
struct Trial {
  std::size_t candidate = 0;
  JointFit fit;
  double ratio = 0; ///< likelihood ratio (2 ln) against the fit without it
  double score = 0; ///< less twice what chance gives
};

class Evidence {
public:
  /// Finds the candidates at the point of `fit` (kept by reference) and assesses them. @param round keys the draws
  Evidence(const TraceContext& context, const JointFit& fit, std::size_t round);

  const std::vector<Candidate>& candidates() const { return candidates_; }
  const Assessment& assessment() const { return assessment_; }
  const Scan& scan() const { return *scan_; }
  const std::vector<const Candidate*>& pointers() const { return pointers_; }
  const JointFit& fit() const { return fit_; }

  double score(std::size_t candidate) const; ///< its likelihood ratio in the linear fit, less twice what chance gives
  double limit(std::size_t candidate) const; ///< likelihood ratio that it has to pass
  /// Physical candidates of which the declared model leaves enough.
  bool testable(std::size_t candidate) const;
  /// The linear fit of one candidate: its sizes start the whole model's.
  Term linear_term(std::size_t candidate) const;
  /// The fit with one more term, or more, by the whole model. Not `valid` where the model has no value.
  JointFit with(const std::vector<Term>& more) const;
  Trial trial(std::size_t candidate) const;

  /// Whether parts of the training readings, left out in turn, are predicted better by `other`; both under one
  /// covariance model.
  bool predicts_better(const JointFit& other, const CovarianceModel& model) const;
  bool predicts_better(const JointFit& other) const { return predicts_better(other, other.covariance_model); }
  /// Chance that `better` would lead `than` by so much, were `than` the truth: by simulation.
  double chance_of_lead(std::size_t better, std::size_t than, double lead) const;
  /// Cosine of two projected signatures.
  double correlation(std::size_t a, std::size_t b) const;
  /// Likelihood ratio of two together, less twice what chance gives; and what the second adds to the first.
  double pair_score(std::size_t a, std::size_t b) const;
  double gain_beside(std::size_t best, std::size_t other) const;
  const Vector& residuals() const { return data_; } ///< of the training readings

private:
  /// Where a clamping's seat makes readings jump, its draws must jump, too.
  Matrix scatter_response(const CovarianceModel& model, double variance) const;

  const TraceContext& c_;
  const JointFit& fit_;
  std::vector<Candidate> candidates_;
  std::vector<const Candidate*> pointers_;
  std::unique_ptr<Scan> scan_;
  Vector data_;
  Assessment assessment_;
};

/// The same candidates with a noise that has no variance component.
class WithoutScatter {
public:
  WithoutScatter(const TraceContext& context, const Evidence& evidence);
  double score(std::size_t candidate) const; ///< as Evidence::score
  Fit fit(std::size_t candidate) const { return scan_.fit(candidate, evidence_.residuals()); }
  const CovarianceModel& model(const Fit& fit) const { return scan_.covariance_models()[fit.covariance_model]; }

private:
  const Evidence& evidence_;
  Design design_;
  Scan scan_;
  Statistics statistics_;
};

} // namespace gumshoe::tracing
