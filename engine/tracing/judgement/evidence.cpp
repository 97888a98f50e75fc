#include "tracing/judgement/evidence.h"

#include <algorithm>
#include <cmath>

#include "tracing/candidates/shapes.h"
#include "tracing/criteria.h"
#include "tracing/judgement/apart.h"
#include "tracing/judgement/holdout.h"

namespace gumshoe::tracing {
namespace {

bool is_term(const JointFit& fit, const Candidate& a) {
  return std::ranges::any_of(fit.terms, [&](const Term& t) {
    const std::string& place = a.amplitudes[0].scenario_name;
    return t.candidate.name == a.name && (place.empty() || t.candidate.amplitudes[0].scenario_name == place);
  });
}

Design without_components(Design design) {
  design.scatter.clear();
  std::erase_if(design.covariance_models, [](const CovarianceModel& m) { return m.scatter >= 0; });
  return design;
}

} // namespace

Repeats repeats_of(const TraceContext& c, const JointFit& fit) {
  Repeats out{PureError(fit.design, c.fitter.rows(), c.fitter.replicates()), {}, c.observations.blocks.groups.size()};
  if (out.blocks < criteria.blocks_for_folds) out.blocks = 0;
  for (const Index row : c.fitter.rows())
    if (out.blocks > 0) out.block.push_back(c.observations.blocks.group[fit.design.reading[index(row)]]);
  return out;
}

Evidence::Evidence(const TraceContext& c, const JointFit& fit, std::size_t round) : c_(c), fit_(fit) {
  const double size = std::sqrt(std::max(1e-300, fit.variance)) * fit.design.reference[0];
  const auto known = [&](const Candidate& a) { return is_term(fit, a); };
  candidates_ =
      physical_candidates(c.experiment, c.simulator, fit.at, c.observations, criteria.secant_step * size, known);
  for (Candidate& a : shapes(c.observations))
    if (!known(a)) candidates_.push_back(std::move(a));
  for (const Candidate& a : candidates_) pointers_.push_back(&a);
  scan_ = std::make_unique<Scan>(fit.design, c.fitter.rows(), pointers_, c.threads);
  data_ = scan_->whitened(scan_->plain()).take(fit.residual);
  const double declared = c.fitter.noise_declared() ? 1 / fit.noise : 0;
  const Repeats repeats = repeats_of(c, fit);
  assessment_ = assess(
      *scan_, data_, c.draws, c.seed + round, c.alpha, declared,
      [&](const CovarianceModel& model, double variance) { return scatter_response(model, variance); }, &repeats);
}

Matrix Evidence::scatter_response(const CovarianceModel& model, double variance) const {
  const auto seat = seat_at_null(c_.experiment);
  if (!seat || model.scatter < 0 || fit_.design.indications > 1) return {};
  const double s = std::sqrt(variance), u = model.ratio * fit_.design.reference[0] * s;
  const Matrix bent = bent_response(c_.simulator, fit_.at, *seat, u);
  return bent.size() > 0 ? Matrix(in_sequence(c_.observations, bent) / s) : bent;
}

double Evidence::score(std::size_t a) const {
  return assessment_.data.ratio(index(a), 0) - 2 * assessment_.null[a].mean;
}

double Evidence::limit(std::size_t a) const { return assessment_.null[a].quantile(assessment_.threshold); }

bool Evidence::testable(std::size_t a) const {
  return candidates_[a].physical() && scan_->identifiable(a) > criteria.absorbed_share;
}

Term Evidence::linear_term(std::size_t a) const {
  if (candidates_[a].physical()) return {candidates_[a], scan_->fit(a, data_).size};
  Term shape{apart(candidates_[a], fit_, c_.observations, c_.fitter.rows()), {}};
  shape.size = Vector::Zero(shape.candidate.columns.cols()); // linear: found in one step from anywhere
  return shape;
}

JointFit Evidence::with(const std::vector<Term>& more) const {
  auto terms = fit_.terms;
  terms.insert(terms.end(), more.begin(), more.end());
  return c_.fitter.fit(terms, fit_.noise, &fit_);
}

Trial Evidence::trial(std::size_t a) const {
  Trial out{a, with({linear_term(a)})};
  if (!out.fit.valid) return out;
  // At the fitted size, with the same unknowns as without the term.
  Design without = out.fit.design;
  without.fixed = Matrix(without.fixed.leftCols(without.fixed.cols() - candidates_[a].columns.cols()));
  const Scan scan(without, c_.fitter.rows(), {}, c_.threads);
  out.ratio = assessment_.data.criterion[0] - scan.run(scan.whitened(scan.plain()).take(out.fit.residual)).criterion[0];
  if (!std::isfinite(out.ratio)) out.ratio = 0;
  out.score = out.ratio - 2 * assessment_.null[a].mean;
  return out;
}

bool Evidence::predicts_better(const JointFit& other, const CovarianceModel& model) const {
  const auto error = [&](const JointFit& fit) {
    return cross_validated(c_.observations, c_.fitter.rows(), fit, model);
  };
  return error(other) < error(fit_);
}

double Evidence::chance_of_lead(std::size_t better, std::size_t than, double lead) const {
  const Fit truth = scan_->fit(than, data_);
  const Whitened& w = scan_->whitened(truth.covariance_model);
  const Vector signal = w.take(candidates_[than].columns) * truth.size;
  NoiseShape shape = assessment_.noise_shape;
  shape.scatter = scatter_response(scan_->covariance_models()[truth.covariance_model], fit_.variance);
  Matrix drawn = w.draw(criteria.rival_draws, c_.seed ^ 0x41a7ull, shape);
  const double s = std::sqrt(fit_.variance);
  drawn = (s * drawn).colwise() + signal;
  const Scan both(fit_.design, c_.fitter.rows(), {&candidates_[better], &candidates_[than]}, c_.threads);
  const Statistics statistics = both.run(drawn);
  const double shift = 2 * (assessment_.null[than].mean - assessment_.null[better].mean);
  int as_much = 0;
  for (Index j = 0; j < drawn.cols(); ++j) as_much += statistics.ratio(0, j) - statistics.ratio(1, j) + shift >= lead;
  return (1.0 + as_much) / (1.0 + static_cast<double>(criteria.rival_draws));
}

double Evidence::correlation(std::size_t a, std::size_t b) const {
  return scan_->correlation(a, b, assessment_.data.covariance_model[0]);
}

double Evidence::pair_score(std::size_t a, std::size_t b) const {
  return scan_->pair_ratio(a, b, data_, assessment_.data.covariance_model[0]) -
         2 * (assessment_.null[a].mean + assessment_.null[b].mean);
}

double Evidence::gain_beside(std::size_t best, std::size_t other) const {
  const std::size_t k = assessment_.data.covariance_model[0];
  return scan_->pair_ratio(best, other, data_, k) - scan_->pair_ratio(best, best, data_, k);
}

WithoutScatter::WithoutScatter(const TraceContext& c, const Evidence& e)
    : evidence_(e), design_(without_components(e.fit().design)),
      scan_(design_, c.fitter.rows(), e.pointers(), c.threads), statistics_(scan_.run(e.residuals())) {}

double WithoutScatter::score(std::size_t a) const {
  return statistics_.ratio(index(a), 0) - 2 * evidence_.assessment().null[a].mean;
}

} // namespace gumshoe::tracing
