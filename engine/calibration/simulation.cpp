// Simulated indications of all readings and their derivatives by the unknowns.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "calibration/data.h"

namespace gumshoe::calibration {

Simulation::Simulation(const propagation::Experiment& e, std::vector<Unknown> unknowns, int threads)
    : forward_(e.forward().on_threads(threads)), unknowns_(std::move(unknowns)), points_(e.estimates()) {
  const auto& s = e.scenario();
  if (!forward_.has_simulation())
    refuse(s.file, fmt::format("model {}: the model cannot simulate its indications", s.model),
           "residuals are measured minus simulated indications",
           s.made ? "add [model.indications] with a formula for each" : "");
  for (const Unknown& u : unknowns_) {
    partials_.push_back({u.quantity, 0, 0, true, {}});
    for (std::size_t r = 0; r < points_.size(); ++r)
      if (e.plan().gather[r][u.quantity] == u.column) partials_.back().readings.push_back(r);
  }
}

const propagation::Points& Simulation::points_at(const double* x) const {
  for (std::size_t u = 0; u < unknowns_.size(); ++u)
    for (const std::size_t r : partials_[u].readings) points_[r][unknowns_[u].quantity] = x[u];
  return points_;
}

bool Simulation::depends_on(const double* x, std::size_t quantity, double shift) const {
  const auto moved = [&](double by) { return propagation::Variation{{{quantity, by, false, {}}}}; };
  const auto f = forward_.indications(points_at(x), std::vector{moved(0), moved(shift), moved(-shift)});
  if (f.status[0] != Status::ok) return true;
  bool known = false;
  for (const std::size_t v : {1, 2}) {
    if (f.status[v] != Status::ok) continue;
    known = true;
    for (std::size_t row = 0; row < f.rows; ++row)
      if (f.at(v, row) != f.at(0, row)) return true;
  }
  return !known;
}

bool Simulation::operator()(const double* x, double* simulated, double* jacobian) const {
  const propagation::Points& at = points_at(x);
  std::vector<propagation::Partial> partials = partials_;
  const std::size_t p = unknowns_.size();
  for (std::size_t u = 0; u < p; ++u) {
    // The cube root of the rounding error balances it against the cubic term.
    const double h = 6e-6 * std::max(std::fabs(x[u]), 0.1 * unknowns_[u].magnitude);
    partials[u].up = std::min(x[u] + h, unknowns_[u].high);
    partials[u].down = std::max(x[u] - h, unknowns_[u].low);
  }
  if (!jacobian) partials.clear();
  const propagation::Linearisation f = forward_.linearise(at, partials);
  Status status = f.status;
  for (const Status s : f.by_partial)
    if (status == Status::ok) status = s;
  if (status != Status::ok) {
    failure_ = {f.failed_reading, status};
    return false;
  }
  std::copy(f.values.begin(), f.values.end(), simulated);
  for (std::size_t u = 0; u < partials.size(); ++u)
    for (std::size_t i = 0; i < f.rows; ++i) jacobian[i * p + u] = f.derivatives[u * f.rows + i];
  return true;
}

} // namespace gumshoe::calibration
