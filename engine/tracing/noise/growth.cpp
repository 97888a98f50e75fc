#include "tracing/noise/growth.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/QR>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Readings whose noise is judged.
struct Left {
  std::vector<double> residual, size; ///< size: |x| over the largest
};

/// Adds what columns leave of the residuals of one pass, each with the variance that it had.
void add_left(const Matrix& columns, const Vector& residual, const Vector& size, Left& out) {
  const Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  const Index rank = qr.rank(), n = columns.rows();
  if (n < 2 * rank) return;
  const Matrix q = qr.householderQ() * Matrix::Identity(n, rank);
  const Vector left = residual - q * (q.transpose() * residual);
  for (Index i = 0; i < n; ++i) {
    const double share = 1 - q.row(i).squaredNorm(); // of the variance
    if (share < 0.1) continue;
    out.residual.push_back(left[i] / std::sqrt(share));
    out.size.push_back(size[i]);
  }
}

/// Twice the logarithm of the likelihood of Student's t, its scale fitted.
double likelihood(const Left& left, double ratio) {
  constexpr double nu = 5;
  const std::size_t n = left.residual.size();
  std::vector<double> square(n);
  double logarithms = 0, scale = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double variance = 1 + std::pow(ratio * left.size[i], 2);
    square[i] = left.residual[i] * left.residual[i] / variance;
    logarithms += std::log(variance);
    scale += square[i] / static_cast<double>(n);
  }
  constexpr int steps = 40; // each comes closer by half at least
  for (int step = 0; step < steps && scale > 0; ++step) {
    double sum = 0;
    for (const double s : square) sum += (nu + 1) / (nu + s / scale) * s;
    scale = sum / static_cast<double>(n);
  }
  double tails = 0;
  for (const double s : square) tails += std::log1p(s / scale / nu);
  return -logarithms - static_cast<double>(n) * std::log(scale) - (nu + 1) * tails;
}

/// Whether the readings at one level differ at all: where each pass begins with a zero they do not.
std::vector<bool> scatters(const Observations& o, const Covariate& x) {
  std::map<double, std::pair<double, double>> range;
  for (std::size_t r = 0; r < o.readings; ++r)
    for (std::size_t i = 0; i < o.indications; ++i) {
      const double y = o.measured[r * o.indications + i];
      auto& [low, high] = range.insert({x.value[r], {y, y}}).first->second;
      low = std::min(low, y), high = std::max(high, y);
    }
  std::vector<bool> out;
  for (std::size_t r = 0; r < o.readings; ++r) out.push_back(range.at(x.value[r]).first < range.at(x.value[r]).second);
  return out;
}

} // namespace

std::optional<NoiseGrowth> noise_growth(const Observations& o, const Replicates& replicates,
                                        const std::vector<Index>& rows, const Vector& about) {
  std::optional<NoiseGrowth> best;
  double most = criteria.noise_grows;
  for (std::size_t c = 0; c < o.covariates.size(); ++c) {
    const Covariate& x = o.covariates[c];
    const double largest = std::max(std::fabs(x.levels.front()), std::fabs(x.levels.back()));
    if (!x.commanded || x.course || x.angle || x.levels.size() < 3) continue;
    const auto size_of = [&](std::size_t reading) { return std::fabs(x.value[reading]) / largest; };
    const auto counts = scatters(o, x);
    std::map<std::size_t, std::vector<std::size_t>> passes; // places among the chosen rows
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t place = index(rows[i]) / o.indications;
      if (counts[o.sequence[place]]) passes[replicates.pass[place]].push_back(i);
    }
    Left left;
    for (const auto& [pass, places] : passes) {
      const auto n = index(places.size());
      Matrix columns(n, 4);
      Vector residual(n), size(n);
      for (Index i = 0; i < n; ++i) {
        const std::size_t place = places[index(i)];
        residual[i] = about[index(place)];
        size[i] = size_of(o.sequence[index(rows[place]) / o.indications]);
        const double t = static_cast<double>(2 * i) / static_cast<double>(n) - 1;
        columns.row(i) << 1, t, size[i], size[i] * t;
      }
      add_left(columns, residual, size, left);
    }
    if (left.residual.size() < criteria.readings_for_growth) continue;
    const double equal = likelihood(left, 0);
    for (const double ratio : criteria.growth_ratios)
      if (const double gain = likelihood(left, ratio) - equal; gain > most) {
        most = gain;
        best = {c, ratio, largest, Vector(index(o.readings))};
      }
  }
  if (!best) return best;
  for (std::size_t r = 0; r < o.readings; ++r)
    best->variance[index(r)] = 1 + std::pow(best->ratio * o.covariates[best->covariate].value[r] / best->largest, 2);
  return best;
}

} // namespace gumshoe::tracing
