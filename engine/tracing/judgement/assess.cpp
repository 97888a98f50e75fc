#include "tracing/judgement/assess.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>

namespace gumshoe::tracing {
namespace {

/// Without long double: a tail probability needs no more digits.
using Gamma =
    boost::math::gamma_distribution<double,
                                    boost::math::policies::policy<boost::math::policies::promote_double<false>>>;

Null null_of(const Eigen::Ref<const Matrix>& draws) {
  Null out;
  const double n = static_cast<double>(draws.size());
  out.mean = draws.mean();
  out.variance = (draws.array() - out.mean).square().sum() / std::max(1.0, n - 1);
  return out;
}

double share_at_most(const std::vector<double>& draws, double value) {
  const auto below = std::count_if(draws.begin(), draws.end(), [&](double d) { return d <= value; });
  return (1.0 + static_cast<double>(below)) / (1.0 + static_cast<double>(draws.size()));
}

} // namespace

double Null::p(double statistic) const {
  if (!(mean > 0) || !(variance > 0)) return 1;
  const Gamma gamma(mean * mean / variance, variance / mean);
  return statistic > 0 ? std::max(1e-300, boost::math::cdf(boost::math::complement(gamma, statistic))) : 1;
}

double Null::quantile(double p) const {
  if (!(mean > 0) || !(variance > 0)) return std::numeric_limits<double>::infinity();
  const Gamma gamma(mean * mean / variance, variance / mean);
  return boost::math::quantile(boost::math::complement(gamma, p));
}

Assessment assess(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                  double declared, const ScatterResponse& response) {
  Assessment out;
  out.data = scan.run(residuals);
  const auto count = static_cast<std::size_t>(draws);
  const std::size_t k0 = out.data.without_scatter[0], k1 = out.data.structure[0];
  // Two lots: one tells how each statistic is distributed, the other, as new to that as the data are, how small the
  // least of all probabilities comes out by chance.
  Departures& departures = out.departures;
  departures = scan.departures(residuals);
  const auto null_draws = [&](std::size_t k, double variance, std::uint64_t key) {
    return scan.run(std::sqrt(variance) * scan.whitened(k).draw(2 * count, key, departures), beyond_chance);
  };
  // Nothing at all: no variance component either.
  const Statistics nothing = null_draws(k0, out.data.variance_without_scatter[0], seed);
  const Index m = nothing.ratio.rows(), c = nothing.scatter.rows(), sets = draws;
  std::vector<Null> signature, component;
  for (Index j = 0; j < m; ++j) signature.push_back(null_of(nothing.ratio.row(j).head(sets)));
  for (Index j = 0; j < c; ++j) component.push_back(null_of(nothing.scatter.row(j).head(sets)));
  // The noise's size: a robust scale, lognormal to the eye.
  // With few readings the robust scale is blunt: there the mean square serves.
  const bool few = scan.degrees_of_freedom() < 30;
  const Vector size = few ? Vector(nothing.variance_without_scatter.cwiseSqrt()) : nothing.scale;
  const double observed = few ? std::sqrt(out.data.variance_without_scatter[0]) : out.data.scale[0];
  const Vector sizes =
      size.array().log() - 0.5 * std::log(out.data.variance_without_scatter[0]) - std::log(departures.core());
  const double middle = sizes.head(sets).mean(),
               spread = std::sqrt((sizes.head(sets).array() - middle).square().mean());
  const boost::math::normal normal;
  const auto p_noise = [&](double log_size) {
    return boost::math::cdf(boost::math::complement(normal, (log_size - middle) / spread));
  };
  const double z = declared > 0 ? std::log(observed / declared) : 0;
  if (declared > 0 && spread > 0) {
    out.p_noise = p_noise(z);
    out.noise_small = 1 - out.p_noise < 1e-3;
  }
  std::vector<double> least(static_cast<std::size_t>(sets));
  for (Index i = 0; i < sets; ++i) {
    double p = declared > 0 && spread > 0 ? p_noise(sizes[sets + i]) : 1;
    for (Index j = 0; j < m; ++j) p = std::min(p, signature[static_cast<std::size_t>(j)].p(nothing.ratio(j, sets + i)));
    for (Index j = 0; j < c; ++j)
      p = std::min(p, component[static_cast<std::size_t>(j)].p(nothing.scatter(j, sets + i)));
    least[static_cast<std::size_t>(i)] = p;
  }
  double p = out.p_noise;
  for (Index j = 0; j < m; ++j) p = std::min(p, signature[static_cast<std::size_t>(j)].p(out.data.ratio(j, 0)));
  for (Index j = 0; j < c; ++j) {
    const double one = component[static_cast<std::size_t>(j)].p(out.data.scatter(j, 0));
    out.p_component.push_back(share_at_most(least, one));
    p = std::min(p, one);
  }
  out.p_anything = share_at_most(least, p);
  out.p_noise_overall = share_at_most(least, out.p_noise);
  // Signatures beside the noise as it seems to be, with its variance component.
  if (k1 != k0) {
    if (response) departures.scatter = response(scan.all_structures()[k1], out.data.variance[0]);
    const Statistics beside = null_draws(k1, out.data.variance[0], seed ^ 0x5ca77e5ull);
    for (Index j = 0; j < m; ++j) signature[static_cast<std::size_t>(j)] = null_of(beside.ratio.row(j).head(sets));
    for (Index i = 0; i < sets; ++i) {
      double one = 1;
      for (Index j = 0; j < m; ++j)
        one = std::min(one, signature[static_cast<std::size_t>(j)].p(beside.ratio(j, sets + i)));
      least[static_cast<std::size_t>(i)] = one;
    }
  }
  double best = 1;
  for (Index j = 0; j < m; ++j) {
    out.p.push_back(signature[static_cast<std::size_t>(j)].p(out.data.ratio(j, 0)));
    best = std::min(best, out.p.back());
  }
  out.null = signature;
  out.p_signature = share_at_most(least, best);
  std::sort(least.begin(), least.end());
  const auto rank = static_cast<std::size_t>(alpha * static_cast<double>(least.size() + 1));
  out.threshold = least[std::min(least.size() - 1, rank > 0 ? rank - 1 : 0)];
  return out;
}

} // namespace gumshoe::tracing
