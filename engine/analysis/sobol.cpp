#include "analysis/sobol.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "propagation/propagate.h"
#include "random/streams.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t rows_per_block = 1024, rows_per_group = 64, resamples = 400;

/// Sums over a group of rows for one output: what both estimators need. y is taken from an origin near
/// its mean, so that the squares do not drown it.
struct BaseSums {
  double n = 0, a = 0, aa = 0, b = 0, bb = 0, ab = 0;
  void operator+=(const BaseSums& o) { n += o.n, a += o.a, aa += o.aa, b += o.b, bb += o.bb, ab += o.ab; }
};
struct FrozenSums {
  double c = 0, cc = 0, bc = 0, jansen = 0;
  void operator+=(const FrozenSums& o) { c += o.c, cc += o.cc, bc += o.bc, jansen += o.jansen; }
};
struct Indices {
  double first, total;
};

Indices estimate(const BaseSums& s, const FrozenSums& f) {
  const double n = s.n, mean_b = s.b / n, mean_c = f.c / n;
  const double var_b = s.bb / n - mean_b * mean_b, var_c = f.cc / n - mean_c * mean_c;
  const double mean = 0.5 * (s.a + s.b) / n, variance = 0.5 * (s.aa + s.bb) / n - mean * mean;
  if (!(variance > 0) || !(var_b > 0) || !(var_c > 0)) return {0, 0};
  const double mean_a = s.a / n, var_a = s.aa / n - mean_a * mean_a;
  if (!(var_a > 0)) return {0, 0};
  const double total = 0.5 * f.jansen / n / variance;
  // corr(y_B, y_A) is zero but for chance, and chance moves it as it moves corr(y_B, y_AB_i) by the
  // correlation 1 - T_i of y_A with y_AB_i: taken off, small indices lose their noise of n^(-1/2).
  const double frozen = (f.bc / n - mean_b * mean_c) / std::sqrt(var_b * var_c);
  const double chance = (s.ab / n - mean_a * mean_b) / std::sqrt(var_a * var_b);
  return {frozen - std::max(0.0, 1 - total) * chance, total};
}

const char* verdict(const SobolIndex& i) {
  const double width = std::max(i.first_high - i.first_low, i.total_high - i.total_low);
  if (width > 0.1) return "not converged";
  return i.first_low <= 0 ? "zero within its interval" : "resolved";
}

} // namespace

std::vector<Sensitivity> sobol_indices(const propagation::Experiment& e, std::uint64_t n, int threads) {
  const auto& plan = e.plan();
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size();
  if (!plan.copulas.empty())
    throw InputError("analysis.sensitivity: the inputs are correlated",
                     "Sobol' indices are defined for independent inputs",
                     "take the correlation out or leave the indices out?");
  n = (n + rows_per_group - 1) / rows_per_group * rows_per_group;
  const std::size_t groups = n / rows_per_group, blocks = (n + rows_per_block - 1) / rows_per_block;

  std::vector<std::vector<bool>> reaches(outputs, std::vector<bool>(d, false));
  for (std::size_t o = 0; o < outputs; ++o)
    for (const std::size_t c : plan.gather[e.outputs()[o].reading])
      for (const std::size_t v : plan.columns[c].variates) reaches[o][v] = true;

  std::vector<BaseSums> base(groups * outputs);
  std::vector<FrozenSums> frozen(groups * outputs * d);
  const auto& run = e.scenario().run;
  const quantities::Sampler sampler(plan, quantities::PointSet::monte_carlo, n);
  // The origin of y: the first row's outputs.
  std::vector<double> origin(outputs);
  {
    propagation::Workspace w;
    std::vector<double> x(d * 64), y(outputs * 64);
    std::vector<std::uint8_t> status(64);
    std::vector<const double*> pointers(d);
    sampler.draw(0, 64, quantities::Purpose::sampling, x.data(), 64);
    for (std::size_t v = 0; v < d; ++v) pointers[v] = &x[v * 64];
    e.run(pointers, 64, w, y.data(), status.data());
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t i = 64; i-- > 0;)
        if (status[i] == 0) origin[o] = y[o * 64 + i];
  }

  propagation::parallel_for(blocks, threads, [&](std::size_t block) {
    const std::uint64_t first = block * rows_per_block;
    const std::size_t rows = std::min<std::uint64_t>(rows_per_block, n - first);
    propagation::Workspace w;
    std::vector<double> a(d * rows), b(d * rows), ya(outputs * rows), yb(outputs * rows), yc(d * outputs * rows);
    std::vector<std::uint8_t> status(rows), failed(rows, 0);
    sampler.draw(first, rows, quantities::Purpose::sampling, a.data(), rows);
    sampler.draw(first, rows, quantities::Purpose::pick_freeze, b.data(), rows);
    std::vector<const double*> pointers(d);
    const auto model = [&](double* y) {
      e.run(pointers, rows, w, y, status.data());
      for (std::size_t i = 0; i < rows; ++i) failed[i] |= status[i];
    };
    for (std::size_t v = 0; v < d; ++v) pointers[v] = &b[v * rows];
    model(yb.data());
    for (std::size_t v = 0; v < d; ++v) pointers[v] = &a[v * rows];
    model(ya.data());
    for (std::size_t v = 0; v < d; ++v) {
      pointers[v] = &b[v * rows];
      model(&yc[v * outputs * rows]);
      pointers[v] = &a[v * rows];
    }
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t i = 0; i < rows; ++i) {
        if (failed[i]) continue;
        const std::size_t group = (first + i) / rows_per_group;
        const double va = ya[o * rows + i] - origin[o], vb = yb[o * rows + i] - origin[o];
        base[group * outputs + o] += {1, va, va * va, vb, vb * vb, va * vb};
        for (std::size_t v = 0; v < d; ++v) {
          if (!reaches[o][v]) continue;
          const double vc = yc[(v * outputs + o) * rows + i] - origin[o];
          frozen[(group * outputs + o) * d + v] += {vc, vc * vc, vb * vc, (va - vc) * (va - vc)};
        }
      }
  });

  std::vector<double> uniform(groups);
  std::vector<std::vector<std::size_t>> picks(resamples, std::vector<std::size_t>(groups));
  const std::uint64_t key = hash64("sobol bootstrap", run.seed);
  for (std::size_t k = 0; k < resamples; ++k) {
    std::vector<double> u((groups + 63) / 64 * 64);
    random::uniforms({key, 0, static_cast<std::uint16_t>(quantities::Purpose::bootstrap)}, k * u.size(), u.size(),
                     u.data());
    for (std::size_t g = 0; g < groups; ++g)
      picks[k][g] = std::min(groups - 1, static_cast<std::size_t>(u[g] * static_cast<double>(groups)));
  }

  std::vector<Sensitivity> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    Sensitivity s;
    s.output = e.outputs()[o];
    s.base_samples = n;
    BaseSums all;
    for (std::size_t g = 0; g < groups; ++g) all += base[g * outputs + o];
    s.dropped_rows = n - static_cast<std::uint64_t>(all.n);
    std::vector<BaseSums> resampled(resamples);
    for (std::size_t k = 0; k < resamples; ++k)
      for (const std::size_t g : picks[k]) resampled[k] += base[g * outputs + o];
    for (std::size_t v = 0; v < d; ++v) {
      if (!reaches[o][v] || all.n < 2) continue;
      FrozenSums sum;
      for (std::size_t g = 0; g < groups; ++g) sum += frozen[(g * outputs + o) * d + v];
      const Indices at = estimate(all, sum);
      std::vector<double> first, total;
      for (std::size_t k = 0; k < resamples; ++k) {
        FrozenSums f;
        for (const std::size_t g : picks[k]) f += frozen[(g * outputs + o) * d + v];
        const Indices i = estimate(resampled[k], f);
        first.push_back(i.first);
        total.push_back(i.total);
      }
      std::ranges::sort(first);
      std::ranges::sort(total);
      constexpr std::size_t low = resamples * 25 / 1000, high = resamples - 1 - low;
      SobolIndex index{plan.variates[v].name, at.first, first[low], first[high], at.total, total[low], total[high], "", ""};
      index.first_verdict = index.total_verdict = verdict(index);
      s.indices.push_back(index);
    }
    results.push_back(s);
  }
  return results;
}

} // namespace gumshoe::analysis
