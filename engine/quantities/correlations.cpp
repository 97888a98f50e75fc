#include "quantities/correlations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "quantities/copula.h"

namespace gumshoe::quantities {
namespace {

/// Pearson's coefficients of the samples that are drawn together, n x n.
std::vector<double> of_samples(const SamplePlan& plan, const CopulaGroup& group) {
  const std::size_t n = group.variates.size();
  std::vector<std::vector<double>> scores; // of length one
  for (std::size_t i = 0; i < n; ++i) {
    const auto& values = *plan.variates[group.variates[i]].distribution.values;
    std::vector<double> x;
    for (const std::uint32_t rank : group.together[i]) x.push_back(values[rank]);
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    for (double& one : x) one -= mean;
    const double length = std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0));
    for (double& one : x) one /= length;
    scores.push_back(std::move(x));
  }
  std::vector<double> out(n * n, 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      out[i * n + j] = out[j * n + i] =
          std::clamp(std::inner_product(scores[i].begin(), scores[i].end(), scores[j].begin(), 0.0), -1.0, 1.0);
  return out;
}

} // namespace

Correlations::Correlations(const SamplePlan& plan)
    : plan_(plan), places_(plan.variates.size(), {plan.copulas.size(), 0}),
      estimate_of_(plan.variates.size(), plan.estimates.size()), coefficients_(plan.copulas.size()) {
  for (std::size_t e = 0; e < plan.estimates.size(); ++e)
    for (const std::size_t v : plan.estimates[e].variates) estimate_of_[v] = e;
  for (std::size_t g = 0; g < plan.copulas.size(); ++g)
    for (std::size_t i = 0; i < plan.copulas[g].variates.size(); ++i) places_[plan.copulas[g].variates[i]] = {g, i};
}

double Correlations::coefficient(std::size_t g, std::size_t i, std::size_t j) {
  const CopulaGroup& group = plan_.copulas[g];
  const std::size_t n = group.variates.size();
  if (!group.pearson.empty()) return group.pearson[i * n + j];
  if (!group.together.empty()) {
    if (coefficients_[g].empty()) coefficients_[g] = of_samples(plan_, group);
    return coefficients_[g][i * n + j];
  }
  const double stated = group.matrix[i * n + j];
  if (i == j || stated == 0 || group.multivariate_t()) return stated;
  if (coefficients_[g].empty()) coefficients_[g].assign(n * n, std::numeric_limits<double>::quiet_NaN());
  double& r = coefficients_[g][std::min(i, j) * n + std::max(i, j)];
  if (std::isnan(r))
    r = pearson_coefficient(stated, plan_.variates[group.variates[i]].distribution,
                            plan_.variates[group.variates[j]].distribution);
  return r;
}

double Correlations::between(std::size_t a, std::size_t b) {
  if (a == b) return 1;
  const Place at = places_[a], other = places_[b];
  return at.group == other.group && at.group < groups() ? coefficient(at.group, at.member, other.member) : 0;
}

double Correlations::covariance(std::size_t a, std::size_t b) {
  const double r = between(a, b);
  if (r == 0) return 0; // also where a variance is infinite
  return r * plan_.variates[a].distribution.standard_uncertainty() *
         plan_.variates[b].distribution.standard_uncertainty();
}

} // namespace gumshoe::quantities
