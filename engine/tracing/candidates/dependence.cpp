#include <algorithm>

#include "tracing/candidates/candidates.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Share of x's variance between groups of equal values.
double explained(const Vector& x, const std::vector<std::size_t>& group) {
  const std::size_t groups = *std::ranges::max_element(group) + 1;
  std::vector<double> sum(groups, 0), count(groups, 0);
  for (std::size_t i = 0; i < group.size(); ++i) sum[group[i]] += x[index(i)], ++count[group[i]];
  const double mean = x.mean(), total = (x.array() - mean).square().sum();
  double between = 0;
  for (std::size_t g = 0; g < groups; ++g)
    if (count[g] > 0) between += count[g] * (sum[g] / count[g] - mean) * (sum[g] / count[g] - mean);
  const double n = static_cast<double>(group.size()), k = static_cast<double>(groups);
  if (!(total > 0) || n <= k) return 0;
  return 1 - (total - between) / total * (n - 1) / (n - k);
}

} // namespace

std::vector<std::string> dependence(const Observations& o, const Matrix& columns) {
  const auto k = index(o.indications);
  std::vector<std::string> out;
  const auto depends = [&](const std::vector<std::size_t>& by_reading) {
    std::vector<std::size_t> group;
    for (const std::size_t r : o.sequence) group.push_back(by_reading[r]);
    for (Index j = 0; j < columns.cols(); ++j)
      for (Index i = 0; i < k; ++i) {
        const Vector x = columns(Eigen::seq(i, Eigen::last, k), j);
        if (!(x.norm() > 1e-9 * columns.norm())) continue;
        if (std::max(explained(x, group), explained(x.cwiseAbs(), group)) > criteria.dependence_share) return true;
      }
    return false;
  };
  for (const Covariate& c : o.covariates)
    if (depends(neighbours(c, criteria.dependence_bins))) out.push_back(c.name);
  for (const Grouping& g : o.labels)
    if (out.empty() && g.groups.size() <= criteria.most_label_groups && depends(g.group)) out.push_back(g.name);
  return out;
}

} // namespace gumshoe::tracing
