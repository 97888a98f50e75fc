#include "tracing/noise/growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/QR>

#include "tracing/criteria.h"
#include "tracing/noise/student.h"

namespace gumshoe::tracing {
namespace {

/// What the readings of one pass leave about the model, and columns that are no noise.
struct Pass {
  Matrix columns;
  Vector left, size; ///< size: |x| over the largest
};

/// Twice the logarithm of the restricted likelihood of Student's t, its scale fitted.
double likelihood(const std::vector<Pass>& passes, double ratio) {
  Residuals all;
  double out = 0;
  for (const Pass& pass : passes) {
    const Vector u = (1 + (ratio * pass.size.array()).square()).sqrt();
    const Eigen::ColPivHouseholderQR<Matrix> qr(u.cwiseInverse().asDiagonal() * pass.columns);
    const Matrix q = qr.householderQ() * Matrix::Identity(u.size(), qr.rank());
    const Vector left = pass.left.cwiseQuotient(u), residual = left - q * (q.transpose() * left);
    out -= 2 * u.array().log().sum() + 2 * qr.matrixR().diagonal().head(qr.rank()).array().abs().log().sum();
    for (Index i = 0; i < u.size(); ++i) {
      all.share.push_back(std::max(1e-6, 1 - q.row(i).squaredNorm()));
      all.square.push_back(residual[i] * residual[i] / all.share.back());
    }
  }
  return out + scale_of(all).likelihood;
}

/// Whether the others still say so, by their share, without any one pass: a bad reading decides for its own.
bool without_any(const std::vector<Pass>& passes, double ratio) {
  const auto n = static_cast<double>(passes.size());
  for (std::size_t without = 0; without < passes.size(); ++without) {
    std::vector<Pass> others = passes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(without));
    if (others.empty() || likelihood(others, ratio) - likelihood(others, 0) < criteria.noise_grows * (n - 1) / n)
      return false;
  }
  return true;
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
    std::vector<Pass> judged;
    Index freedom = 0;
    for (const auto& [pass, places] : passes) {
      const auto n = index(places.size());
      const Index used = n < 8 ? 2 : 4; // a drift within few readings counts as noise
      if (n < 2 * used) continue;
      Pass one{Matrix(n, used), Vector(n), Vector(n)};
      for (Index i = 0; i < n; ++i) {
        const std::size_t place = places[index(i)];
        one.left[i] = about[index(place)];
        one.size[i] = size_of(o.sequence[index(rows[place]) / o.indications]);
        const double t = static_cast<double>(2 * i) / static_cast<double>(n) - 1;
        one.columns.row(i) = Eigen::RowVector4d(1, one.size[i], t, one.size[i] * t).head(used);
      }
      freedom += n - used;
      judged.push_back(std::move(one));
    }
    if (freedom < criteria.freedom_for_growth) continue;
    const double equal = likelihood(judged, 0);
    std::array<double, criteria.growth_ratios.size()> gains;
    std::ranges::transform(criteria.growth_ratios, gains.begin(),
                           [&](double ratio) { return likelihood(judged, ratio) - equal; });
    // The least that the readings do not contradict: they say little of the noise where it is smallest.
    const double high = *std::ranges::max_element(gains);
    const auto least = std::ranges::find_if(gains, [&](double gain) { return gain > high - criteria.as_well_grown; });
    const double ratio = criteria.growth_ratios[index(least - gains.begin())];
    if (high > most && without_any(judged, ratio)) {
      most = high;
      best = {c, ratio, largest, Vector(index(o.readings))};
    }
  }
  if (!best) return best;
  for (std::size_t r = 0; r < o.readings; ++r)
    best->variance[index(r)] = 1 + std::pow(best->ratio * o.covariates[best->covariate].value[r] / best->largest, 2);
  return best;
}

} // namespace gumshoe::tracing
