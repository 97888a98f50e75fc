/// Draws of the noise of a design.
#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/erf.hpp>

#include "random/streams.h"
#include "tracing/criteria.h"
#include "tracing/noise/declared_response.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {
namespace {

std::size_t even(std::size_t n) { return (n + 1) / 2 * 2; }

/// Replaces normal numbers by outlying ones, of either sign, in their share.
void put_outliers(const NoiseShape& shape, const Draws& draws, std::uint64_t seed, Matrix& out) {
  const double core = shape.core();
  std::vector<double> where(even(draws.count)), which(even(draws.count + 1));
  for (Index i = 0; i < out.rows(); ++i) {
    const random::Stream stream{seed, static_cast<std::uint32_t>(i + 1), 4, 0};
    random::uniforms(stream, draws.first, where.size(), where.data());
    const std::size_t second = draws.of + draws.first, odd = second % 2;
    random::uniforms(stream, second - odd, which.size(), which.data());
    for (std::size_t j = 0; j < draws.count; ++j) {
      double& x = out(i, index(j));
      const auto size = static_cast<std::size_t>(which[odd + j] * static_cast<double>(shape.sizes.size()));
      x = core * (where[j] < shape.share ? std::copysign(shape.sizes[std::min(size, shape.sizes.size() - 1)], x) : x);
    }
  }
}

} // namespace

Matrix normals(std::size_t rows, const Draws& draws, std::uint64_t seed, std::uint16_t purpose) {
  Matrix out(index(rows), index(draws.count));
  std::vector<double> u(even(draws.count));
  for (std::size_t i = 0; i < rows; ++i) {
    random::uniforms({seed, static_cast<std::uint32_t>(i + 1), purpose, 0}, draws.first, u.size(), u.data());
    for (std::size_t j = 0; j < draws.count; ++j)
      out(index(i), index(j)) = -1.4142135623730951 * boost::math::erfc_inv(2 * u[j]);
  }
  return out;
}

double NoiseShape::core() const {
  double square = 0;
  for (const double size : sizes)
    square += std::pow(std::min(size, criteria.winsor_limit), 2) / static_cast<double>(sizes.size());
  return sizes.empty() ? 1 : 1 / std::sqrt(1 + share * (square - 1));
}

Matrix Whitened::draw(const Draws& draws, std::uint64_t seed, const NoiseShape& shape) const {
  const auto k = index(design_.indications);
  Matrix out = normals(rows_.size(), draws, seed, 1);
  const double rho = model_.correlation, factor = std::sqrt(1 - rho * rho);
  if (rho != 0)
    for (Index j = 0; j < out.cols(); ++j)
      for (Index i = k; i < out.rows(); ++i) out(i, j) = rho * out(i - k, j) + factor * out(i, j);
  for (Index i = 0; i < out.rows() && !shape.own.empty(); ++i) out.row(i) *= shape.own[index(i % k)];
  if (shape.share > 0) put_outliers(shape, draws, seed, out);
  for (Index i = 0; i < out.rows(); i += k) {
    const auto place = index(rows_[index(i)]) / design_.indications;
    const Matrix& local = design_.straight.empty() ? design_.local[place] : design_.straight[place];
    out.middleRows(i, k) = (local.triangularView<Eigen::Lower>() * out.middleRows(i, k)).eval();
  }
  if (design_.random.cols() > 0) add_declared(draws, seed, out);
  add_scatter(draws, seed, shape, out);
  return out;
}

/// Declared draws by their straight lines, and what they do beyond those, as where readings of a turning mill jump from
/// tooth to tooth.
void Whitened::add_declared(const Draws& draws, std::uint64_t seed, Matrix& out) const {
  const Matrix z = normals(index(design_.random.cols()), draws, seed, 2);
  struct Entry {
    Index row, column;
    double value;
  };
  std::vector<Entry> entries;
  for (Index c = 0; c < z.rows(); ++c)
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (const double x = design_.random(rows_[i], c); x != 0) entries.push_back({index(i), c, x});
  for (Index j = 0; j < out.cols(); ++j)
    for (const Entry& e : entries) out(e.row, j) += e.value * z(e.column, j);
  for (std::size_t c = 0; c < design_.bent.size(); ++c) {
    if (design_.bent[c] < 0) continue;
    const Matrix& table = design_.bends[index(design_.bent[c])];
    std::vector<std::size_t> moved;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (design_.random(rows_[i], index(c)) != 0) moved.push_back(i);
    for (Index j = 0; j < out.cols(); ++j) {
      const Index node = nearest_bend_node(z(index(c), j));
      for (const std::size_t i : moved) out(index(i), j) += table(rows_[i], node);
    }
  }
}

void Whitened::add_scatter(const Draws& draws, std::uint64_t seed, const NoiseShape& shape, Matrix& out) const {
  const auto group = scattered();
  if (group.empty()) return;
  const int groups = *std::ranges::max_element(group) + 1;
  const Matrix z = normals(index(groups), draws, seed, 3);
  for (Index j = 0; j < out.cols(); ++j)
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (group[i] < 0) continue;
      const double drawn = z(group[i], j);
      out(index(i), j) +=
          shape.scatter.size() == 0 ? scatter_unit(i) * drawn : shape.scatter(rows_[i], nearest_bend_node(drawn));
    }
}

} // namespace gumshoe::tracing
