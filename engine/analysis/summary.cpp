#include "analysis/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "analysis/leaves.h"
#include "analysis/moments.h"
#include "analysis/ordered_tails.h"
#include "analysis/tails.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

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

/// Where most of the order statistics of a summary lie.
std::array<RankRange, 2> both_tails(std::size_t n, double p) {
  const std::size_t near = std::clamp<std::size_t>(tail_size(n, 0, p), 1, std::max<std::size_t>(1, n / 2));
  return {RankRange{0, near - 1}, {n - std::min(n, near), std::max<std::size_t>(n, 1) - 1}};
}

template <class Ordered> Ends ordered_symmetric_ends(const Ordered& x, double p) {
  const auto [low, high] = symmetric_ranks(x.size, p);
  return {x[low], x[high]};
}

template <class Ordered> Ends shortest_ends(const Ordered& x, double p) {
  const std::size_t q = covered_ranks(x.size, p), r = x.shortest(q);
  return {x[r], x[r + q]};
}

/// Values that an interval of an end value and `covered_ranks` more leaves out.
std::size_t spare_ranks(std::size_t m, double p) { return m - 1 - covered_ranks(m, p); }

/// Half-width of the interval about y that holds as many values as a coverage interval: of those to spare, the farthest
/// from y are left out, `low` of them below it.
template <class Ordered> double half_width_about(double y, const Ordered& x, double p) {
  const std::size_t last = x.size - 1, spare = spare_ranks(x.size, p);
  auto [low, most] = x.bracket_middle(y, spare);
  while (low < most) { // bisection: is one more below it no farther than the last above it?
    const std::size_t middle = low + (most - low) / 2;
    if (y - x[middle] <= x[last - (spare - middle - 1)] - y)
      most = middle;
    else
      low = middle + 1;
  }
  return std::max(y - x[low], x[last - (spare - low)] - y);
}

/// The ranks one binomial standard deviation to either side of an order statistic.
RankRange error_ranks(std::size_t n, double probability) {
  const double m = static_cast<double>(n), at = probability * m;
  const double step = std::max(1.0, std::sqrt(m * probability * (1 - probability)));
  const auto rank = [&](double r) { return static_cast<std::size_t>(std::clamp(r, 0.0, m - 1)); };
  return {rank(at - step), rank(at + step)};
}

/// Standard error of an order statistic: half the distance between those ranks.
template <class Ordered> double rank_error(const Ordered& x, double probability) {
  const RankRange ranks = error_ranks(x.size, probability);
  return 0.5 * (x[ranks.last] - x[ranks.first]);
}

/// The shortest interval's ends have no such simple law: their spread over 16 parts of the run, scaled by
/// the cube-root rate at which they converge inside the range of the values. Parts need not be longer than the law
/// needs to show. At an end of the range they converge faster, and the error is too large: +-1.96 of it cover 0.90
/// to 1.00.
Ends shortest_errors(const Column& in_order, double p, int threads) {
  constexpr std::size_t runs = 16, longest = 20'000;
  const std::size_t n = std::min(longest, in_order.size() / runs);
  if (n < 200) return {nan, nan};
  std::array<double, runs> low, high;
  const auto one = [&](std::size_t k) {
    Room room;
    const auto part = in_order.read(k * n, n, room);
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

void histogram(Summary& s, const Column& values, double least, double most, int threads) {
  const double span = s.symmetric.high - s.symmetric.low;
  const double low = std::max(least, s.symmetric.low - 0.5 * span),
               high = std::min(most, s.symmetric.high + 0.5 * span);
  if (!(high > low)) return;
  s.density.assign(bins, 0);
  for (std::size_t b = 0; b <= bins; ++b) s.bin_edges.push_back(low + (high - low) * static_cast<double>(b) / bins);
  const double per_width = bins / (high - low);
  Counts all{};
  std::mutex adding;
  for_parts(values, threads, [&](std::size_t, std::span<const double> some) {
    Counts c{};
    for (const double v : some) {
      const bool inside = v >= low && v <= high;
      c[inside ? std::min(bins - 1, static_cast<std::size_t>((v - low) * per_width)) : bins] += 1;
    }
    const std::lock_guard lock(adding);
    for (std::size_t b = 0; b < bins; ++b) all[b] += c[b];
  });
  for (std::size_t b = 0; b < bins; ++b) s.density[b] = static_cast<double>(all[b]);
  for (double& d : s.density) d /= static_cast<double>(s.valid) * (high - low) / bins;
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

double half_width_about(double y, std::vector<double> x, double p) {
  for (double& v : x) v = std::fabs(v - y);
  const auto farthest = x.begin() + static_cast<std::ptrdiff_t>(covered_ranks(x.size(), p));
  std::nth_element(x.begin(), farthest, x.end());
  return *farthest;
}

namespace {

/// Ranks, from 0, of ends that hold whatever values the failed samples had: these could all lie below, or all above, so
/// that the ends move by that many ranks at the most. None: beyond the values.
struct BoundRanks {
  std::optional<std::size_t> low, high;
};
BoundRanks bound_ranks(const Summary& s, double p) {
  const double n = static_cast<double>(s.valid), failed = static_cast<double>(s.failed), all = n + failed;
  const double alpha = 0.5 * (1 - p);
  const double low = std::floor(alpha * all) - failed, high = std::ceil((1 - alpha) * all);
  BoundRanks ranks;
  if (!(low < 1)) ranks.low = static_cast<std::size_t>(low) - 1;
  if (!(high > n)) ranks.high = static_cast<std::size_t>(high) - 1;
  return ranks;
}

/// The share that a fixed interval covers scatters by that much; so much longer or shorter is the shortest one.
double share_error(std::size_t n, double p) { return std::sqrt(p * (1 - p) / static_cast<double>(n)); }

/// All order statistics that add_intervals() reads.
OrderedColumn::Wanted wanted_order(const Summary& s, double p) {
  const std::size_t n = s.valid;
  const double share = share_error(n, p);
  OrderedColumn::Wanted wanted;
  const auto add = [&](std::size_t rank) { wanted.ranks.push_back({rank, rank}); };
  const auto [low, high] = symmetric_ranks(n, p);
  for (const std::size_t rank : {std::size_t{0}, low, high, n - 1}) add(rank);
  for (const double end : {0.5 * (1 - p), 1 - 0.5 * (1 - p)}) {
    const RankRange ranks = error_ranks(n, end);
    add(ranks.first), add(ranks.last);
  }
  if (const BoundRanks bounds = bound_ranks(s, p); s.failed > 0) {
    if (bounds.low) add(*bounds.low);
    if (bounds.high) add(*bounds.high);
  }
  for (const double covered : {p, std::min(p + share, 1.0), p - share})
    wanted.spans.push_back(covered_ranks(n, covered));
  wanted.middle = s.estimate;
  wanted.spare = spare_ranks(n, p);
  return wanted;
}

/// Both intervals, and what follows from order statistics.
template <class Ordered>
void add_intervals(Summary& s, const Ordered& ordered, const Column& values, double p, int threads) {
  const double alpha = 0.5 * (1 - p);
  const Ends symmetric = ordered_symmetric_ends(ordered, p), shortest = shortest_ends(ordered, p);
  const Ends shortest_se = shortest_errors(values, p, threads);
  s.monte_carlo_expanded = half_width_about(s.estimate, ordered, p);
  s.symmetric = {symmetric.low, symmetric.high, rank_error(ordered, alpha), rank_error(ordered, 1 - alpha),
                 symmetric.low, symmetric.high};
  s.shortest = {shortest.low, shortest.high, shortest_se.low, shortest_se.high, shortest.low, shortest.high};
  const double share = share_error(s.valid, p);
  const Ends wider = shortest_ends(ordered, std::min(p + share, 1.0)), narrower = shortest_ends(ordered, p - share);
  s.shortest_length_se = 0.5 * ((wider.high - wider.low) - (narrower.high - narrower.low));
  if (s.failed > 0) {
    const BoundRanks bounds = bound_ranks(s, p);
    s.symmetric.low_rank = s.shortest.low_rank = bounds.low ? ordered[*bounds.low] : -infinity;
    s.symmetric.high_rank = s.shortest.high_rank = bounds.high ? ordered[*bounds.high] : infinity;
  }
  histogram(s, values, ordered[0], ordered[s.valid - 1], threads);
}

/// By the kurtosis; NaN where there is none.
double standard_uncertainty_error(const Summary& s) {
  if (s.valid < least_for_kurtosis && s.standard_uncertainty > 0) return nan;
  return s.standard_uncertainty * std::sqrt(std::max(0.0, s.kurtosis - 1) / (4 * static_cast<double>(s.valid)));
}

} // namespace

Summary summarise(const propagation::Output& output, const Column& values, double p, int threads, KeptOrder* order,
                  Limits limits) {
  Summary s;
  s.output = output;
  KeptOrder own;
  KeptOrder& ordered = order ? *order : own;
  std::unique_ptr<OrderedColumn::Pass> pass; // of the order, made by the way
  if (values.size() > limits.sorted) {
    ordered.emplace(values, threads, limits.ordered);
    const auto ends = both_tails(ordered->about_valid(), p);
    pass = ordered->first_pass(ends);
  }
  Moments m = first_moments(values, threads, pass ? &pass->sieve : nullptr);
  if (ordered) ordered->finish_first(std::exchange(pass, nullptr), m.valid);
  s.valid = m.valid;
  s.failed = values.size() - m.valid;
  s.estimate = m.mean;
  const double n = static_cast<double>(s.valid);
  const bool intervals = s.valid >= 2 && !(n * (1 - p) < 1);
  OrderedColumn::Wanted wanted;
  if (ordered && intervals) {
    wanted = wanted_order(s, p);
    if (order) add_tail_ranks(s.valid, wanted.ranks);
    pass = ordered->next_pass(wanted);
  }
  add_central_moments(m, values, threads, pass ? &pass->sieve : nullptr);
  if (pass) ordered->finish(std::move(pass));

  if (s.valid < 2) {
    s.estimate = s.standard_uncertainty = s.monte_carlo_expanded = s.estimate_se = s.standard_uncertainty_se = nan;
    s.symmetric = s.shortest = {nan, nan, nan, nan, nan, nan};
    s.warning = "too few valid samples";
    return s;
  }
  s.standard_uncertainty = std::sqrt(m.variance);
  const bool constant = s.standard_uncertainty == 0;
  s.skewness = constant || s.valid >= least_for_skewness ? m.skewness : nan;
  s.kurtosis = constant || s.valid >= least_for_kurtosis ? m.kurtosis : nan;
  s.estimate_se = s.standard_uncertainty / std::sqrt(n);
  s.standard_uncertainty_se = standard_uncertainty_error(s);
  if (!intervals) {
    s.symmetric = s.shortest = {nan, nan, nan, nan, nan, nan};
    s.shortest_length_se = s.monte_carlo_expanded = nan;
    s.warning =
        fmt::format("no coverage interval: {} trials are fewer than 1 / (1 - p) = {:.0f}", s.valid, 1 / (1 - p));
    return s;
  }
  if (ordered) {
    ordered->find(wanted);
    add_intervals(s, *ordered, values, p, threads);
  } else {
    add_intervals(s, ordered_tails(values, s.valid, tail_size(s.valid, s.failed, p), threads), values, p, threads);
  }
  return s;
}

void join_rounded(Summary& s, double largest) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  // The values are too large for their mean, or for their squares.
  if (!std::isfinite(s.estimate) || !std::isfinite(s.standard_uncertainty) || !std::isfinite(largest)) return;
  if (!(s.standard_uncertainty > 0 && s.standard_uncertainty <= rounding * std::max(std::fabs(s.estimate), largest)))
    return;
  s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = s.monte_carlo_expanded = 0;
  s.skewness = s.kurtosis = s.shortest_length_se = 0;
  for (Interval* i : {&s.symmetric, &s.shortest}) {
    i->low = i->high = s.estimate;
    i->low_se = i->high_se = 0;
    if (s.failed == 0) i->low_rank = i->high_rank = s.estimate;
  }
}

} // namespace gumshoe::analysis
