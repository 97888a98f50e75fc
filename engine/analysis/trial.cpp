#include "analysis/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/reach.h"
#include "analysis/summary.h"
#include "propagation/propagate.h"
#include "scenario/conditions.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t points_in_a_run = 4096;

/// True if every reading has the same labels, so that one alone makes a scenario.
bool alike(const std::vector<quantities::Reading>& readings) {
  return std::ranges::all_of(readings, [&](const quantities::Reading& r) {
    return std::ranges::equal(
        r.labels, readings[0].labels, {}, [](const auto& l) { return l.first; }, [](const auto& l) { return l.first; });
  });
}

} // namespace

Trial::Trial(const propagation::Experiment& e, std::size_t output, int threads)
    : scenario_(std::make_unique<scenario::Scenario>(e.scenario())), row_(output), threads_(threads) {
  const std::size_t reading = e.outputs()[output].reading, measurands = e.measurands().size();
  if (!e.joint() && alike(e.scenario().readings)) {
    scenario::narrow_to_reading(*scenario_, e.scenario(), reading);
    row_ = output - reading * measurands;
  }
  experiment_ = std::make_unique<propagation::Experiment>(*scenario_);
  const auto& plan = experiment_->plan();
  for (const auto& r : variates_reaching(*experiment_, experiment_->outputs()[row_].reading))
    reaching_.push_back(r.variate);

  constexpr std::uint64_t most = 100'000, most_numbers = 20'000'000;
  const std::size_t variates = plan.variates.size();
  const std::uint64_t n = std::min({scenario_->run.samples, most, most_numbers / std::max<std::size_t>(1, variates)});
  points_ = static_cast<std::size_t>(std::max<std::uint64_t>(8, n / 8 * 8));
  drawn_.resize(variates * points_);
  const quantities::Sampler sampler(plan, quantities::PointSet::monte_carlo, points_);
  propagation::parallel_for((points_ + points_in_a_run - 1) / points_in_a_run, threads, [&](std::size_t b) {
    const std::size_t first = b * points_in_a_run;
    sampler.draw(first, std::min(points_in_a_run, points_ - first), quantities::Purpose::sampling,
                 drawn_.data() + first, points_);
  });
  for (const auto& v : plan.variates) {
    const double mean = v.distribution.mean();
    means_.push_back(std::isfinite(mean) ? mean : v.distribution.quantile(0.5));
  }
}

double Trial::expanded_uncertainty(const std::vector<double>& scale) {
  ++runs_;
  const std::size_t variates = scale.size(), rows = experiment_->outputs().size();
  std::vector<double> y(points_);
  propagation::parallel_for((points_ + points_in_a_run - 1) / points_in_a_run, threads_, [&](std::size_t b) {
    const std::size_t first = b * points_in_a_run, n = std::min(points_in_a_run, points_ - first);
    std::vector<double> scaled(variates * n), outputs(rows * n);
    std::vector<const double*> pointers;
    for (std::size_t v = 0; v < variates; ++v) {
      const double* drawn = &drawn_[v * points_ + first];
      pointers.push_back(drawn);
      if (scale[v] == 1) continue;
      for (std::size_t i = 0; i < n; ++i) scaled[v * n + i] = means_[v] + scale[v] * (drawn[i] - means_[v]);
      pointers.back() = &scaled[v * n];
    }
    std::vector<std::uint8_t> status(n);
    propagation::Workspace workspace;
    experiment_->run(pointers, n, workspace, outputs.data(), status.data());
    std::copy_n(&outputs[row_ * n], n, y.begin() + static_cast<long>(first));
  });
  std::erase_if(y, [](double v) { return std::isnan(v); });
  const double failed = static_cast<double>(points_ - y.size());
  if (y.size() < 2 || failed > scenario_->run.max_failed_share * static_cast<double>(points_))
    return std::numeric_limits<double>::infinity();
  const double mean = moments(y).mean;
  return half_width_about(mean, std::move(y), scenario_->analysis.coverage_probability);
}

} // namespace gumshoe::analysis
