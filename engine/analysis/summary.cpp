#include "analysis/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/ordered_sum.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

template <class F> double ordered_sum(std::span<const double> x, const F& f) {
  return analysis::ordered_sum(x.size(), [&](std::size_t i) { return f(x[i]); });
}

/// Places, from 0, of the symmetric interval's ends among m ordered values.
std::pair<std::size_t, std::size_t> symmetric_ranks(std::size_t m, double p) {
  const std::size_t q = covered_ranks(m, p), r = std::max<std::size_t>(1, (m - q + 1) / 2);
  return {r - 1, std::min(m, r + q) - 1};
}

/// Values with both tails in order: ranks below `tail` and from size - tail on are exact order statistics.
void order_tails(std::vector<double>& x, std::size_t tail) {
  if (2 * tail >= x.size()) {
    std::sort(x.begin(), x.end());
    return;
  }
  const auto low = x.begin() + static_cast<long>(tail), high = x.end() - static_cast<long>(tail);
  std::nth_element(x.begin(), low, x.end());
  std::sort(x.begin(), low);
  std::nth_element(low, high, x.end());
  std::sort(high, x.end());
}

Ends ordered_symmetric_ends(const std::vector<double>& x, double p) {
  const auto [low, high] = symmetric_ranks(x.size(), p);
  return {x[low], x[high]};
}

Ends shortest_ends(const std::vector<double>& x, double p) {
  const std::size_t m = x.size(), q = covered_ranks(m, p);
  std::size_t best = 0;
  for (std::size_t r = 0; r + q < m; ++r)
    if (x[r + q] - x[r] < x[best + q] - x[best]) best = r;
  return {x[best], x[best + q]};
}

/// Standard error of an order statistic: half the distance between the ranks one binomial standard
/// deviation away on either side.
double rank_error(const std::vector<double>& x, double probability) {
  const double m = static_cast<double>(x.size()), at = probability * m;
  const double step = std::max(1.0, std::sqrt(m * probability * (1 - probability)));
  const auto value = [&](double rank) { return x[static_cast<std::size_t>(std::clamp(rank, 0.0, m - 1))]; };
  return 0.5 * (value(at + step) - value(at - step));
}

/// The shortest interval's ends have no such simple law: their spread over 16 parts of the run, scaled by
/// the cube-root rate at which they converge. Parts need not be longer than the law needs to show.
Ends shortest_errors(std::span<const double> in_order, double p) {
  constexpr std::size_t parts = 16, longest = 20'000;
  const std::size_t n = std::min(longest, in_order.size() / parts);
  if (n < 200) return {nan, nan};
  std::vector<double> low, high;
  for (std::size_t k = 0; k < parts; ++k) {
    const auto part = in_order.subspan(k * n, n);
    std::vector<double> x(part.begin(), part.end());
    std::sort(x.begin(), x.end());
    const Ends e = shortest_ends(x, p);
    low.push_back(e.low);
    high.push_back(e.high);
  }
  const double scale = std::cbrt(static_cast<double>(n) / static_cast<double>(in_order.size()));
  return {scale * std::sqrt(moments(low).variance), scale * std::sqrt(moments(high).variance)};
}

void histogram(Summary& s, std::span<const double> values) {
  const double span = s.symmetric.high - s.symmetric.low;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double low = std::max(*least, s.symmetric.low - 0.5 * span),
               high = std::min(*most, s.symmetric.high + 0.5 * span);
  if (!(high > low)) return;
  constexpr std::size_t bins = 100;
  s.density.assign(bins, 0);
  for (std::size_t b = 0; b <= bins; ++b) s.bin_edges.push_back(low + (high - low) * static_cast<double>(b) / bins);
  for (const double v : values)
    if (v >= low && v <= high)
      s.density[std::min(bins - 1, static_cast<std::size_t>((v - low) / (high - low) * bins))] += 1;
  for (double& d : s.density) d /= static_cast<double>(values.size()) * (high - low) / bins;
}

} // namespace

std::size_t covered_ranks(std::size_t m, double p) {
  return std::min(m - 1, static_cast<std::size_t>(std::floor(p * static_cast<double>(m) + 0.5)));
}

Ends symmetric_ends(std::vector<double>& x, double p) {
  const auto [low, high] = symmetric_ranks(x.size(), p);
  std::nth_element(x.begin(), x.begin() + static_cast<long>(low), x.end());
  if (high > low)
    std::nth_element(x.begin() + static_cast<long>(low) + 1, x.begin() + static_cast<long>(high), x.end());
  return {x[low], x[high]};
}

Moments moments(std::span<const double> x) {
  const double n = static_cast<double>(x.size());
  Moments m;
  if (x.empty()) return {nan, nan, nan, nan};
  // A first value as origin keeps the sum small against its rounding.
  m.mean = x[0] + ordered_sum(x, [&](double v) { return v - x[0]; }) / n;
  const double m2 = ordered_sum(x, [&](double v) { return (v - m.mean) * (v - m.mean); }) / n;
  const double m3 = ordered_sum(x, [&](double v) { return (v - m.mean) * (v - m.mean) * (v - m.mean); }) / n;
  const double m4 = ordered_sum(x,
                                [&](double v) {
                                  const double d = (v - m.mean) * (v - m.mean);
                                  return d * d;
                                }) /
                    n;
  m.variance = n > 1 ? m2 * n / (n - 1) : nan;
  m.skewness = m2 > 0 ? m3 / std::pow(m2, 1.5) : 0;
  m.kurtosis = m2 > 0 ? m4 / (m2 * m2) : 0;
  return m;
}

Summary summarise(const propagation::Output& output, std::span<const double> values, double p) {
  Summary s;
  s.output = output;
  std::vector<double> valid;
  valid.reserve(values.size());
  for (const double v : values)
    if (!std::isnan(v)) valid.push_back(v);
  s.valid = valid.size();
  s.failed = values.size() - valid.size();
  if (valid.size() < 2) {
    s.estimate = s.standard_uncertainty = s.estimate_se = s.standard_uncertainty_se = nan;
    s.symmetric = s.shortest = {nan, nan, nan, nan, nan, nan};
    s.warning = "too few valid samples";
    return s;
  }
  const Moments m = moments(valid);
  const double n = static_cast<double>(valid.size());
  s.estimate = m.mean;
  s.standard_uncertainty = std::sqrt(m.variance);
  s.skewness = m.skewness;
  s.kurtosis = m.kurtosis;
  s.estimate_se = s.standard_uncertainty / std::sqrt(n);
  s.standard_uncertainty_se = s.standard_uncertainty * std::sqrt(std::max(0.0, m.kurtosis - 1) / (4 * n));

  std::vector<double> ordered = valid;
  const double alpha = 0.5 * (1 - p);
  const double margin = 5 * std::sqrt(n) + 2 * static_cast<double>(s.failed) + 10;
  order_tails(ordered, std::min(ordered.size(), static_cast<std::size_t>((1 - p) * n + margin)));
  const Ends symmetric = ordered_symmetric_ends(ordered, p), shortest = shortest_ends(ordered, p);
  const Ends shortest_se = shortest_errors(valid, p);
  s.symmetric = {symmetric.low, symmetric.high, rank_error(ordered, alpha), rank_error(ordered, 1 - alpha),
                 symmetric.low, symmetric.high};
  s.shortest = {shortest.low, shortest.high, shortest_se.low, shortest_se.high, shortest.low, shortest.high};
  // The share that a fixed interval covers scatters by that much; so much longer or shorter is the shortest one.
  const double share = std::sqrt(p * (1 - p) / n);
  const Ends wider = shortest_ends(ordered, std::min(p + share, 1.0)), narrower = shortest_ends(ordered, p - share);
  s.shortest_length_se = 0.5 * ((wider.high - wider.low) - (narrower.high - narrower.low));
  if (s.failed > 0) {
    // Failed values could all lie below, or all above: the ends move by that many ranks at the most.
    const double all = n + static_cast<double>(s.failed), failed = static_cast<double>(s.failed);
    const double low_rank = std::floor(alpha * all) - failed, high_rank = std::ceil((1 - alpha) * all);
    s.symmetric.low_rank = low_rank < 1 ? -inf : ordered[static_cast<std::size_t>(low_rank) - 1];
    s.symmetric.high_rank = high_rank > n ? inf : ordered[static_cast<std::size_t>(high_rank) - 1];
    s.shortest.low_rank = s.symmetric.low_rank;
    s.shortest.high_rank = s.symmetric.high_rank;
  }
  histogram(s, valid);
  return s;
}

} // namespace gumshoe::analysis
