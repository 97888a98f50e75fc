#include "tracing/judgement/form_tuning.h"

#include <algorithm>
#include <cmath>

#include "tracing/candidates/forms.h"
#include "tracing/criteria.h"
#include "tracing/judgement/apart.h"

namespace gumshoe::tracing {
namespace {

constexpr double farthest = 0.25; ///< one step: a quarter of the cycles that the range resolves, of a time constant
constexpr double settled = 0.05;  ///< step in standard uncertainties below which a parameter stays
constexpr int most_steps = 8;

/// Change of the readings per unit of the parameter.
Vector derivative(const Observations& o, const Term& term) {
  constexpr double h = 1e-3;
  const auto columns = [&](double by) {
    return with_parameter(o, term.candidate, term.candidate.parameter + by).columns;
  };
  return (columns(h) - columns(-h)) * term.size / (2 * h);
}

/// The step that is taken where one of `wanted` is best.
double step_of(const Observations& o, const Candidate& shape, double wanted) {
  const auto [low, high] = parameter_limits(o, shape);
  return std::clamp(shape.parameter + std::clamp(wanted, -farthest, farthest), low, high) - shape.parameter;
}

bool has_parameter(const Term& t) {
  return t.candidate.form != Form::fixed && t.size.size() == (t.candidate.form == Form::wave ? 2 : 1);
}

} // namespace

JointFit with_tuned_forms(const TraceContext& c, JointFit fit) {
  std::vector<std::size_t> sought;
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    if (has_parameter(fit.terms[t])) sought.push_back(t);
  bool more = !sought.empty();
  for (int step = 0; more && step < most_steps; ++step) {
    Design design = fit.design;
    const Index first = design.fixed.cols(), n = index(sought.size());
    design.fixed.conservativeResize(Eigen::NoChange, first + n);
    for (Index w = 0; w < n; ++w) design.fixed.col(first + w) = derivative(c.observations, fit.terms[sought[index(w)]]);
    const auto use = independent(design, c.fitter.rows());
    const Whitened plain(design, c.fitter.rows(), use, {}), white(plain, fit.covariance_model);
    Matrix covariance;
    const Vector x = white.coefficients(plain.winsorised(plain.take(fit.residual)), &covariance);
    more = false;
    std::vector<Term> terms = fit.terms;
    for (Index w = 0; w < n; ++w) {
      const auto at = std::ranges::find(use, first + w);
      if (at == use.end()) continue;
      const Index j = at - use.begin();
      Term& term = terms[sought[index(w)]];
      const double u = std::sqrt(covariance(j, j) * fit.variance), by = step_of(c.observations, term.candidate, x[j]);
      const std::size_t t = sought[index(w)];
      fit.terms[t].candidate.parameter_u = term.candidate.parameter_u = u;
      if (const auto size = std::ranges::find(use, first_column(fit, t)); size != use.end())
        fit.terms[t].candidate.size_u = term.candidate.size_u =
            std::sqrt(covariance(size - use.begin(), size - use.begin()) * fit.variance);
      if (std::fabs(by) <= settled * u) continue;
      more = true;
      Candidate tuned = with_parameter(c.observations, term.candidate, term.candidate.parameter + by);
      Candidate own = apart(tuned, fit, c.observations, c.fitter.rows());
      term.candidate = own.columns.cols() == tuned.columns.cols() ? std::move(own) : std::move(tuned);
    }
    if (!more) break;
    JointFit next = c.fitter.fit(terms, fit.noise, &fit);
    if (!next.valid || next.criterion > fit.criterion) break;
    fit = std::move(next);
  }
  return fit;
}

} // namespace gumshoe::tracing
