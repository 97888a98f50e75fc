#include "tracing/noise/block_spread.h"

#include <algorithm>
#include <cmath>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr double mean_size = 0.7978845608028654; // of normal numbers, in standard deviations

/// Mean sizes of a block and of the others.
struct Means {
  double own = 0, others = 0, count = 0;
};

std::vector<Means> means(const Vector& sizes, const std::vector<std::size_t>& block, std::size_t blocks) {
  std::vector<Means> out(blocks);
  for (Index i = 0; i < sizes.size(); ++i) out[block[index(i)]].own += sizes[i], ++out[block[index(i)]].count;
  const double sum = sizes.sum();
  for (Means& m : out) {
    m.others = (sum - m.own) / std::max(1.0, static_cast<double>(sizes.size()) - m.count);
    m.own /= std::max(1.0, m.count);
  }
  return out;
}

double bound_of(const Vector& sizes) {
  std::vector<double> sorted(sizes.begin(), sizes.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return criteria.winsor_limit * std::max(*middle / 0.6744897501960817, sizes.mean() / mean_size);
}

} // namespace

BlockSpread block_spread(const Matrix& residuals, const std::vector<std::size_t>& block, std::size_t blocks) {
  const Matrix zero = Matrix::Zero(index(blocks), residuals.cols());
  BlockSpread out{zero, zero, zero};
  for (Index j = 0; j < residuals.cols(); ++j) {
    const Vector sizes = residuals.col(j).cwiseAbs();
    const auto plain = means(sizes, block, blocks), bounded = means(sizes.cwiseMin(bound_of(sizes)), block, blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
      out.typical(index(b), j) = plain[b].own / mean_size;
      out.others(index(b), j) = plain[b].others / mean_size;
      const auto& [own, others, count] = bounded[b];
      if (count >= static_cast<double>(criteria.readings_of_block) && own > others && others > 0)
        out.statistic(index(b), j) = count * std::pow(std::log(own / others), 2);
    }
  }
  return out;
}

} // namespace gumshoe::tracing
