#include "tracing/noise/sparse_columns.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gumshoe::tracing {
namespace {

/// Share of a column's length below which an unknown's column is taken to be explained by those before it.
constexpr double negligible = 1e-7;

std::vector<SparseRow> of_unit_length(const std::vector<SparseRow>& rows, std::size_t columns) {
  std::vector<double> square(columns, 0);
  for (const SparseRow& row : rows)
    for (const auto& [column, value] : row) square[column] += value * value;
  std::vector<SparseRow> out = rows;
  for (SparseRow& row : out)
    for (auto& [column, value] : row)
      if (square[column] > 0) value /= std::sqrt(square[column]);
  return out;
}

/// By row of the result: coefficients of a linear relation among columns of unit length, the largest of size one. Each
/// holds one of the redundant columns.
Matrix relations(const std::vector<SparseRow>& rows, std::size_t columns, const std::vector<std::size_t>& redundant) {
  std::vector<std::size_t> place(columns, 0);
  for (const std::size_t j : redundant) place[j] = 1;
  std::size_t kept = 0, left_out = 0;
  for (std::size_t& j : place) j = j == 0 ? kept++ : columns + left_out++;
  std::vector<SparseRow> others(rows.size());
  Matrix y = Matrix::Zero(index(rows.size()), index(left_out));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& [column, value] : rows[i])
      if (place[column] < columns)
        others[i].push_back({place[column], value});
      else
        y(index(i), index(place[column] - columns)) = value;
  const Matrix solved = Elimination(others, kept, kept).solved(y);
  Matrix out = Matrix::Zero(index(left_out), index(columns));
  for (std::size_t j = 0; j < columns; ++j)
    if (place[j] < columns)
      out.col(index(j)) = solved.row(index(place[j])).transpose();
    else
      out(index(place[j] - columns), index(j)) = -1;
  for (Index i = 0; i < out.rows(); ++i) out.row(i) /= out.row(i).cwiseAbs().maxCoeff();
  return out;
}

} // namespace

void SparseColumns::add_reading(Index first, Vector values) {
  const auto k = values.size();
  design_.local[index(chosen_[index(first)] / k)].triangularView<Eigen::Lower>().solveInPlace(values);
  for (Index a = 0; a < k; ++a)
    if (values[a] != 0) rows_[index(first + a)].push_back({count_, values[a]});
}

void SparseColumns::add(const Eigen::Ref<const Matrix>& columns) {
  const auto k = index(design_.indications);
  Vector own(k);
  for (Index j = 0; j < columns.cols(); ++j, ++count_)
    for (Index i = 0; i < index(chosen_.size()); i += k) {
      for (Index a = 0; a < k; ++a) own[a] = columns(chosen_[index(i + a)], j);
      if ((own.array() != 0).any()) add_reading(i, own);
    }
}

void SparseColumns::add_by_group(const std::vector<std::size_t>& group, bool line, std::size_t least) {
  const auto k = index(design_.indications);
  std::map<std::size_t, std::vector<Index>> readings; // by group: their first rows among those chosen
  for (Index i = 0; i < index(chosen_.size()); i += k) readings[group[index(chosen_[index(i)] / k)]].push_back(i);
  for (const auto& [number, first] : readings) {
    if (first.size() < least) continue;
    const Index middle = chosen_[index(first[first.size() / 2])];
    for (Index j = 0; j < k; ++j, ++count_)
      for (const Index i : first) {
        const double value = line ? static_cast<double>(chosen_[index(i)] - middle) : 1.0;
        if (value != 0) add_reading(i, value * Vector::Unit(k, j));
      }
  }
}

std::vector<std::size_t> redundant(const std::vector<SparseRow>& rows, std::size_t columns, double least) {
  // All that is neglected of one column stays below that share, and a column that others explain turns no row.
  const double negligible = 0.1 * least / std::sqrt(static_cast<double>(std::max<std::size_t>(1, rows.size())));
  return Elimination(of_unit_length(rows, columns), columns, columns, {}, negligible).explained(least);
}

std::vector<std::size_t> explained_by_earlier(const std::vector<SparseRow>& rows, std::size_t columns) {
  const auto found = redundant(rows, columns, negligible);
  if (found.empty()) return {};
  // A relation explains the last column in it. With two relations of one last column there is one of earlier columns.
  Matrix all = relations(of_unit_length(rows, columns), columns, found);
  std::vector<Index> open;
  for (Index i = 0; i < all.rows(); ++i) open.push_back(i);
  std::vector<std::size_t> out;
  for (Index j = all.cols(); j-- > 0 && !open.empty();) {
    const auto largest = std::ranges::max_element(open, {}, [&](Index i) { return std::fabs(all(i, j)); });
    const Index own = *largest;
    if (std::fabs(all(own, j)) <= negligible) continue;
    out.push_back(index(j));
    open.erase(largest);
    for (const Index i : open) {
      if (j == 0 || all(i, j) == 0) continue;
      auto others = all.row(i).head(j);
      others -= all(i, j) / all(own, j) * all.row(own).head(j);
      if (const double size = others.cwiseAbs().maxCoeff(); size > 0) others /= size;
    }
  }
  std::ranges::reverse(out);
  return out;
}

} // namespace gumshoe::tracing
