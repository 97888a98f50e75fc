#include "tracing/judgement/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "tracing/candidates/courses.h"
#include "tracing/candidates/lags.h"
#include "tracing/candidates/shapes.h"
#include "tracing/candidates/waves.h"
#include "tracing/criteria.h"
#include "tracing/judgement/apart.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/holdout.h"
#include "tracing/judgement/what_repeats.h"

namespace gumshoe::tracing {
namespace {

bool is_term(const JointFit& fit, const Candidate& a) {
  return std::ranges::any_of(fit.terms, [&](const Term& t) {
    const std::string& place = a.amplitudes[0].scenario_name;
    return t.candidate.name == a.name && (place.empty() || t.candidate.amplitudes[0].scenario_name == place);
  });
}

/// Whether a few successive readings hold most of what is removed (squares, by row), and much of what is without what
/// other readings lose; also if nothing is removed.
bool of_few_readings(const Vector& squares, std::size_t indications) {
  if (!(squares.sum() > 0)) return true;
  const Index few = std::min(squares.size(), criteria.few_readings * index(indications));
  double most = 0;
  for (Index from = 0; from + few <= squares.size(); from += index(indications))
    most = std::max(most, squares.segment(from, few).sum());
  return most > criteria.few_share * squares.sum() && most > criteria.few_gain * squares.cwiseMax(0).sum();
}

/// Criterion of the residuals at a fit's point, with the same unknowns as without some of its terms.
double criterion_at(const TraceContext& c, const JointFit& fit, const std::vector<std::size_t>& terms,
                    bool in_place_of_scatter = false) {
  Design design = in_place_of_scatter ? without_components(fit.design) : fit.design;
  std::vector<Index> kept;
  for (Index j = 0; j < design.fixed.cols(); ++j)
    if (std::ranges::none_of(terms, [&](std::size_t t) {
          const Index first = first_column(fit, t);
          return j >= first && j < first + fit.terms[t].size.size();
        }))
      kept.push_back(j);
  design.fixed = Matrix(fit.design.fixed(Eigen::all, kept));
  const Scan scan(design, c.fitter.rows(), {}, c.threads);
  return scan.run(scan.whitened(scan.plain()).take(fit.residual)).criterion[0];
}

/// Whether a term's shape parameters are known by the fit, and not at a limit.
bool shape_known(const JointFit& fit, std::size_t term) {
  const Term& t = fit.terms[term];
  const Vector u = uncertainties(fit, term);
  for (Index j = 0; j < t.size.size(); ++j) {
    const Amplitude& a = t.candidate.amplitudes[index(j)];
    if (a.is_shape && !(fit.converged && u[j] < criteria.known_shape * std::fabs(a.held + t.size[j]) &&
                        t.size[j] > a.low && t.size[j] < a.high))
      return false;
  }
  return true;
}

/// Degrees of freedom of the declared noise of a reading by Welch and Satterthwaite's formula (JCGM 100, G.4.1), the
/// fewest of all indications. What readings share is a draw, and no noise.
double noise_freedom(const propagation::Experiment& experiment) {
  const auto& quantities = experiment.scenario().quantities;
  const propagation::Range noise = experiment.layout().indications;
  double fewest = std::numeric_limits<double>::infinity();
  for (std::size_t q = noise.begin; q < noise.end; ++q)
    for (const auto& entry : quantities[q].entries) {
      double variance = 0, sum = 0;
      for (const auto& component : entry.components) {
        if (std::ranges::find(component.per, "reading") == component.per.end()) continue;
        const double u = component.distribution.standard_uncertainty();
        variance += u * u;
        sum += u * u * u * u / component.degrees_of_freedom;
      }
      if (sum > 0) fewest = std::min(fewest, variance * variance / sum);
    }
  return fewest;
}

bool implausible(const Term& term) {
  for (std::size_t j = 0; j < term.candidate.amplitudes.size(); ++j) {
    const Amplitude& a = term.candidate.amplitudes[j];
    if (const double size = term.size[index(j)]; a.far_too_large(size) || a.of_wrong_sign(size)) return true;
  }
  return false;
}

/// What columns explain of residuals (chosen rows) under one covariance model, which is kept by reference.
Gain gain_under(const Whitened& white, const Vector& residual) {
  return [&white, left = Vector(white.reduce(residual))](const Matrix& all, Index each, double share) {
    const Matrix whole = white.whiten(white.take(all)), reduced = white.reduce(white.take(all));
    Vector out = Vector::Zero(all.cols() / each);
    for (Index k = 0; k < out.size(); ++k) {
      const auto columns = reduced.middleCols(each * k, each);
      const Matrix squares = columns.transpose() * columns;
      const Vector product = columns.transpose() * left;
      // What unknowns follow has an alias that is none.
      const bool own = columns.squaredNorm() > share * whole.middleCols(each * k, each).squaredNorm();
      if (own && squares.determinant() > criteria.absorbed_share * squares.diagonal().prod())
        out[k] = product.dot(squares.inverse() * product);
    }
    return out;
  };
}

/// The design with any value for each cell; nothing where too few readings come back, or too many cells do.
std::optional<Design> with_cells(const TraceContext& c, const Design& design) {
  const Replicates& replicates = c.fitter.replicates();
  const std::vector<Index>& rows = c.fitter.rows();
  const std::set<std::size_t> cells(replicates.cell.begin(), replicates.cell.end());
  const std::size_t values = cells.size() * design.indications;
  if (values > criteria.most_cells_of_noise || values * criteria.least_repeats > rows.size()) return std::nullopt;
  Design out = design;
  add_fixed(out, rows, columns_by_group(rows, design.indications, replicates.cell, false));
  return out;
}

std::size_t wide_cells(std::size_t readings) {
  return std::max(criteria.most_table_cells, std::min(criteria.most_wide_cells, criteria.most_wide_entries / readings));
}

} // namespace

std::string with_shape(const Candidate& a) { return a.name + (a.shape.empty() ? "" : " (" + a.shape + ")"); }

Evidence::Evidence(const TraceContext& c, const JointFit& fit, std::size_t round, const std::set<std::string>& dropped,
                   bool wide)
    : c_(c), fit_(fit) {
  const double size = std::sqrt(std::max(1e-300, fit.variance)) * fit.design.reference[0];
  const auto known = [&](const Candidate& a) { return dropped.contains(a.name) || is_term(fit, a); };
  candidates_ = physical_candidates(c.experiment, c.simulator, fit.at, c.observations, criteria.secant_step * size,
                                    known, [&](const Candidate& a, const Matrix& sizes, double size_step) {
                                      return c.fitter.best_start(fit, a, sizes, size_step);
                                    });
  for (Candidate& a : shapes(c.observations, wide ? wide_cells(c.observations.readings) : criteria.most_table_cells))
    if (!known(a)) candidates_.push_back(std::move(a));
  add_sought(dropped);
  for (const Candidate& a : candidates_) pointers_.push_back(&a);
  scan_ = std::make_unique<Scan>(fit.design, c.fitter.rows(), pointers_, c.threads);
  data_ = scan_->whitened(scan_->plain()).take(fit.residual);
  const double declared = c.fitter.noise_declared() ? 1 / fit.noise : 0;
  const Repeats repeats = repeats_of(c, fit);
  std::vector<double> rarity, exact;
  for (const Candidate& a : candidates_) {
    exact.push_back(a.exact_ratio);
    const bool rare = a.in_part() || (a.family == Family::shape && a.rare());
    rarity.push_back(std::max(a.searched, rare ? criteria.rarity_of_part : 1));
  }
  assessment_ = assess_surely(
      *scan_, data_, c.draws, c.seed + round, c.alpha, declared,
      [&](const CovarianceModel& model, double variance) { return scatter_response(model, variance); }, &repeats,
      noise_freedom(c.experiment), rarity, exact);
}

void Evidence::add_sought(const std::set<std::string>& dropped) {
  std::vector<const Candidate*> known;
  for (const Term& t : fit_.terms)
    if (t.candidate.form == Form::wave) known.push_back(&t.candidate);
  const auto use = independent(fit_.design, c_.fitter.rows());
  const Whitened plain(fit_.design, c_.fitter.rows(), use, {});
  const Vector residual = plain.winsorised(plain.take(fit_.residual));
  // A correlation or a component that stands for the very shape would hide its form.
  std::vector<CovarianceModel> models{fit_.covariance_model};
  if (models[0].correlation != 0 || models[0].scatter >= 0) models.emplace_back();
  const std::optional<Design> any_by_cell = with_cells(c_, fit_.design);
  std::optional<Whitened> cells;
  if (any_by_cell)
    cells.emplace(*any_by_cell, c_.fitter.rows(), independent(*any_by_cell, c_.fitter.rows()), models[0]);
  std::vector<Candidate> sought;
  for (const CovarianceModel& model : models) {
    const Whitened white(plain, model);
    const Gain gain = gain_under(white, residual);
    std::optional<Whitened> about_cells;
    if (cells) about_cells.emplace(*cells, model);
    const Gain in_time = about_cells ? gain_under(*about_cells, residual) : Gain{};
    std::ranges::move(waves(c_.observations, known, gain, in_time), std::back_inserter(sought));
    std::ranges::move(courses(c_.observations, c_.fitter.rows(), gain), std::back_inserter(sought));
    std::ranges::move(lags(c_.observations, gain), std::back_inserter(sought));
  }
  for (Candidate& a : sought) {
    const bool twice = std::ranges::any_of(
        candidates_, [&](const Candidate& other) { return other.name == a.name && other.shape == a.shape; });
    a.searched *= static_cast<double>(models.size());
    if (!twice && !dropped.contains(a.name)) candidates_.push_back(std::move(a));
  }
}

Matrix Evidence::scatter_response(const CovarianceModel& model, double variance) const {
  const auto seat = seat_at_null(c_.experiment);
  if (!seat || model.scatter < 0 || fit_.design.indications > 1) return {};
  const double s = std::sqrt(variance), u = model.ratio * fit_.design.reference[0] * s;
  const Matrix bent = bent_response(c_.simulator, fit_.at, *seat, u);
  return bent.size() > 0 ? Matrix(in_sequence(c_.observations, bent) / s) : bent;
}

double Evidence::score(std::size_t a) const { return assessment_.data.ratio(index(a), 0) - chance(a); }

double Evidence::chance(std::size_t a) const {
  return 2 * assessment_.null[a].mean + 2 * std::log(candidates_[a].searched);
}

double Evidence::limit(std::size_t a) const { return assessment_.null[a].quantile(assessment_.threshold); }

std::vector<std::string> Evidence::jumping(double least) const {
  std::vector<Scored> all;
  for (std::size_t a = 0; a < candidates_.size(); ++a)
    all.push_back({candidates_[a].name, score(a), !candidates_[a].start.empty() && score(a) > least});
  std::vector<std::string> out;
  for (const std::size_t a : tracing::best_of(all, criteria.most_jumping)) out.push_back(candidates_[a].name);
  return out;
}

bool Evidence::testable(std::size_t a) const {
  return candidates_[a].physical() && scan_->identifiable(a) > criteria.absorbed_share;
}

Term Evidence::linear_term(std::size_t a) const {
  if (!candidates_[a].start.empty()) return at_start(candidates_[a]);
  if (candidates_[a].physical()) return {candidates_[a], scan_->fit(a, data_).size};
  // A shape of one group stays whole: without the slope of all groups it would no longer be this group's.
  const Candidate& own = candidates_[a];
  Term shape{own.rare() ? own : apart(own, fit_, c_.observations, c_.fitter.rows()), {}};
  shape.size = Vector::Zero(shape.candidate.columns.cols()); // linear: found in one step from anywhere
  return shape;
}

JointFit Evidence::with(const std::vector<Term>& more) const {
  auto terms = fit_.terms;
  terms.insert(terms.end(), more.begin(), more.end());
  return c_.fitter.fit(terms, fit_.noise, &fit_);
}

std::optional<Term> Evidence::freed(const Term& term) const {
  const Candidate shaped = with_held_shape(term.candidate, c_.experiment, fit_.at);
  if (shaped.held.empty()) return std::nullopt;
  Term out{with_free_shape(shaped, c_.experiment), term.size};
  out.size.conservativeResizeLike(Vector::Zero(out.candidate.columns.cols()));
  return out;
}

JointFit Evidence::with_shapes(const std::vector<Term>& more) const {
  JointFit best = with(more);
  const std::size_t first = fit_.terms.size();
  for (std::size_t i = 0; best.valid && i < more.size(); ++i) {
    std::vector<Term> terms(best.terms.begin() + index(first), best.terms.end());
    const auto shaped = freed(terms[i]);
    if (!shaped) continue;
    terms[i] = *shaped;
    if (JointFit other = with(terms); other.valid && shape_known(other, first + i)) best = std::move(other);
  }
  return best;
}

Trial Evidence::trial(std::size_t a) const {
  const Term start = linear_term(a);
  Trial held = trial(a, start);
  const auto shaped = held.fit.valid ? freed(start) : std::nullopt;
  if (!shaped) return held;
  Trial out = trial(a, *shaped);
  if (!out.fit.valid || !shape_known(out.fit, out.fit.terms.size() - 1)) return held;
  // Less twice what chance gives a size.
  out.score = std::max(held.score, out.score - 2 * static_cast<double>(shaped->candidate.held.size()));
  return out;
}

Trial Evidence::trial(std::size_t a, const Term& term) const {
  Trial out{a, with({term})};
  if (!out.fit.valid) return out;
  out.ratio = assessment_.data.criterion[0] - criterion_at(c_, out.fit, {out.fit.terms.size() - 1});
  if (!std::isfinite(out.ratio)) out.ratio = 0;
  // Sizes that the signature over a finite step does not have cost what chance gives them.
  const Index more = term.candidate.columns.cols() - candidates_[a].columns.cols();
  const double sizes = term.candidate.start.empty() ? 0 : static_cast<double>(more);
  out.score = out.ratio - chance(a) - 2 * sizes;
  out.implausible = implausible(out.fit.terms.back());
  return out;
}

double Trial::worth() const { return score - (implausible ? 2 * std::log(criteria.rarity_of_implausible) : 0); }

JointFit without(const TraceContext& c, const JointFit& fit, const std::vector<std::size_t>& dropped) {
  std::vector<Term> terms;
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    if (std::ranges::find(dropped, t) == dropped.end()) terms.push_back(fit.terms[t]);
  return c.fitter.fit(terms, fit.noise, &fit);
}

double criterion_without_terms(const TraceContext& c, const JointFit& fit) {
  std::vector<std::size_t> all(fit.terms.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return criterion_at(c, fit, all);
}

double gain_of(const TraceContext& c, const JointFit& fit, const std::vector<std::size_t>& terms,
               bool in_place_of_scatter) {
  const JointFit less = without(c, fit, terms);
  if (!less.valid) return std::numeric_limits<double>::infinity();
  return criterion_at(c, less, {}, in_place_of_scatter) - criterion_at(c, fit, terms, in_place_of_scatter);
}

bool Evidence::predicts_better(const JointFit& other, const CovarianceModel& model, Judged judged) const {
  const auto error = [&](const JointFit& fit) {
    return cross_validated(c_.observations, c_.fitter.rows(), fit, model, judged);
  };
  return error(other) < error(fit_);
}

bool explains_few(const TraceContext& c, const JointFit& without, const JointFit& with) {
  CovarianceModel model = with.covariance_model;
  model.correlation = 0; // it would spread what is of one reading
  const auto squares = [&](const JointFit& fit) {
    const auto use = independent(fit.design, c.fitter.rows());
    const Whitened plain(fit.design, c.fitter.rows(), use, {}), white(plain, model);
    const Matrix left = plain.winsorised(plain.take(fit.residual));
    if (model.scatter < 0) return Vector(white.left_over(left).array().square());
    // Where groups scatter, the cost of their draws counts, too; the readings of a group share it.
    const Matrix units = white.in_units(left);
    return Vector(units.array() * white.weighted_units(units).array());
  };
  return of_few_readings(squares(without) - squares(with), c.observations.indications);
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

Matrix Evidence::noise(std::size_t draws, std::uint64_t key) const {
  const std::size_t k = assessment_.data.covariance_model[0];
  NoiseShape shape = assessment_.noise_shape;
  shape.scatter = scatter_response(scan_->covariance_models()[k], assessment_.data.variance[0]);
  return std::sqrt(assessment_.data.variance[0]) * scan_->whitened(k).draw(draws, key, shape);
}

double Evidence::correlation(std::size_t a, std::size_t b) const {
  return scan_->correlation(a, b, assessment_.data.covariance_model[0]);
}

std::vector<std::size_t> Evidence::best_of(const std::function<bool(const Candidate&)>& fits, std::size_t most) const {
  std::vector<Scored> all;
  for (std::size_t a = 0; a < candidates_.size(); ++a)
    all.push_back({candidates_[a].name, score(a), fits(candidates_[a]) && assessment_.data.ratio(index(a), 0) > 0});
  return tracing::best_of(all, most);
}

std::vector<Matrix> Evidence::pair_scores(const std::vector<std::size_t>& some, std::size_t first, const Matrix& data,
                                          const Vector& criterion) const {
  std::vector<Matrix> out = scan_->pair_criteria(some, first, data, assessment_.data.covariance_model[0]);
  const std::vector<Matrix> plain = scan_->pair_criteria(some, first, data, scan_->plain());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = criterion[index(k)] - out[k].cwiseMin(plain[k]).array();
    for (Index a = 0; a < out[k].rows(); ++a)
      for (Index b = 0; b < out[k].cols(); ++b)
        out[k](a, b) -= 2 * (assessment_.null[some[index(a)]].mean + assessment_.null[some[index(b)]].mean);
  }
  return out;
}

Matrix Evidence::pair_scores(const std::vector<std::size_t>& some, std::size_t first) const {
  return pair_scores(some, first, Matrix(data_), assessment_.data.criterion)[0];
}

Evidence::ScoresOfNoise Evidence::scores_of_noise(const std::vector<std::size_t>& some, std::size_t first) const {
  const Matrix drawn = noise(criteria.rival_draws, c_.seed ^ 0x9a12ull);
  const Statistics statistics = scan_->run(drawn);
  ScoresOfNoise out{statistics.ratio, pair_scores(some, first, drawn, statistics.criterion)};
  for (std::size_t a = 0; a < candidates_.size(); ++a) out.alone.row(index(a)).array() -= chance(a);
  return out;
}

double Evidence::gain_beside(std::size_t best, std::size_t other) const {
  const std::size_t k = assessment_.data.covariance_model[0];
  return scan_->pair_ratio(best, other, data_, k) - scan_->pair_ratio(best, best, data_, k);
}

} // namespace gumshoe::tracing
