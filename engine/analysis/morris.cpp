#include <cmath>

#include "analysis/reach.h"
#include "analysis/screening.h"
#include "base/error.h"
#include "base/hash.h"
#include "propagation/propagate.h"
#include "random/streams.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What a step is measured in.
double scale_of(const quantities::Distribution& d) {
  const double variance = d.variance();
  constexpr double inside = 0.682689492137086; // of one standard deviation about the mean of a normal
  return std::isfinite(variance) ? std::sqrt(variance)
                                 : 0.5 * (d.quantile(0.5 + 0.5 * inside) - d.quantile(0.5 - 0.5 * inside));
}

/// Effects of one variate on one output, in the order of the base points; absent where it did not move.
MorrisRow row_of(const std::string& input, const std::vector<double>& effects) {
  MorrisRow row{input, nan, nan, nan, nan};
  double n = 0, sum = 0, sum_absolute = 0;
  for (const double x : effects)
    if (!std::isnan(x)) n += 1, sum += x, sum_absolute += std::fabs(x);
  if (n == 0) return row;
  row.mean = sum / n;
  row.mean_absolute = sum_absolute / n;
  if (n < 2) return row;
  double squares = 0, squares_absolute = 0;
  for (const double x : effects) {
    if (std::isnan(x)) continue;
    squares += (x - row.mean) * (x - row.mean);
    squares_absolute += (std::fabs(x) - row.mean_absolute) * (std::fabs(x) - row.mean_absolute);
  }
  row.standard_deviation = std::sqrt(squares / (n - 1));
  row.mean_absolute_se = std::sqrt(squares_absolute / (n - 1) / n);
  return row;
}

} // namespace

std::size_t screening_block(const propagation::Experiment& e, std::uint64_t points) {
  const std::uint64_t dear = std::clamp<std::uint64_t>(e.model().block / 8 * 8, 64, 8192);
  return static_cast<std::size_t>(std::min(dear, (points + 7) / 8 * 8));
}

std::vector<Morris> morris_screening(const propagation::Experiment& e, std::uint64_t trajectories, int threads) {
  const auto& plan = e.plan();
  if (!plan.copulas.empty())
    throw InputError("analysis.sensitivity.morris: the inputs are correlated",
                     "an elementary effect moves one input alone",
                     "remove the correlation, or use given_data or shapley");
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size(), block = screening_block(e, trajectories);
  std::vector<quantities::QuantileFunction> quantile;
  std::vector<double> scale;
  for (const auto& v : plan.variates) {
    quantile.emplace_back(v.distribution);
    scale.push_back(scale_of(v.distribution));
  }
  std::vector<std::vector<double>> effects(outputs * d, std::vector<double>(trajectories, nan));
  std::vector<std::uint8_t> failed(trajectories, 0);
  propagation::parallel_for((trajectories + block - 1) / block, threads, [&](std::size_t b) {
    const std::size_t first = b * block, rows = std::min<std::size_t>(block, trajectories - first);
    propagation::Workspace w;
    std::vector<double> u(block), base(d * block), moved(d * block), y(outputs * block), z(outputs * block);
    std::vector<std::uint8_t> status(block);
    std::vector<const double*> pointers(d);
    for (std::size_t v = 0; v < d; ++v) {
      random::Stream stream{hash64("morris", plan.variates[v].key), 0, 0, 0};
      random::uniforms(stream, first, block, u.data());
      quantile[v](u.data(), &base[v * block], block);
      for (double& x : u) x += x < 0.5 ? 0.5 : -0.5;
      quantile[v](u.data(), &moved[v * block], block);
      pointers[v] = &base[v * block];
    }
    const auto model = [&](double* out) {
      e.run(pointers, block, w, out, status.data());
      for (std::size_t i = 0; i < rows; ++i) failed[first + i] |= status[i];
    };
    model(y.data());
    for (std::size_t v = 0; v < d; ++v) {
      pointers[v] = &moved[v * block];
      model(z.data());
      pointers[v] = &base[v * block];
      for (std::size_t i = 0; i < rows; ++i) {
        const double step = (moved[v * block + i] - base[v * block + i]) / scale[v];
        if (step == 0 || std::isnan(step)) continue;
        for (std::size_t o = 0; o < outputs; ++o)
          effects[o * d + v][first + i] = (z[o * block + i] - y[o * block + i]) / step;
      }
    }
  });

  std::vector<Morris> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    Morris m;
    m.output = e.outputs()[o];
    m.trajectories = trajectories;
    for (const std::uint8_t f : failed) m.dropped += f != 0;
    for (const Reach& reach : variates_reaching(e, m.output.reading)) {
      auto& of_one = effects[o * d + reach.variate];
      for (std::size_t i = 0; i < trajectories; ++i)
        if (failed[i]) of_one[i] = nan;
      m.rows.push_back(row_of(plan.variates[reach.variate].name, of_one));
    }
    results.push_back(m);
  }
  return results;
}

} // namespace gumshoe::analysis
