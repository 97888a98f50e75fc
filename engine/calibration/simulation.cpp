// Simulated indications of all readings and their derivatives by the unknowns.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "calibration/data.h"
#include "propagation/propagate.h"

namespace gumshoe::calibration {

using models::Gradient;

Simulation::Simulation(const propagation::Experiment& e, std::vector<Unknown> unknowns, int threads)
    : experiment_(e), unknowns_(std::move(unknowns)), indications_(e.model().card->indications.size()),
      threads_(threads) {
  const auto& s = e.scenario();
  if (!e.model().simulate_gradient && !(e.model().kernels && e.model().kernels() && e.model().kernels()->simulate))
    refuse(s.file, fmt::format("model {}: it cannot simulate its indications", s.model),
           "residuals are measured minus simulated indications",
           e.scenario().made ? "add [model.indications] with a formula for each" : "");
  rows_ = s.readings.size() * indications_;
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    points_.push_back(e.reading_point(r));
    involved_.emplace_back();
    for (std::size_t u = 0; u < unknowns_.size(); ++u)
      if (e.plan().gather[r][unknowns_[u].quantity] == unknowns_[u].column) involved_.back().push_back(u);
  }
}

bool Simulation::exact() const { return experiment_.model().simulate_gradient != nullptr; }

bool Simulation::operator()(const double* x, double* simulated, double* jacobian) const {
  if (jacobian) std::fill_n(jacobian, rows_ * unknowns_.size(), 0.0);
  return exact() ? by_dual_numbers(x, simulated, jacobian) : by_differences(x, simulated, jacobian);
}

std::uint8_t Simulation::reading_by_duals(std::size_t reading, const double* x, double* simulated,
                                          double* jacobian) const {
  constexpr std::size_t chunk = 8;
  const auto& involved = involved_[reading];
  const auto& e = experiment_;
  std::vector<Gradient> point(points_[reading].begin(), points_[reading].end());
  for (const std::size_t u : involved) point[unknowns_[u].quantity] = Gradient(x[u]);
  std::vector<Gradient> out(indications_), measurands(e.model().card->measurands.size());
  models::PointCall<Gradient> call;
  call.quantities = point.data();
  call.effects = point.data() + e.model_quantities();
  call.active = e.active();
  call.conditions = e.scenario().readings[reading].conditions.data();
  call.indications = point.data() + e.first_indication();
  call.measurands = measurands.data();
  call.simulated = out.data();
  call.evaluation = static_cast<int>(e.evaluation());
  call.context = e.model().context;
  std::size_t at = 0;
  do {
    const std::size_t end = jacobian ? std::min(involved.size(), at + chunk) : at;
    for (std::size_t i = at; i < end; ++i) {
      const Unknown& u = unknowns_[involved[i]];
      point[u.quantity] = Gradient::variable(x[involved[i]], static_cast<int>(i - at));
    }
    const auto outcome = e.model().simulate_gradient(call);
    if (outcome.status != 0) return outcome.status;
    for (const propagation::StatedSize& s : e.stated())
      out[s.indication] = out[s.indication] + point[s.quantity] * (*s.loading)[reading];
    for (std::size_t k = 0; k < indications_; ++k) {
      simulated[reading * indications_ + k] = out[k].v;
      for (std::size_t i = at; i < end; ++i)
        jacobian[(reading * indications_ + k) * unknowns_.size() + involved[i]] = out[k].d[i - at];
    }
    for (std::size_t i = at; i < end; ++i) point[unknowns_[involved[i]].quantity] = Gradient(x[involved[i]]);
    at = end;
  } while (jacobian && at < involved.size());
  return 0;
}

bool Simulation::by_dual_numbers(const double* x, double* simulated, double* jacobian) const {
  const std::size_t readings = points_.size();
  std::vector<std::uint8_t> status(readings, 0);
  const auto one = [&](std::size_t r) { status[r] = reading_by_duals(r, x, simulated, jacobian); };
  constexpr std::size_t worth_threads = 512;
  if (readings < worth_threads || threads_ == 1)
    for (std::size_t r = 0; r < readings; ++r) one(r);
  else
    propagation::parallel_for(readings, threads_, one);
  for (std::size_t r = 0; r < readings; ++r) {
    if (status[r] == 0) continue;
    failure_ = {r, static_cast<Status>(status[r])};
    return false;
  }
  return true;
}

/// All points of the differences are samples of one block: x, then x + h and x - h for each unknown.
bool Simulation::by_differences(const double* x, double* simulated, double* jacobian) const {
  const auto& e = experiment_;
  const std::size_t p = unknowns_.size(), readings = points_.size(), quantities = e.scenario().quantities.size();
  const std::size_t points = jacobian ? 1 + 2 * p : 1, samples = (points + 7) / 8 * 8;
  std::vector<double> h(p);
  std::vector<std::vector<double>> columns(p);
  for (std::size_t u = 0; u < p; ++u) {
    const Unknown& unknown = unknowns_[u];
    // The cube root of the rounding error balances it against the cubic term.
    h[u] = 6e-6 * std::max(std::fabs(x[u]), 0.1 * unknown.magnitude);
    columns[u].assign(samples, x[u]);
    if (jacobian) {
      columns[u][1 + 2 * u] = std::min(x[u] + h[u], unknown.high);
      columns[u][2 + 2 * u] = std::max(x[u] - h[u], unknown.low);
    }
  }
  std::vector<models::Column> wired(readings * quantities);
  std::vector<double*> out;
  std::vector<double> values(rows_ * samples), truth(readings * e.model().card->measurands.size() * samples);
  std::vector<std::size_t> own(readings);
  std::vector<models::Column> q, effects, conditions, indications;
  for (std::size_t r = 0; r < readings; ++r) {
    own[r] = r;
    for (std::size_t i = 0; i < quantities; ++i) wired[r * quantities + i] = {&points_[r][i], 0};
    for (const std::size_t u : involved_[r]) wired[r * quantities + unknowns_[u].quantity] = {columns[u].data(), 1};
    const auto* row = &wired[r * quantities];
    q.insert(q.end(), row, row + e.model_quantities());
    effects.insert(effects.end(), row + e.model_quantities(), row + e.first_indication());
    indications.insert(indications.end(), row + e.first_indication(), row + e.first_indication() + indications_);
    for (const double& c : e.scenario().readings[r].conditions) conditions.push_back({&c, 0});
  }
  for (std::size_t i = 0; i < rows_; ++i) out.push_back(&values[i * samples]);
  std::vector<double*> measurands;
  for (std::size_t i = 0; i < truth.size() / samples; ++i) measurands.push_back(&truth[i * samples]);
  std::vector<std::uint8_t> status(samples, 0);
  models::BlockCall call;
  call.samples = samples;
  call.readings = readings;
  call.quantities = q.data();
  call.effects = effects.data();
  call.effect_quantities = e.effect_quantities();
  call.active = e.active();
  call.conditions = conditions.data();
  call.indications = indications.data();
  call.simulated = out.data();
  call.measurands = measurands.data();
  call.solved_as = own.data();
  call.status = status.data();
  call.evaluation = static_cast<int>(e.evaluation());
  call.context = e.model().context;
  e.model().kernels()->simulate(call);
  for (const propagation::StatedSize& s : e.stated())
    for (std::size_t r = 0; r < readings; ++r) {
      const models::Column size = wired[r * quantities + s.quantity];
      for (std::size_t i = 0; i < points; ++i)
        out[r * indications_ + s.indication][i] += size.data[i * size.stride] * (*s.loading)[r];
    }
  for (std::size_t i = 0; i < points; ++i) {
    if (status[i] == 0) continue;
    failure_ = {0, static_cast<Status>(status[i])};
    return false;
  }
  for (std::size_t i = 0; i < rows_; ++i) {
    simulated[i] = out[i][0];
    for (std::size_t u = 0; jacobian && u < p; ++u)
      jacobian[i * p + u] = (out[i][1 + 2 * u] - out[i][2 + 2 * u]) / (columns[u][1 + 2 * u] - columns[u][2 + 2 * u]);
  }
  return true;
}

} // namespace gumshoe::calibration
