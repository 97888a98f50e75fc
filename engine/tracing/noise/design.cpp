#include "tracing/noise/design.h"

#include <algorithm>

#include "tracing/criteria.h"

namespace gumshoe::tracing {

std::vector<CovarianceModel> covariance_models(const Design& d, std::size_t rows) {
  if (!d.covariance_models.empty()) return d.covariance_models;
  std::vector<double> correlations(criteria.correlations.begin(), criteria.correlations.end());
  if (rows / d.indications < criteria.readings_for_correlation) correlations = {0.0};
  std::vector<CovarianceModel> out;
  for (const double r : correlations) out.push_back({r, -1, 0});
  for (int c = 0; c < static_cast<int>(d.scatter.size()); ++c)
    for (const double ratio : criteria.scatter_ratios)
      for (const double r : correlations) {
        out.push_back({r, c, ratio});
        if (d.indications == 1 || ratio <= criteria.single_scatter_low || ratio >= criteria.single_scatter_high)
          continue;
        for (int i = 0; i < static_cast<int>(d.indications); ++i) out.push_back({r, c, ratio, i});
      }
  return out;
}

std::vector<Index> insensitive(const Design& d, const std::vector<Index>& rows) {
  std::vector<Index> out;
  for (Index j = 0; j < d.fixed.cols(); ++j)
    if (std::ranges::none_of(rows, [&](Index row) { return d.fixed(row, j) != 0; })) out.push_back(j);
  return out;
}

void declare_scatter(Design& d, CovarianceModel& model) {
  if (model.scatter < 0) return;
  const Grouping& g = d.scatter[index(model.scatter)];
  const auto first = d.random.cols(), rows = d.random.rows();
  const std::size_t k = d.indications;
  d.random.conservativeResize(rows, first + index(g.groups.size() * k));
  d.random.rightCols(d.random.cols() - first).setZero();
  for (Index i = 0; i < rows; ++i) {
    const std::size_t indication = index(i) % k;
    if (model.indication >= 0 && indication != index(model.indication)) continue;
    const std::size_t column = g.group[d.reading[index(i)]] * k + indication;
    d.random(i, first + index(column)) = model.ratio * d.reference[indication];
  }
  for (const std::string& name : g.groups) d.random_names.insert(d.random_names.end(), k, name);
  d.bent.resize(index(d.random.cols()), -1);
  model.scatter = model.indication = -1;
  model.ratio = 0;
}

std::vector<Index> independent(const Design& d, const std::vector<Index>& rows) {
  Matrix all(index(rows.size()), d.fixed.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    all.row(index(i)) = d.fixed.row(rows[i]) / d.reference[index(rows[i]) % d.indications];
  std::vector<Index> out;
  Matrix basis(all.rows(), 0);
  for (Index j = 0; j < all.cols(); ++j) {
    const double length = all.col(j).norm();
    if (!(length > 0)) continue;
    Vector x = all.col(j) / length;
    for (int pass = 0; pass < 2; ++pass) x -= basis * (basis.transpose() * x);
    if (x.norm() < 1e-7) continue; // rounding
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = x.normalized();
    out.push_back(j);
  }
  return out;
}

} // namespace gumshoe::tracing
