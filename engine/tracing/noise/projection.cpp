#include "tracing/noise/projection.h"

#include <algorithm>

#include "tracing/noise/sparse_columns.h"

namespace gumshoe::tracing {
namespace {

/// Share of a column's length below which what others leave of it is rounding.
constexpr double rounding = 1e-9;

/// Sum over all rows of the square of the number of columns open at it: what it takes to eliminate them.
double work(const std::vector<SparseRow>& rows, std::size_t columns, const std::vector<Index>& order) {
  std::vector<std::size_t> last(columns, 0);
  std::vector<bool> opened(columns, false);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const auto& [column, value] : rows[index(order[i])]) last[column] = i;
  double open = 0, out = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    double closing = 0;
    for (const auto& [column, value] : rows[index(order[i])]) {
      if (!opened[column]) ++open;
      opened[column] = true;
      if (last[column] == i) ++closing;
    }
    out += open * open;
    open -= closing;
  }
  return out;
}

} // namespace

Projection::Projection(const std::vector<SparseRow>& rows, std::size_t columns,
                       const std::vector<std::vector<Index>>& orders)
    : order_(*std::ranges::min_element(orders, {}, [&](const auto& order) { return work(rows, columns, order); })) {
  std::vector<SparseRow> ordered;
  for (const Index i : order_) ordered.push_back(rows[index(i)]);
  std::vector<std::size_t> number(columns, 0);
  for (const std::size_t j : redundant(ordered, columns, rounding)) number[j] = columns;
  for (std::size_t& j : number)
    if (j < columns) j = rank_++;
  for (SparseRow& row : ordered) {
    std::erase_if(row, [&](const auto& entry) { return number[entry.first] == columns; });
    for (auto& entry : row) entry.first = number[entry.first];
  }
  elimination_.emplace(ordered, rank_, rank_);
}

Matrix Projection::operator()(const Matrix& x) const {
  const Matrix left = elimination_->projected(x(order_, Eigen::all));
  Matrix out(x.rows(), x.cols());
  out(order_, Eigen::all) = left;
  return out;
}

Vector Projection::squares(const Matrix& x) const { return elimination_->squares(x(order_, Eigen::all)); }

} // namespace gumshoe::tracing
