#include <algorithm>
#include <cmath>

#include "analysis/derivatives.h"
#include "analysis/poincare.h"
#include "analysis/reach.h"
#include "analysis/screening.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Derivatives of the outputs by the variates that reach them, at a block's points: at(output, k, point), NaN where
/// there is none.
struct Slopes {
  const std::vector<std::vector<Reach>>& reach;
  std::uint64_t points;
  std::vector<std::vector<std::vector<double>>> by; ///< [output][k of reach][point]
  Slopes(const std::vector<std::vector<Reach>>& r, std::uint64_t n) : reach(r), points(n), by(r.size()) {
    for (std::size_t o = 0; o < r.size(); ++o) by[o].assign(r[o].size(), std::vector<double>(n, nan));
  }
};

void exact_slopes(const propagation::Experiment& e, const std::vector<double>& x, std::size_t block, std::size_t first,
                  std::size_t rows, Slopes& slopes) {
  const std::size_t d = e.plan().variates.size(), measurands = e.measurands().size();
  std::vector<double> variates(d);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t v = 0; v < d; ++v) variates[v] = x[v * block + i];
    std::vector<Derivatives> all;
    for (std::size_t o = 0; o < slopes.by.size(); ++o) {
      const std::size_t reading = e.outputs()[o].reading;
      if (o % measurands == 0) all = differentiate(e, reading, e.point(reading, variates.data()), false);
      const Derivatives& at = all[o % measurands];
      if (at.status != Status::ok) continue;
      for (std::size_t k = 0; k < slopes.reach[o].size(); ++k)
        slopes.by[o][k][first + i] = at.first[slopes.reach[o][k].quantity];
    }
  }
}

void differences(const propagation::Experiment& e, std::vector<double>& x, std::size_t block, std::size_t first,
                 std::size_t rows, Slopes& slopes) {
  const std::size_t d = e.plan().variates.size(), outputs = slopes.by.size();
  propagation::Workspace w;
  std::vector<double> up(outputs * block), down(outputs * block);
  std::vector<std::uint8_t> status(block);
  std::vector<const double*> pointers(d);
  for (std::size_t v = 0; v < d; ++v) pointers[v] = &x[v * block];
  for (std::size_t v = 0; v < d; ++v) {
    const double variance = e.plan().variates[v].distribution.variance();
    const double h = 1e-3 * (std::isfinite(variance) && variance > 0 ? std::sqrt(variance) : 1e-3);
    const std::vector<double> kept(&x[v * block], &x[v * block] + block);
    for (const auto& [sign, out] : {std::pair{1.0, &up}, std::pair{-1.0, &down}}) {
      for (std::size_t i = 0; i < block; ++i) x[v * block + i] = kept[i] + sign * h;
      e.run(pointers, block, w, out->data(), status.data());
    }
    std::ranges::copy(kept, &x[v * block]);
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t k = 0; k < slopes.reach[o].size(); ++k)
        if (slopes.reach[o][k].variate == v)
          for (std::size_t i = 0; i < rows; ++i)
            slopes.by[o][k][first + i] = (up[o * block + i] - down[o * block + i]) / (2 * h);
  }
}

/// Mean and standard error of the squares at the points that are not dropped; the bound from them.
DgsmRow row_of(const quantities::Variate& variate, const std::vector<double>& slopes, const std::vector<bool>& dropped,
               double constant, const Summary& summary) {
  DgsmRow row{variate.name, nan, nan, nan, nan, nan};
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (!dropped[i]) n += 1, sum += slopes[i] * slopes[i];
  if (n < 2) return row;
  row.nu = sum / n;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (!dropped[i]) squares += std::pow(slopes[i] * slopes[i] - row.nu, 2);
  row.nu_se = std::sqrt(squares / (n - 1) / n);
  const double u = summary.standard_uncertainty;
  row.bound = u > 0 ? constant * row.nu / (u * u) : nan;
  const double of_nu = row.nu > 0 ? row.nu_se / row.nu : 0;
  const double of_variance =
      std::isfinite(summary.standard_uncertainty_se) ? 2 * summary.standard_uncertainty_se / u : 0;
  const double half = 1.959964 * row.bound * std::hypot(of_nu, of_variance);
  row.bound_low = std::fmax(0, row.bound - half);
  row.bound_high = row.bound + half;
  if (std::isnan(row.bound)) row.bound_low = nan;
  return row;
}

} // namespace

std::vector<Dgsm> derivative_measures(const propagation::Experiment& e, std::uint64_t points,
                                      const std::vector<Summary>& summaries, int threads) {
  const auto& plan = e.plan();
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size();
  const bool by_differences = e.scenario().method == scenario::Method::virtual_experiment || !e.has_gradient();
  const std::size_t block = screening_block(e, points);
  std::vector<std::vector<Reach>> reach;
  for (const auto& output : e.outputs()) reach.push_back(variates_reaching(e, output.reading));
  std::vector<double> constants(d, nan);
  if (plan.copulas.empty())
    propagation::parallel_for(d, threads,
                              [&](std::size_t v) { constants[v] = poincare_constant(plan.variates[v].distribution); });
  Slopes slopes(reach, points);
  const quantities::Sampler sampler(plan, quantities::PointSet::monte_carlo, points);
  propagation::parallel_for((points + block - 1) / block, threads, [&](std::size_t b) {
    std::vector<double> x(d * block);
    sampler.draw(b * block, block, quantities::Purpose::fresh, x.data(), block);
    const std::size_t rows = std::min<std::size_t>(block, points - b * block);
    if (by_differences)
      differences(e, x, block, b * block, rows, slopes);
    else
      exact_slopes(e, x, block, b * block, rows, slopes);
  });

  std::vector<Dgsm> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    Dgsm g;
    g.output = e.outputs()[o];
    g.points = points;
    g.exact = !by_differences;
    std::vector<bool> dropped(points, false);
    for (std::size_t i = 0; i < points; ++i) {
      dropped[i] = std::ranges::any_of(slopes.by[o], [&](const auto& s) { return !std::isfinite(s[i]); });
      g.dropped += dropped[i];
    }
    for (std::size_t k = 0; k < reach[o].size(); ++k)
      g.rows.push_back(row_of(plan.variates[reach[o][k].variate], slopes.by[o][k], dropped,
                              constants[reach[o][k].variate], summaries[o]));
    results.push_back(g);
  }
  return results;
}

} // namespace gumshoe::analysis
