#include "analysis/gum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/combine.h"
#include "analysis/differences.h"
#include "analysis/reach.h"
#include "analysis/tolerance.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

std::string scope_text(const quantities::Component& component) {
  std::string text;
  for (const std::string& label : component.per) text += (text.empty() ? "per " : ", ") + label;
  return text;
}

namespace {

std::string family_name(quantities::Family family) {
  for (const auto& card : quantities::families())
    if (card.family == family) return std::string(card.name);
  return "";
}

/// The second derivatives are as many as the square of that, each at the cost of the model.
constexpr std::ptrdiff_t most_second_order = 100;

/// Derivatives of all measurands of one reading at the estimates; the higher ones are found when first asked for.
class Slopes {
public:
  Slopes(const propagation::Experiment& e, std::size_t reading, const propagation::Workers& workers)
      : e_(e), reading_(reading), point_(e.point(reading)) {
    if (stencils_at_estimates(e)) stencil_ = stencil_values(e, reading, workers);
  }

  const std::vector<double>& point() const { return point_; }
  std::size_t reading() const { return reading_; }
  const Derivatives& first(std::size_t measurand) { return at_estimates(first_, false)[measurand]; }
  const Derivatives& second(std::size_t measurand) { return at_estimates(second_, true)[measurand]; }
  /// First derivatives where quantity q is shifted by that much, which is always the same.
  const Derivatives& shifted(std::size_t measurand, std::size_t q, double by) {
    std::vector<double> at = point_;
    at[q] += by;
    return of(shifted_[{q, by > 0}], at, false)[measurand];
  }

private:
  using All = std::vector<Derivatives>;
  const All& at_estimates(All& known, bool second) {
    if (known.empty() && stencil_) known = differences_from(*stencil_, e_, reading_, second);
    return of(known, point_, second);
  }
  const All& of(All& known, const std::vector<double>& at, bool second) {
    if (known.empty()) known = differentiate(e_, reading_, at, second);
    return known;
  }

  const propagation::Experiment& e_;
  std::size_t reading_;
  std::vector<double> point_;
  std::optional<propagation::Responses> stencil_; ///< where derivatives are differences
  All first_, second_;
  std::map<std::pair<std::size_t, bool>, All> shifted_;
};

/// Central moments of a quantity at a reading, summed over its variates.
struct CentralMoments {
  double u = 0, third = 0;
  double fourth() const { return cumulant_ + 3 * u * u * u * u; }

  /// A t is taken as the law of propagation takes it: normal, with its u.
  void add(const quantities::Distribution& d, double by) {
    const bool normal = by == 0 || d.family == quantities::Family::t;
    u = std::hypot(u, by);
    third += normal ? 0 : d.skewness() * by * by * by;
    cumulant_ += normal ? 0 : (d.kurtosis() - 3) * by * by * by * by;
  }

private:
  double cumulant_ = 0;
};

/// The terms of 5.1.2 note, of independent inputs with their own moments m3, m4 (of normal ones 0 and 3 u^4, as the
/// note has them), to the fourth power of u: sum over i of
///     (H_ii^2 (m4 - u^4) / 4 + c_i H_ii m3 + c_i d^3f/dx_i^3 m4 / 3)
/// and over i /= j of (H_ij^2 / 2 + c_i d^3f/dx_i dx_j^2) u_i^2 u_j^2; and the bias sum of H_ii u_i^2 / 2. Quantities,
/// not variates. Third derivatives are differences of exact first ones over u / 64: the error is 2e-5 of the next term
/// of the series, the noise 1e-12 of c_i.
void second_order(Budget& b, Slopes& slopes, std::size_t measurand, const std::vector<CentralMoments>& moments) {
  const std::size_t n = moments.size();
  std::vector<double> u;
  for (const CentralMoments& m : moments) u.push_back(m.u);
  Derivatives at;
  if (has_second_order(u))
    at = slopes.second(measurand);
  else
    b.remark = fmt::format("no terms of second order: more than {} inputs vary", most_second_order);
  if (at.second.empty()) { // a kink by some quantity that is exact here: first order holds, second does not
    b.second_order_uncertainty = b.second_order_bias = nan;
    return;
  }
  double extra = 0;
  constexpr double fraction = 1.0 / 64;
  for (std::size_t j = 0; j < n; ++j) {
    if (u[j] == 0) continue;
    b.second_order_bias += 0.5 * at.second[j * n + j] * u[j] * u[j];
    Derivatives above, below;
    if (at.exact) {
      above = slopes.shifted(measurand, j, fraction * u[j]);
      below = slopes.shifted(measurand, j, -fraction * u[j]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (u[i] == 0) continue;
      const double h = at.second[i * n + j], squares = u[i] * u[i] * u[j] * u[j];
      double third = at.exact
                         ? (above.first[i] - 2 * at.first[i] + below.first[i]) / (fraction * u[j] * fraction * u[j])
                         : at.third[i * n + j];
      if (!std::isfinite(third)) third = 0;
      const double fourth = moments[i].fourth();
      extra += i == j ? h * h * (fourth - squares) / 4 + at.first[i] * (h * moments[i].third + third * fourth / 3)
                      : (0.5 * h * h + at.first[i] * third) * squares;
    }
  }
  const double variance = b.combined_standard_uncertainty * b.combined_standard_uncertainty + extra;
  b.second_order_uncertainty = variance < 0 ? nan : std::sqrt(variance);
  if (variance < 0)
    b.remark = "no terms of second order: they exceed the variance, so that the series is of no use here";
}

/// Derivatives at the estimates; says in the budget why there are none.
Derivatives linearise(const propagation::Experiment& e, Slopes& slopes, std::size_t measurand, Budget& b) {
  if (e.scenario().method == scenario::Method::virtual_experiment) {
    b.applicable = false;
    b.reason =
        "a virtual experiment draws the truth and evaluates at the estimates: its inputs have no measurement model";
    Derivatives none;
    none.first.assign(slopes.point().size(), nan);
    none.differentiable.assign(slopes.point().size(), true);
    return none;
  }
  Derivatives d = slopes.first(measurand);
  b.estimate = d.value;
  if (d.status != Status::ok) {
    b.applicable = false;
    b.reason = "the model has no value at the estimates";
  }
  return d;
}

/// The row of one variate: it moves all quantities that it is part of at the reading.
Contribution contribution_of(const propagation::Experiment& e, const Reach& reach, const std::vector<double>& point,
                             const Derivatives& d) {
  const auto& variate = e.plan().variates[reach.variate];
  const auto& quantity = e.scenario().quantities[variate.quantity];
  const auto& component = quantity.entries[variate.entry].components[variate.component];
  Contribution c;
  c.name = variate.name;
  c.quantity = quantity.name;
  c.unit = quantity.unit;
  c.si_unit = quantity.si_unit;
  c.estimate = point[reach.quantities[0]];
  c.standard_uncertainty = variate.distribution.standard_uncertainty();
  c.evaluation = component.evaluation;
  c.distribution = family_name(variate.distribution.family);
  c.degrees_of_freedom = component.degrees_of_freedom;
  for (const std::size_t q : reach.quantities) {
    c.differentiable = c.differentiable && d.differentiable[q];
    c.sensitivity += d.first[q];
  }
  c.contribution = std::fabs(c.sensitivity) * c.standard_uncertainty;
  c.monte_carlo_share = nan;
  c.scope = scope_text(component);
  c.source = component.source;
  return c;
}

/// The input draws in which the model has no derivative, by their labels; those of a quantity that has many by number.
std::string without_derivative(const std::vector<Contribution>& contributions) {
  constexpr std::size_t most_named = 3;
  std::vector<std::pair<std::string, std::vector<std::string>>> by_quantity;
  for (const Contribution& c : contributions) {
    if (c.differentiable || !(c.standard_uncertainty > 0)) continue;
    auto at = std::ranges::find(by_quantity, c.quantity, [](const auto& q) { return q.first; });
    if (at == by_quantity.end()) at = by_quantity.insert(at, {c.quantity, {}});
    const std::string name = c.name.substr(0, c.name.find(": ")); // without the component's
    if (std::ranges::find(at->second, name) == at->second.end()) at->second.push_back(name);
  }
  std::string out;
  for (const auto& [quantity, names] : by_quantity) {
    if (!out.empty()) out += ", ";
    out += names.size() > most_named ? fmt::format("{} ({} of its input draws)", quantity, names.size())
                                     : fmt::format("{}", fmt::join(names, ", "));
  }
  return out;
}

Budget budget_of(const propagation::Experiment& e, std::size_t output, double coverage_probability, Slopes& slopes) {
  Budget b;
  b.output = e.outputs()[output];
  b.monte_carlo_interactions = nan;
  const std::size_t measurand = output % e.measurands().size();
  const std::vector<double>& point = slopes.point();
  const Derivatives d = linearise(e, slopes, measurand, b);

  std::vector<CentralMoments> moments(point.size());
  std::vector<Term> terms;
  bool several = false; // quantities that one variate moves: they are not independent
  for (const Reach& reach : variates_reaching(e, slopes.reading())) {
    const Contribution c = contribution_of(e, reach, point, d);
    if (!c.differentiable && c.standard_uncertainty > 0) b.applicable = false;
    const double signed_contribution = c.differentiable && b.applicable ? c.sensitivity * c.standard_uncertainty : 0;
    if (!std::isfinite(signed_contribution) && c.standard_uncertainty > 0 && std::isfinite(c.standard_uncertainty)) {
      b.applicable = false;
      b.reason += fmt::format("{}the contribution of {} is not finite", b.reason.empty() ? "" : "; ", c.quantity);
    }
    terms.push_back({reach.variate, signed_contribution, c.degrees_of_freedom});
    for (const std::size_t q : reach.quantities)
      moments[q].add(e.plan().variates[reach.variate].distribution, c.standard_uncertainty);
    several = several || (reach.quantities.size() > 1 && c.standard_uncertainty > 0);
    b.contributions.push_back(c);
  }
  if (b.reason.empty())
    if (const std::string inputs = without_derivative(b.contributions); !inputs.empty())
      b.reason = "there is no derivative at the estimate with respect to " + inputs;
  quantities::Correlations correlations(e.plan());
  const CombinedVariance combined = b.applicable ? combine(terms, correlations) : CombinedVariance();
  const double total = combined.total();
  if (std::isinf(total)) {
    b.applicable = false;
    b.reason = "the framework's uncertainty is not finite";
  }
  if (!b.applicable) {
    b.combined_standard_uncertainty = b.expanded_uncertainty = b.second_order_uncertainty = b.coverage_factor = nan;
    for (Contribution& c : b.contributions) c.share = nan;
    return b;
  }
  b.combined_standard_uncertainty = std::sqrt(total);
  for (Contribution& c : b.contributions) c.share = total > 0 ? c.contribution * c.contribution / total : 0;
  b.correlation_share = total > 0 ? combined.correlation / total : 0;

  const Expansion expansion = expand(combined, coverage_probability);
  b.effective_degrees_of_freedom = expansion.effective_degrees_of_freedom;
  b.coverage_factor = expansion.coverage_factor;
  b.expanded_uncertainty = expansion.expanded_uncertainty;
  if (combined.unequal)
    b.remark =
        "no effective degrees of freedom: correlated inputs have different degrees of freedom, or those of earlier "
        "results, and the Welch-Satterthwaite formula (G.4.1) holds for independent ones; k is the normal quantile";
  if (combined.correlation != 0 || several)
    b.second_order_uncertainty = b.second_order_bias = nan;
  else
    second_order(b, slopes, measurand, moments);
  return b;
}

} // namespace

bool has_second_order(const std::vector<double>& u) {
  return std::ranges::count_if(u, [](double x) { return x > 0; }) <= most_second_order;
}

Budget budget(const propagation::Experiment& e, std::size_t output, double coverage_probability) {
  Slopes slopes(e, e.outputs()[output].reading, 1);
  return budget_of(e, output, coverage_probability, slopes);
}

std::vector<Budget> budgets(const propagation::Experiment& e, std::size_t first, double coverage_probability,
                            const propagation::Workers& workers) {
  Slopes slopes(e, e.outputs()[first].reading, workers);
  std::vector<Budget> out;
  for (std::size_t m = 0; m < e.measurands().size(); ++m)
    out.push_back(budget_of(e, first + m, coverage_probability, slopes));
  return out;
}

bool contributions_cancel(const Budget& b) { return b.correlation_share < -1; }

double uncorrelated_uncertainty(const Budget& b) {
  double u = 0;
  for (const Contribution& c : b.contributions) u = std::hypot(u, c.contribution);
  return u;
}

bool any_uncertain(const Budget& b) {
  return std::ranges::any_of(b.contributions, [](const Contribution& c) { return c.standard_uncertainty > 0; });
}

double spacing_of_doubles(double at) {
  at = std::fabs(at);
  return std::nextafter(at, std::numeric_limits<double>::infinity()) - at;
}

bool resolved(const Summary& s, double u) {
  constexpr double enough = 4; // rounding to steps of u/4 widens u by 0.3 %
  return !(u > 0) || !std::isfinite(s.estimate) || u >= enough * spacing_of_doubles(s.estimate);
}

} // namespace gumshoe::analysis
