#include "analysis/gum.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "analysis/derivatives.h"
#include "analysis/reach.h"
#include "analysis/tolerance.h"
#include "quantities/copula.h"

namespace gumshoe::analysis {

std::string scope_text(const quantities::Component& component) {
  std::string text;
  for (const std::string& label : component.per) text += (text.empty() ? "per " : ", ") + label;
  return text;
}

double correlation_of(const quantities::SamplePlan& plan, std::size_t a, std::size_t b) {
  for (const auto& group : plan.copulas) {
    const auto i = std::ranges::find(group.variates, a), j = std::ranges::find(group.variates, b);
    if (i != group.variates.end() && j != group.variates.end())
      return quantities::pearson_coefficient(
          group.matrix[static_cast<std::size_t>(i - group.variates.begin()) * group.variates.size() +
                       static_cast<std::size_t>(j - group.variates.begin())],
          plan.variates[a].distribution, plan.variates[b].distribution);
  }
  return 0;
}

Expansion expand(double variance, double satterthwaite, bool correlated, double coverage_probability) {
  Expansion x;
  if (correlated)
    x.effective_degrees_of_freedom = std::nan(""); // G.4.1 holds for independent inputs only
  else if (satterthwaite > 0)
    x.effective_degrees_of_freedom =
        std::floor(variance * variance / satterthwaite * (1 + 1e-12)) /* G.4.1, not one less by rounding */;
  const double tail = 0.5 * (1 + coverage_probability);
  if (x.effective_degrees_of_freedom >= 1 && x.effective_degrees_of_freedom < 1e6) {
    x.coverage_factor = quantile(boost::math::students_t(x.effective_degrees_of_freedom), tail);
  } else {
    if (!correlated) x.effective_degrees_of_freedom = 0;
    x.coverage_factor = quantile(boost::math::normal(), tail);
  }
  x.expanded_uncertainty = x.coverage_factor * std::sqrt(std::max(0.0, variance));
  return x;
}

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string family_name(quantities::Family family) {
  for (const auto& card : quantities::families())
    if (card.family == family) return std::string(card.name);
  return "";
}

/// The terms of 5.1.2 note: sum over i, j of [H_ij^2 / 2 + c_i d^3f/dx_i dx_j^2] u_i^2 u_j^2 (inputs
/// symmetric and independent), and the bias sum of H_ii u_i^2 / 2. Quantities, not variates: u by quantity.
void second_order(Budget& b, const propagation::Experiment& e, std::size_t reading, std::size_t measurand,
                  const std::vector<double>& point, const std::vector<double>& u) {
  const Derivatives at = differentiate(e, reading, measurand, point, true);
  const std::size_t n = point.size();
  if (at.second.empty()) { // a kink by some quantity that is exact here: first order holds, second does not
    b.second_order_uncertainty = b.second_order_bias = nan;
    return;
  }
  double extra = 0;
  for (std::size_t j = 0; j < n; ++j) {
    if (u[j] == 0) continue;
    b.second_order_bias += 0.5 * at.second[j * n + j] * u[j] * u[j];
    Derivatives above, below;
    if (at.exact) {
      auto up = point, down = point;
      up[j] += u[j];
      down[j] -= u[j];
      above = differentiate(e, reading, measurand, up, false);
      below = differentiate(e, reading, measurand, down, false);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (u[i] == 0) continue;
      const double h = at.second[i * n + j];
      const double third = at.exact ? (above.first[i] - 2 * at.first[i] + below.first[i]) / (u[j] * u[j])
                                    : at.third[i * n + j];
      extra += (0.5 * h * h + (std::isfinite(third) ? at.first[i] * third : 0)) * u[i] * u[i] * u[j] * u[j];
    }
  }
  b.second_order_uncertainty =
      std::sqrt(std::max(0.0, b.combined_standard_uncertainty * b.combined_standard_uncertainty + extra));
}

/// Derivatives at the estimates; says in the budget why there are none.
Derivatives linearise(const propagation::Experiment& e, std::size_t reading, std::size_t measurand,
                      const std::vector<double>& point, Budget& b) {
  if (e.scenario().method == scenario::Method::virtual_experiment) {
    b.applicable = false;
    b.reason =
        "a virtual experiment draws the truth and evaluates at the estimates: its inputs have no measurement model";
    Derivatives none;
    none.first.assign(point.size(), nan);
    none.differentiable.assign(point.size(), true);
    return none;
  }
  Derivatives d = differentiate(e, reading, measurand, point, false);
  b.estimate = d.value;
  if (d.status != Status::ok) {
    b.applicable = false;
    b.reason = "the model has no value at the estimates";
  }
  return d;
}

/// The row of one variate, which is part of quantity q at the reading.
Contribution contribution_of(const propagation::Experiment& e, std::size_t v, std::size_t q, double estimate,
                             const Derivatives& d) {
  const auto& variate = e.plan().variates[v];
  const auto& quantity = e.scenario().quantities[variate.quantity];
  const auto& component = quantity.entries[variate.entry].components[variate.component];
  Contribution c;
  c.name = variate.name;
  c.quantity = quantity.name;
  c.unit = quantity.unit;
  c.si_unit = quantity.si_unit;
  c.estimate = estimate;
  const double u2 = variate.distribution.variance();
  c.standard_uncertainty = std::isfinite(u2) ? std::sqrt(u2) : nan;
  c.evaluation = component.evaluation;
  c.distribution = family_name(variate.distribution.family);
  c.degrees_of_freedom = component.degrees_of_freedom;
  // The framework takes a Type A mean's s/sqrt(n) itself (GUM 4.2.3); the t's own, larger, standard
  // deviation belongs to the Monte Carlo method (JCGM 101 6.4.9).
  if (variate.distribution.family == quantities::Family::t) {
    c.standard_uncertainty = variate.distribution.parameters[1];
    c.degrees_of_freedom = variate.distribution.parameters[2];
  }
  c.differentiable = d.differentiable[q];
  c.sensitivity = d.first[q];
  c.contribution = std::fabs(d.first[q]) * c.standard_uncertainty;
  c.monte_carlo_share = nan;
  c.scope = scope_text(component);
  c.source = component.source;
  return c;
}

} // namespace

Budget budget(const propagation::Experiment& e, std::size_t output, double coverage_probability) {
  Budget b;
  b.output = e.outputs()[output];
  b.monte_carlo_interactions = nan;
  const std::size_t reading = b.output.reading, measurand = output % e.measurands().size();
  const auto point = e.point(reading);
  const Derivatives d = linearise(e, reading, measurand, point, b);

  double variance = 0, cross = 0, satterthwaite = 0;
  bool correlated = false;
  std::vector<double> u_of_quantity(point.size(), 0.0), signed_contributions;
  const auto reached = variates_reaching(e, reading);
  for (const auto& [v, q] : reached) {
    const Contribution c = contribution_of(e, v, q, point[q], d);
    if (!c.differentiable && c.standard_uncertainty > 0) {
      b.applicable = false;
      b.reason += (b.reason.empty() ? "there is no derivative at the estimate with respect to " : ", ") + c.quantity;
    }
    const double signed_contribution = c.differentiable && b.applicable ? d.first[q] * c.standard_uncertainty : 0;
    variance += signed_contribution * signed_contribution;
    if (c.degrees_of_freedom > 0) satterthwaite += std::pow(signed_contribution, 4) / c.degrees_of_freedom;
    u_of_quantity[q] = std::hypot(u_of_quantity[q], c.standard_uncertainty);
    signed_contributions.push_back(signed_contribution);
    b.contributions.push_back(c);
  }
  if (!b.applicable) {
    b.combined_standard_uncertainty = b.expanded_uncertainty = b.second_order_uncertainty = b.coverage_factor = nan;
    for (Contribution& c : b.contributions) c.share = nan;
    return b;
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const double r = correlation_of(e.plan(), reached[i].variate, reached[j].variate); r != 0) {
        correlated = true;
        cross += 2 * r * signed_contributions[i] * signed_contributions[j];
      }
  const double total = variance + cross;
  b.combined_standard_uncertainty = std::sqrt(std::max(0.0, total));
  for (Contribution& c : b.contributions) c.share = total > 0 ? c.contribution * c.contribution / total : 0;
  b.correlation_share = total > 0 ? cross / total : 0;

  const Expansion expansion = expand(total, satterthwaite, correlated, coverage_probability);
  b.effective_degrees_of_freedom = expansion.effective_degrees_of_freedom;
  b.coverage_factor = expansion.coverage_factor;
  b.expanded_uncertainty = expansion.expanded_uncertainty;
  if (correlated && satterthwaite > 0)
    b.remark =
        "no effective degrees of freedom: the inputs are correlated, and the Welch-Satterthwaite formula (G.4.1) "
        "holds for independent ones; k is the normal quantile";
  if (correlated)
    b.second_order_uncertainty = b.second_order_bias = nan;
  else
    second_order(b, e, reading, measurand, point, u_of_quantity);
  return b;
}

Validation validate(const Budget& b, const Summary& s, int digits) {
  Validation v;
  v.output = b.output;
  v.digits = digits;
  if (!b.applicable) {
    v.verdict = "not applicable";
    v.reason = b.reason;
    v.delta = v.d_low = v.d_high = v.monte_carlo_tolerance = nan;
    return v;
  }
  const double u = b.combined_standard_uncertainty;
  if (!(u > 0) || s.valid < 2) {
    v.verdict = u > 0 ? "undecided" : "not validated";
    v.reason = u > 0 ? "too few samples" : "the framework's standard uncertainty is zero";
    if (u == 0 && s.standard_uncertainty == 0) v.verdict = "validated", v.reason = "no input is uncertain";
    return v;
  }
  v.delta = numerical_tolerance(u, digits, b.output);
  v.d_low = std::fabs(b.estimate - b.expanded_uncertainty - s.symmetric.low);
  v.d_high = std::fabs(b.estimate + b.expanded_uncertainty - s.symmetric.high);
  v.monte_carlo_tolerance = 2 * std::max(s.symmetric.low_se, s.symmetric.high_se);
  const double worst = std::max(v.d_low, v.d_high);
  if (std::isnan(v.monte_carlo_tolerance)) {
    v.verdict = "undecided";
    v.reason = "the Monte Carlo tolerance is unknown: the design's points are not independent";
  } else if (worst - v.monte_carlo_tolerance > v.delta) { // plain enough, however uncertain the ends are
    v.verdict = "not validated";
    v.reason = "an end differs by more than delta";
  } else if (v.monte_carlo_tolerance > v.delta / 5) {
    v.verdict = "undecided";
    v.reason = "the Monte Carlo tolerance exceeds a fifth of delta; use more samples";
  } else if (worst > v.delta) {
    v.verdict = "undecided";
    v.reason = "the difference of an end and delta agree within the Monte Carlo tolerance; use more samples";
  } else {
    v.verdict = "validated";
    v.reason = "both ends agree within delta";
  }
  return v;
}

} // namespace gumshoe::analysis
