#pragma once
/// Quantities, plans and draws for the tests of sampling.
#include <cmath>
#include <string>
#include <vector>

#include "quantities/sample_plan.h"

namespace gumshoe::fixture {

using namespace quantities;

inline Distribution make(Family family, std::array<double, 4> parameters) { return {family, parameters, {}, {}}; }

inline Component component(std::string name, Distribution d, std::vector<std::string> per = {}) {
  return {std::move(name), d, 'B', HUGE_VAL, std::move(per), ""};
}

inline InputQuantity quantity(std::string name, std::vector<Component> components, double value = 0) {
  return {std::move(name), "mm", "m", {{{}, value, std::move(components), ""}}};
}

inline InputQuantity simple(std::string name, Distribution d) { return quantity(std::move(name), {component("a", d)}); }

inline Reading reading(Labels labels) { return {std::move(labels), {}, {}, 1}; }

inline const std::vector<Reading> one_reading = {reading({})};
inline const Distribution standard = make(Family::normal, {0, 1});
inline const Distribution rectangular = make(Family::rectangular, {0, 1});

/// All variates of samples [0, n), drawn in blocks.
inline std::vector<std::vector<double>> draw(const SamplePlan& plan, std::size_t n, PointSet design = PointSet::monte_carlo,
                                      std::size_t block = 4096, Purpose purpose = Purpose::sampling) {
  const Sampler sampler(plan, design, n);
  std::vector<std::vector<double>> rows(plan.variates.size(), std::vector<double>(n));
  std::vector<double> buffer(plan.variates.size() * block);
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = std::min(block, n - first);
    sampler.draw(first, count, purpose, buffer.data(), block);
    for (std::size_t v = 0; v < rows.size(); ++v)
      std::copy_n(buffer.data() + v * block, count, rows[v].begin() + static_cast<std::ptrdiff_t>(first));
  }
  return rows;
}

inline double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return xy / std::sqrt(xx * yy);
}

} // namespace gumshoe::fixture
