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

/// Replaces normal numbers by outlying ones, of either sign, in their share.
void put_outliers(const NoiseShape& shape, std::uint64_t seed, Matrix& out) {
  const double core = shape.core();
  const auto columns = index(out.cols());
  std::vector<double> u(2 * columns);
  for (Index i = 0; i < out.rows(); ++i) {
    random::uniforms({seed, static_cast<std::uint32_t>(i + 1), 4, 0}, 0, u.size(), u.data());
    for (std::size_t j = 0; j < columns; ++j) {
      double& x = out(i, index(j));
      const auto which = static_cast<std::size_t>(u[columns + j] * static_cast<double>(shape.sizes.size()));
      x = core * (u[j] < shape.share ? std::copysign(shape.sizes[std::min(which, shape.sizes.size() - 1)], x) : x);
    }
  }
}

} // namespace

Matrix normals(std::size_t rows, std::size_t columns, std::uint64_t seed, std::uint16_t purpose) {
  const std::size_t even = (columns + 1) / 2 * 2;
  Matrix out(index(rows), index(columns));
  std::vector<double> u(even);
  for (std::size_t i = 0; i < rows; ++i) {
    random::uniforms({seed, static_cast<std::uint32_t>(i + 1), purpose, 0}, 0, even, u.data());
    for (std::size_t j = 0; j < columns; ++j)
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

Matrix Whitened::draw(std::size_t n, std::uint64_t seed, const NoiseShape& shape) const {
  const auto k = index(design_.indications);
  Matrix out = normals(rows_.size(), n, seed, 1);
  const double rho = model_.correlation, factor = std::sqrt(1 - rho * rho);
  if (rho != 0)
    for (Index i = k; i < out.rows(); ++i) out.row(i) = rho * out.row(i - k) + factor * out.row(i);
  if (shape.share > 0) put_outliers(shape, seed, out);
  for (Index i = 0; i < out.rows(); i += k) {
    const auto place = index(rows_[index(i)]) / design_.indications;
    const Matrix& local = design_.straight.empty() ? design_.local[place] : design_.straight[place];
    out.middleRows(i, k) = (local.triangularView<Eigen::Lower>() * out.middleRows(i, k)).eval();
  }
  if (design_.random.cols() > 0) add_declared(n, seed, out);
  add_scatter(n, seed, shape, out);
  return out;
}

/// Declared draws by their straight lines, and what they do beyond those, as where readings of a turning mill jump from
/// tooth to tooth.
void Whitened::add_declared(std::size_t n, std::uint64_t seed, Matrix& out) const {
  const Matrix z = normals(index(design_.random.cols()), n, seed, 2);
  out += take(design_.random) * z;
  for (std::size_t c = 0; c < design_.bent.size(); ++c) {
    if (design_.bent[c] < 0) continue;
    const Matrix& table = design_.bends[index(design_.bent[c])];
    for (Index j = 0; j < out.cols(); ++j) {
      const Index node = nearest_bend_node(z(index(c), j));
      for (std::size_t i = 0; i < rows_.size(); ++i)
        if (design_.random(rows_[i], index(c)) != 0) out(index(i), j) += table(rows_[i], node);
    }
  }
}

void Whitened::add_scatter(std::size_t n, std::uint64_t seed, const NoiseShape& shape, Matrix& out) const {
  const auto group = scattered();
  if (group.empty()) return;
  const int groups = *std::ranges::max_element(group) + 1;
  const Matrix z = normals(index(groups), n, seed, 3);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (group[i] < 0) continue;
    if (shape.scatter.size() == 0)
      out.row(index(i)) += scatter_unit(i) * z.row(group[i]);
    else
      for (Index j = 0; j < out.cols(); ++j)
        out(index(i), j) += shape.scatter(rows_[i], nearest_bend_node(z(group[i], j)));
  }
}

} // namespace gumshoe::tracing
