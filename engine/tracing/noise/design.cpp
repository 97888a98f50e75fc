#include "tracing/noise/design.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tracing/criteria.h"
#include "tracing/noise/sparse_columns.h"

namespace gumshoe::tracing {

std::vector<CovarianceModel> covariance_models(const Design& d, std::size_t rows) {
  if (!d.covariance_models.empty()) return d.covariance_models;
  std::vector<double> correlations(criteria.correlations.begin(), criteria.correlations.end());
  if (!d.order_known || rows / d.indications < criteria.readings_for_correlation) correlations = {0.0};
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

double noise_of_row(const Design& design, Index row) {
  const auto k = index(design.indications);
  return design.local[index(row / k)].row(row % k).norm();
}

double readouts_of_row(const Design& d, Index row) {
  return d.readouts.empty() ? 1 : d.readouts[index(row) / d.indications];
}

double least_scale(const Design& d, const std::vector<Index>& rows) {
  if (d.step.empty() || rows.empty()) return 0;
  double squares = 0;
  for (const Index row : rows) {
    const std::size_t k = index(row) % d.indications;
    // What coarse steps do to one readout they do to all of the mean.
    const double each = !d.coarse.empty() && d.coarse[k] ? 1 : readouts_of_row(d, row);
    squares += std::pow(d.step[k] / noise_of_row(d, row), 2) / each;
  }
  return std::sqrt(squares / 12 / static_cast<double>(rows.size()));
}

double hidden_squares(const Design& d, const std::vector<Index>& rows) {
  std::vector<Index> coarse;
  if (!d.coarse.empty())
    std::ranges::copy_if(rows, std::back_inserter(coarse),
                         [&](Index row) { return d.coarse[index(row) % d.indications]; });
  return static_cast<double>(coarse.size()) * std::pow(least_scale(d, coarse), 2);
}

std::vector<Index> insensitive(const Design& d, const std::vector<Index>& rows) {
  std::vector<Index> out;
  for (Index j = 0; j < d.fixed.cols(); ++j)
    if (std::ranges::none_of(rows, [&](Index row) { return d.fixed(row, j) != 0; })) out.push_back(j);
  return out;
}

std::vector<Index> independent(const Design& d, const std::vector<Index>& rows) {
  const auto columns = index(d.fixed.cols());
  std::vector<SparseRow> sparse(rows.size());
  for (std::size_t j = 0; j < columns; ++j) {
    if (!d.fixed.col(index(j)).allFinite()) continue; // serves no fit
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (const double x = d.fixed(rows[i], index(j)); x != 0)
        sparse[i].push_back({j, x / d.reference[index(rows[i]) % d.indications]});
  }
  std::vector<Index> out;
  auto left_out = explained_by_earlier(sparse, columns);
  left_out.push_back(columns); // the end
  for (std::size_t j = 0, next = 0; j < columns; ++j)
    if (left_out[next] == j)
      ++next;
    else
      out.push_back(index(j));
  return out;
}

void add_fixed(Design& design, const std::vector<Index>& rows, const Matrix& columns) {
  design.fixed.conservativeResize(Eigen::NoChange, design.fixed.cols() + columns.cols());
  design.fixed.rightCols(columns.cols()).setZero();
  design.fixed(rows, Eigen::lastN(columns.cols())) = columns;
}

Design without_components(Design design) {
  design.scatter.clear();
  std::erase_if(design.covariance_models, [](const CovarianceModel& m) { return m.scatter >= 0; });
  return design;
}

} // namespace gumshoe::tracing
