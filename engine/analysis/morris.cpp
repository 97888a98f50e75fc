#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/reach.h"
#include "analysis/screening.h"
#include "analysis/units.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/special_values.h"
#include "quantities/cells.h"
#include "random/streams.h"

namespace gumshoe::analysis {

namespace {

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

/// Steps of the variates, and their effects. Thread-safe.
class Steps {
public:
  explicit Steps(const propagation::Experiment& e) : e_(e), d_(e.plan().variates.size()), outputs_(e.outputs().size()) {
    for (const auto& v : e.plan().variates) {
      quantile_.emplace_back(v.distribution);
      scale_.push_back(scale_of(v.distribution));
    }
  }

  /// Numbers of a point: the status, then the effect of every variate on every output, [output][variate]; NaN where it
  /// did not move.
  std::size_t numbers() const { return 1 + outputs_ * d_; }

  /// n points, a multiple of 8, from `first` on: out[point * numbers() + k].
  void effects(std::uint64_t first, std::size_t n, double* out) const {
    const auto& variates = e_.plan().variates;
    propagation::Workspace w;
    std::vector<double> u(n), base(d_ * n), moved(d_ * n), y(outputs_ * n), z(outputs_ * n);
    std::vector<std::uint8_t> status(n), failed(n, 0);
    std::vector<const double*> pointers(d_);
    for (std::size_t v = 0; v < d_; ++v) {
      const random::Stream stream{hash64("morris", variates[v].key), quantities::reading_of(variates[v].cell), 0, 0};
      random::uniforms(stream, first, n, u.data());
      quantile_[v](u.data(), &base[v * n], n);
      for (double& x : u) x += x < 0.5 ? 0.5 : -0.5;
      quantile_[v](u.data(), &moved[v * n], n);
      pointers[v] = &base[v * n];
    }
    const auto model = [&](double* values) {
      e_.run(pointers, n, w, values, status.data());
      for (std::size_t i = 0; i < n; ++i) failed[i] |= status[i];
    };
    model(y.data());
    for (std::size_t v = 0; v < d_; ++v) {
      pointers[v] = &moved[v * n];
      model(z.data());
      pointers[v] = &base[v * n];
      for (std::size_t i = 0; i < n; ++i) {
        const double step = (moved[v * n + i] - base[v * n + i]) / scale_[v];
        const bool moves = step != 0 && !std::isnan(step);
        for (std::size_t o = 0; o < outputs_; ++o)
          out[i * numbers() + 1 + o * d_ + v] = moves ? (z[o * n + i] - y[o * n + i]) / step : nan;
      }
    }
    for (std::size_t i = 0; i < n; ++i) out[i * numbers()] = failed[i];
  }

private:
  const propagation::Experiment& e_;
  std::size_t d_, outputs_;
  std::vector<quantities::QuantileFunction> quantile_;
  std::vector<double> scale_;
};

} // namespace

propagation::Work morris_work(const propagation::Experiment& e, std::uint64_t trajectories) {
  const auto steps = std::make_shared<const Steps>(e);
  const std::size_t unit = points_per_unit * steps->numbers();
  return {.name = "morris",
          .units = (trajectories + points_per_unit - 1) / points_per_unit,
          .values = unit,
          .runs = points_per_unit * (1 + e.plan().variates.size()),
          .together = points_in_a_call(e) / points_per_unit,
          .compute = [steps](std::uint64_t first, std::uint64_t last, double* out) {
            steps->effects(first * points_per_unit, static_cast<std::size_t>(last - first) * points_per_unit, out);
          }};
}

std::vector<Morris> morris_screening(const propagation::Experiment& e, std::uint64_t trajectories,
                                     const propagation::Workers& workers) {
  const auto& plan = e.plan();
  if (!plan.copulas.empty())
    throw InputError("analysis.sensitivity.morris: the inputs are correlated",
                     "an elementary effect moves one input alone",
                     "remove the correlation, or use given_data or shapley");
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size(), numbers = 1 + outputs * d;
  const std::vector<double> values = workers.values(morris_work(e, trajectories));
  const auto failed = [&](std::size_t i) { return values[i * numbers] != 0; };
  std::vector<Morris> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    Morris m;
    m.output = e.outputs()[o];
    m.trajectories = trajectories;
    for (std::size_t i = 0; i < trajectories; ++i) m.dropped += failed(i);
    for (const Reach& reach : variates_reaching(e, m.output.reading)) {
      std::vector<double> of_one(trajectories);
      for (std::size_t i = 0; i < trajectories; ++i)
        of_one[i] = failed(i) ? nan : values[i * numbers + 1 + o * d + reach.variate];
      m.rows.push_back(row_of(plan.variates[reach.variate].name, of_one));
    }
    results.push_back(m);
  }
  return results;
}

} // namespace gumshoe::analysis
