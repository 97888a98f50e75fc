#include "analysis/given_data.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/index_verdict.h"
#include "analysis/reach.h"
#include "analysis/summary.h"
#include "base/hash.h"
#include "base/special_values.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

constexpr double normal_95 = 1.959964;
using Order = std::vector<std::uint32_t>;

Order order_of(const std::vector<double>& x, std::uint64_t key) {
  Order order(x.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return x[a] != x[b] ? x[a] < x[b] : mix64(key ^ a) < mix64(key ^ b);
  });
  return order;
}

Index make_index(double value, double low, double high) {
  return {"", value, low, high, std::string(verdict(low, high))};
}

Index rank_index(const Order& order, const std::vector<double>& y) {
  const std::size_t n = y.size();
  const Moments m = moments(y);
  if (n < 4 || !(m.variance > 0)) return make_index(0, 0, n < 4 ? 1 : 0);
  std::vector<double> squares(n - 1), influence(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) squares[i] = 0.5 * std::pow(y[order[i + 1]] - y[order[i]], 2);
  const double within = moments(squares).mean;
  for (std::size_t i = 0; i + 1 < n; ++i)
    influence[i] = -(squares[i] - within) / m.variance +
                   within / (m.variance * m.variance) * (std::pow(y[order[i]] - m.mean, 2) - m.variance);
  double covariance[3] = {0, 0, 0};
  for (std::size_t lag = 0; lag < 3; ++lag)
    for (std::size_t i = 0; i + lag < influence.size(); ++i)
      covariance[lag] += influence[i] * influence[i + lag] / static_cast<double>(n);
  const double variance = std::max(covariance[0] + 2 * (covariance[1] - covariance[2]), 0.0) / static_cast<double>(n);
  const double value = 1 - within / m.variance, half = normal_95 * std::sqrt(variance);
  return make_index(value, value - half, value + half);
}

/// Classes of about equal size in the order given; equal values stay together.
std::vector<std::uint16_t> classes_of(const Order& order, const std::vector<double>& x, std::size_t wanted,
                                      std::size_t& count) {
  const std::size_t n = x.size();
  std::vector<std::uint16_t> out(n);
  std::size_t k = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && x[order[i]] != x[order[i - 1]] && i * wanted >= (k + 1) * n)
      k = std::max(k + 1, std::min(wanted - 1, i * wanted / n));
    out[order[i]] = static_cast<std::uint16_t>(k);
  }
  count = k + 1;
  return out;
}

/// |z| less g(z): z is a cell's difference over its standard deviation by chance, normal with mean t. g is chosen so
/// that the result has mean zero at t = 0 and, over all t, no net bias: (A - B z^2) exp(-z^2 / 2) with
/// sqrt(2 pi) (A - B) = 1 and (A - B / 2) / sqrt(2) = sqrt(2 / pi). Nowhere is the bias above 0.3.
constexpr double bump_a = 1.8578162, bump_b = 1.4588739;
double unbiased(double z) { return std::fabs(z) - (bump_a - bump_b * z * z) * std::exp(-0.5 * z * z); }
double slope(double z) {
  return (z < 0 ? -1 : 1) + (2 * bump_b * z + z * (bump_a - bump_b * z * z)) * std::exp(-0.5 * z * z);
}

struct Delta {
  double value = 0, se = 0;
};

Delta delta_of(const std::vector<std::uint16_t>& x, std::size_t nx, const std::vector<std::uint16_t>& y,
               std::size_t ny) {
  std::vector<double> count(nx * ny, 0), row(nx, 0), column(ny, 0), s(nx * ny, 0), row_mean(nx, 0), column_mean(ny, 0);
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) count[x[i] * ny + y[i]] += 1;
  for (std::size_t a = 0; a < nx; ++a)
    for (std::size_t b = 0; b < ny; ++b) row[a] += count[a * ny + b], column[b] += count[a * ny + b];
  Delta e;
  for (std::size_t a = 0; a < nx; ++a)
    for (std::size_t b = 0; b < ny; ++b) {
      if (row[a] == 0 || column[b] == 0) continue;
      const double p = column[b] / n, chance = std::sqrt(p * (1 - p) * (1 / row[a] - 1 / n));
      if (!(chance > 0)) continue;
      const double z = (count[a * ny + b] / row[a] - p) / chance;
      e.value += 0.5 * row[a] / n * chance * unbiased(z);
      s[a * ny + b] = slope(z);
      row_mean[a] += count[a * ny + b] / row[a] * s[a * ny + b];
      column_mean[b] += count[a * ny + b] / column[b] * s[a * ny + b];
    }
  double mean = 0, squares = 0;
  for (std::size_t a = 0; a < nx; ++a) mean += row[a] / n * row_mean[a];
  for (std::size_t a = 0; a < nx; ++a)
    for (std::size_t b = 0; b < ny; ++b)
      squares += count[a * ny + b] / n * std::pow(0.5 * (s[a * ny + b] - row_mean[a] - column_mean[b] + mean), 2);
  e.se = std::sqrt(squares / n);
  return e;
}

/// The finest table whose refinement is more than chance.
Index delta_index(const Order& x_order, const std::vector<double>& x, const Order& y_order,
                  const std::vector<double>& y) {
  Delta best;
  double gain = 0;
  for (std::size_t size = 8; size == 8 || (size <= 64 && size * size * 16 <= x.size()); size *= 2) {
    std::size_t nx = 0, ny = 0;
    const auto cx = classes_of(x_order, x, size, nx), cy = classes_of(y_order, y, size, ny);
    const Delta e = delta_of(cx, nx, cy, ny);
    if (size > 8 && e.value - best.value < best.se) continue;
    gain = size > 8 ? e.value - best.value : 0;
    best = e;
  }
  // Classes blur the densities. Finer ones would bring 0.3 to 0.6 of what the last refinement brought (normal sums,
  // shares of 4 to 98 %, by integration), and what is left of the bias by chance takes some of it back. One that brings
  // less than a standard error is not seen.
  const double value = best.value + gain / 3, half = std::hypot(normal_95 * best.se, std::max(gain / 3, best.se));
  return make_index(value, value - half, value + half);
}

} // namespace

GivenDataPair given_data_pair(const std::vector<double>& x, const std::vector<double>& y, std::uint64_t key) {
  const Order by_x = order_of(x, key), by_y = order_of(y, ~key);
  return {rank_index(by_x, y), delta_index(by_x, x, by_y, y)};
}

std::vector<GivenData> given_data_indices(const propagation::Experiment& e, const ValuesOf& values,
                                          std::uint64_t samples, int threads) {
  const auto& plan = e.plan();
  const auto& run = e.scenario().run;
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size();
  const std::uint64_t n = std::min<std::uint64_t>({samples, run.samples, std::uint64_t{1} << 31});
  std::vector<std::vector<double>> y(outputs);
  std::vector<bool> valid(n, true);
  for (std::size_t o = 0; o < outputs; ++o) {
    const Column all = values(o);
    y[o].assign(n, nan);
    all.copy(0, std::span(y[o]).first(std::min<std::uint64_t>(n, all.size())));
    for (std::size_t i = 0; i < n; ++i)
      if (!std::isfinite(y[o][i])) valid[i] = false;
  }
  const auto kept = [&](auto begin) {
    std::vector<double> out;
    for (std::size_t i = 0; i < n; ++i, ++begin)
      if (valid[i]) out.push_back(*begin);
    return out;
  };
  std::vector<Order> y_order(outputs);
  propagation::parallel_for(outputs, threads, [&](std::size_t o) {
    y[o] = kept(y[o].begin());
    y_order[o] = order_of(y[o], plan.variates.size());
  });
  const std::uint64_t used = static_cast<std::uint64_t>(std::ranges::count(valid, true));

  const std::size_t drawn = (n + 7) / 8 * 8;
  std::vector<double> x(d * drawn);
  const quantities::Sampler sampler(plan, propagation::point_set(run.design), run.samples);
  constexpr std::size_t part = propagation::block_samples;
  propagation::parallel_for((drawn + part - 1) / part, threads, [&](std::size_t b) {
    sampler.draw(b * part, std::min(part, drawn - b * part), quantities::Purpose::sampling, x.data() + b * part, drawn);
  });

  std::vector<std::vector<GivenDataPair>> pairs(d, std::vector<GivenDataPair>(outputs));
  std::vector<std::vector<Reach>> reach;
  for (const auto& output : e.outputs()) reach.push_back(variates_reaching(e, output.reading));
  std::vector<bool> has_variance(outputs, true);
  for (std::size_t o = 0; o < outputs; ++o)
    for (const Reach& r : reach[o])
      if (!std::isfinite(plan.variates[r.variate].distribution.variance())) has_variance[o] = false;
  propagation::parallel_for(d, threads, [&](std::size_t v) {
    const auto own = kept(x.begin() + static_cast<long>(v * drawn));
    const Order by_x = order_of(own, plan.variates[v].key);
    for (std::size_t o = 0; o < outputs; ++o) {
      if (std::ranges::find(reach[o], v, &Reach::variate) == reach[o].end()) continue;
      pairs[v][o] = {rank_index(by_x, y[o]), delta_index(by_x, own, y_order[o], y[o])};
      if (!has_variance[o]) pairs[v][o].first = make_index(nan, nan, nan);
      pairs[v][o].first.input = pairs[v][o].delta.input = plan.variates[v].name;
    }
  });

  std::vector<GivenData> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    GivenData g;
    g.output = e.outputs()[o];
    g.samples = used;
    g.dropped = n - used;
    for (const Reach& r : reach[o]) {
      g.first.push_back(pairs[r.variate][o].first);
      g.delta.push_back(pairs[r.variate][o].delta);
    }
    results.push_back(g);
  }
  return results;
}

} // namespace gumshoe::analysis
