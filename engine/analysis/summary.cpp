#include "analysis/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/leaves.h"
#include "analysis/ordered_tails.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// Places, from 0, of the symmetric interval's ends among m ordered values.
std::pair<std::size_t, std::size_t> symmetric_ranks(std::size_t m, double p) {
  const std::size_t q = covered_ranks(m, p), r = std::max<std::size_t>(1, (m - q + 1) / 2);
  return {r - 1, std::min(m, r + q) - 1};
}

/// Order statistics that both intervals of n values need: (1 - p) n on either side, and a margin for their errors.
std::size_t tail_size(std::size_t n, std::size_t failed, double p) {
  const double m = static_cast<double>(n);
  return std::min(n, static_cast<std::size_t>((1 - p) * m + 5 * std::sqrt(m) + 2 * static_cast<double>(failed) + 10));
}

Ends ordered_symmetric_ends(const OrderedTails& x, double p) {
  const auto [low, high] = symmetric_ranks(x.size, p);
  return {x[low], x[high]};
}

Ends shortest_ends(const OrderedTails& x, double p) {
  const std::size_t q = covered_ranks(x.size, p), r = x.shortest(q);
  return {x[r], x[r + q]};
}

/// Half-width of the interval about y that holds as many values as a coverage interval: of those to spare, the farthest
/// from y are left out, `low` of them below it.
double half_width_about(double y, const OrderedTails& x, double p) {
  const std::size_t last = x.size - 1, spare = last - covered_ranks(x.size, p);
  std::size_t low = 0;
  for (std::size_t most = spare; low < most;) { // bisection: is one more below it no farther than the last above it?
    const std::size_t middle = low + (most - low) / 2;
    if (y - x[middle] <= x[last - (spare - middle - 1)] - y)
      most = middle;
    else
      low = middle + 1;
  }
  return std::max(y - x[low], x[last - (spare - low)] - y);
}

/// Standard error of an order statistic: half the distance between the ranks one binomial standard
/// deviation away on either side.
double rank_error(const OrderedTails& x, double probability) {
  const double m = static_cast<double>(x.size), at = probability * m;
  const double step = std::max(1.0, std::sqrt(m * probability * (1 - probability)));
  const auto value = [&](double rank) { return x[static_cast<std::size_t>(std::clamp(rank, 0.0, m - 1))]; };
  return 0.5 * (value(at + step) - value(at - step));
}

/// The shortest interval's ends have no such simple law: their spread over 16 parts of the run, scaled by
/// the cube-root rate at which they converge inside the range of the values. Parts need not be longer than the law needs to
/// show. At an end of the range they converge faster, and the error is too large: +-1.96 of it cover 0.90 to 1.00.
Ends shortest_errors(std::span<const double> in_order, double p, int threads) {
  constexpr std::size_t runs = 16, longest = 20'000;
  const std::size_t n = std::min(longest, in_order.size() / runs);
  if (n < 200) return {nan, nan};
  std::array<double, runs> low, high;
  const auto one = [&](std::size_t k) {
    const auto part = in_order.subspan(k * n, n);
    const auto valid = static_cast<std::size_t>(std::ranges::count_if(part, [](double v) { return !std::isnan(v); }));
    const Ends e = valid < 2 ? Ends{nan, nan} : shortest_ends(ordered_tails(part, valid, tail_size(valid, 0, p), 1), p);
    low[k] = e.low;
    high[k] = e.high;
  };
  if (threads == 1)
    for (std::size_t k = 0; k < runs; ++k) one(k);
  else
    propagation::parallel_for(runs, threads, one);
  const double scale = std::cbrt(static_cast<double>(n) / static_cast<double>(in_order.size()));
  return {scale * std::sqrt(moments(low).variance), scale * std::sqrt(moments(high).variance)};
}

constexpr std::size_t bins = 100;
using Counts = std::array<std::size_t, bins + 1>; ///< the last: outside

void histogram(Summary& s, std::span<const double> values, double least, double most, int threads) {
  const double span = s.symmetric.high - s.symmetric.low;
  const double low = std::max(least, s.symmetric.low - 0.5 * span),
               high = std::min(most, s.symmetric.high + 0.5 * span);
  if (!(high > low)) return;
  s.density.assign(bins, 0);
  for (std::size_t b = 0; b <= bins; ++b) s.bin_edges.push_back(low + (high - low) * static_cast<double>(b) / bins);
  const double per_width = bins / (high - low);
  std::vector<Counts> counts(parts(values.size()));
  for_parts(values, threads, [&](std::size_t part, std::span<const double> some) {
    Counts& c = counts[part];
    for (const double v : some) {
      const bool inside = v >= low && v <= high;
      c[inside ? std::min(bins - 1, static_cast<std::size_t>((v - low) * per_width)) : bins] += 1;
    }
  });
  for (const Counts& c : counts)
    for (std::size_t b = 0; b < bins; ++b) s.density[b] += static_cast<double>(c[b]);
  for (double& d : s.density) d /= static_cast<double>(s.valid) * (high - low) / bins;
}

/// Sums of eight interleaved series, which do not wait for each other.
using Lanes = std::array<double, 8>;
double total(const Lanes& s) { return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])); }

template <class Add> void each_lane(std::span<const double> x, const Add& add) {
  std::size_t i = 0;
  for (; i + 8 <= x.size(); i += 8)
    for (std::size_t l = 0; l < 8; ++l) add(l, x[i + l]);
  for (; i < x.size(); ++i) add(i % 8, x[i]);
}

struct First {
  double sum = 0, valid = 0;
  void operator+=(const First& other) { sum += other.sum, valid += other.valid; }
};

struct Central {
  double second = 0, third = 0, fourth = 0;
  void operator+=(const Central& o) { second += o.second, third += o.third, fourth += o.fourth; }
};

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

Moments moments(std::span<const double> x, int threads) {
  const auto first = std::ranges::find_if(x, [](double v) { return !std::isnan(v); });
  if (first == x.end()) return {nan, nan, nan, nan, 0};
  const double origin = *first; // keeps the sum small against its rounding
  const First sums = leaf_sum<First>(x, threads, [&](std::span<const double> leaf) {
    Lanes sum{}, valid{};
    each_lane(leaf, [&](std::size_t l, double v) {
      sum[l] += v == v ? v - origin : 0.0;
      valid[l] += v == v ? 1.0 : 0.0;
    });
    return First{total(sum), total(valid)};
  });
  Moments m;
  const double n = sums.valid;
  m.valid = static_cast<std::size_t>(n);
  m.mean = origin + sums.sum / n;
  const Central central = leaf_sum<Central>(x, threads, [&](std::span<const double> leaf) {
    Lanes second{}, third{}, fourth{};
    each_lane(leaf, [&](std::size_t l, double v) {
      const double d = v == v ? v - m.mean : 0.0, square = d * d;
      second[l] += square;
      third[l] += square * d;
      fourth[l] += square * square;
    });
    return Central{total(second), total(third), total(fourth)};
  });
  const double m2 = central.second / n, m3 = central.third / n, m4 = central.fourth / n;
  m.variance = n > 1 ? m2 * n / (n - 1) : nan;
  m.skewness = m2 > 0 ? m3 / std::pow(m2, 1.5) : 0;
  m.kurtosis = m2 > 0 ? m4 / (m2 * m2) : 0;
  return m;
}

namespace {

/// Values that differ by the rounding of their own computation alone, as where a common error cancels, are one value.
void join_rounded(Summary& s) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  if (!(s.standard_uncertainty > 0 && s.standard_uncertainty <= rounding * std::fabs(s.estimate))) return;
  s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = s.monte_carlo_expanded = 0;
  s.skewness = s.kurtosis = s.shortest_length_se = 0;
  for (Interval* i : {&s.symmetric, &s.shortest}) {
    i->low = i->high = s.estimate;
    i->low_se = i->high_se = 0;
    if (s.failed == 0) i->low_rank = i->high_rank = s.estimate;
  }
}

} // namespace

Summary summarise(const propagation::Output& output, std::span<const double> values, double p, int threads) {
  Summary s;
  s.output = output;
  const Moments m = moments(values, threads);
  s.valid = m.valid;
  s.failed = values.size() - m.valid;
  if (s.valid < 2) {
    s.estimate = s.standard_uncertainty = s.monte_carlo_expanded = s.estimate_se = s.standard_uncertainty_se = nan;
    s.symmetric = s.shortest = {nan, nan, nan, nan, nan, nan};
    s.warning = "too few valid samples";
    return s;
  }
  const double n = static_cast<double>(s.valid);
  s.estimate = m.mean;
  s.standard_uncertainty = std::sqrt(m.variance);
  s.skewness = m.skewness;
  s.kurtosis = m.kurtosis;
  s.estimate_se = s.standard_uncertainty / std::sqrt(n);
  s.standard_uncertainty_se = s.standard_uncertainty * std::sqrt(std::max(0.0, m.kurtosis - 1) / (4 * n));

  if (n * (1 - p) < 1) {
    s.symmetric = s.shortest = {nan, nan, nan, nan, nan, nan};
    s.shortest_length_se = s.monte_carlo_expanded = nan;
    s.warning = fmt::format("no coverage interval: {} trials are fewer than 1 / (1 - p) = {:.0f}", s.valid, 1 / (1 - p));
    return s;
  }
  const double alpha = 0.5 * (1 - p);
  const OrderedTails ordered = ordered_tails(values, s.valid, tail_size(s.valid, s.failed, p), threads);
  const Ends symmetric = ordered_symmetric_ends(ordered, p), shortest = shortest_ends(ordered, p);
  const Ends shortest_se = shortest_errors(values, p, threads);
  s.monte_carlo_expanded = half_width_about(s.estimate, ordered, p);
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
  histogram(s, values, ordered[0], ordered[s.valid - 1], threads);
  join_rounded(s);
  return s;
}

} // namespace gumshoe::analysis
