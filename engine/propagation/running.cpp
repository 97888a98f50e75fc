// One block of samples of an experiment.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "propagation/experiment.h"

namespace gumshoe::propagation {
namespace {

// One pass without a branch each: most blocks have none.
bool none_failed(const std::uint8_t* status, std::size_t n) {
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < n; i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, status + i, 8);
    found |= eight;
  }
  return found == 0;
}

bool perhaps_nan(const double* x, std::size_t n) {
  double sums[8] = {}; // of zeros, unless there is a NaN (or an infinity: looked at again then)
  for (std::size_t i = 0; i < n; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sums[k] += x[i + k] * 0.0;
  double sum = 0;
  for (const double s : sums) sum += s;
  return std::isnan(sum);
}

/// A failed sample has a status and is NaN in every row.
void mark_failed(std::size_t rows, std::size_t n, double* outputs, std::uint8_t* status) {
  for (std::size_t row = 0; row < rows; ++row) {
    if (!perhaps_nan(outputs + row * n, n)) continue;
    for (std::size_t i = 0; i < n; ++i)
      if (status[i] == 0 && std::isnan(outputs[row * n + i])) status[i] = code(Status::no_solution);
  }
  if (none_failed(status, n)) return;
  for (std::size_t i = 0; i < n; ++i)
    if (status[i] != 0)
      for (std::size_t row = 0; row < rows; ++row) outputs[row * n + i] = std::numeric_limits<double>::quiet_NaN();
}

void point_at_rows(std::vector<double*>& rows, std::size_t count, double* values, std::size_t n) {
  rows.resize(count);
  for (std::size_t i = 0; i < count; ++i) rows[i] = values + i * n;
}

} // namespace

void Experiment::run(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs,
                     std::uint8_t* status) const {
  w.columns.resize(plan_.columns.size() * n);
  plan_.assemble(variates, n, w.columns.data(), n); // constant columns are read with stride 0
  w.drawn.clear();
  for (std::size_t c = 0; c < plan_.columns.size(); ++c)
    w.drawn.push_back(plan_.columns[c].variates.empty() ? models::Column{&column_estimates_[c], 0}
                                                        : models::Column{&w.columns[c * n], 1});
  run_drawn(n, w, outputs, status);
}

void Experiment::run_and_keep(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs,
                              std::uint8_t* status) const {
  w.keeping = Workspace::Keeping::keep;
  run(variates, n, w, outputs, status);
  w.keeping = Workspace::Keeping::nothing;
}

void Experiment::run_changed(std::span<const double* const> variates, const std::vector<std::size_t>& changed,
                             std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  w.changed.resize(changed.size() * n);
  for (std::size_t k = 0; k < changed.size(); ++k) {
    plan_.assemble_column(changed[k], variates, n, &w.changed[k * n]);
    w.drawn[changed[k]].data = &w.changed[k * n];
  }
  w.keeping = Workspace::Keeping::go_on;
  run_drawn(n, w, outputs, status);
  w.keeping = Workspace::Keeping::nothing;
  for (const std::size_t c : changed) w.drawn[c].data = &w.columns[c * n];
}

void Experiment::run_columns(std::span<const double* const> columns, std::size_t n, Workspace& w, double* outputs,
                             std::uint8_t* status) const {
  w.drawn.clear();
  for (std::size_t c = 0; c < plan_.columns.size(); ++c)
    w.drawn.push_back(columns[c] ? models::Column{columns[c], 1} : models::Column{&column_estimates_[c], 0});
  run_drawn(n, w, outputs, status);
}

Responses Experiment::outputs_at(std::size_t reading, const std::vector<double>& point,
                                 std::span<const Variation> variations) const {
  if (prediction_) {
    Responses out = forward_.indications(reading, point, variations);
    const Range noise = layout().indications;
    for (std::size_t v = 0; v < variations.size(); ++v) {
      std::vector<double> here = point;
      for (const Change& c : variations[v].changes)
        here[c.quantity] = c.absolute ? c.value : point[c.quantity] + c.value;
      for (std::size_t k = 0; k < noise.size(); ++k) out.values[v * out.rows + k] += here[noise[k]];
    }
    return out;
  }
  if (!joint_) return forward_.measurands(reading, point, variations);
  const std::size_t count = variations.size(), n = padded(count), width = point.size(), rows = outputs_.size();
  std::vector<double> columns(width * n), values(rows * n);
  for (std::size_t c = 0; c < width; ++c) std::fill_n(&columns[c * n], n, point[c]);
  for (std::size_t v = 0; v < count; ++v)
    for (const Change& c : variations[v].changes)
      columns[c.quantity * n + v] = c.absolute ? c.value : point[c.quantity] + c.value;
  std::vector<const double*> pointers;
  for (std::size_t c = 0; c < width; ++c) pointers.push_back(&columns[c * n]);
  std::vector<std::uint8_t> status(n);
  Workspace w;
  run_columns(pointers, n, w, values.data(), status.data());
  Responses out{rows, {}, {}};
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t row = 0; row < rows; ++row) out.values.push_back(values[row * n + v]);
    out.status.push_back(static_cast<Status>(status[v]));
  }
  return out;
}

bool Experiment::has_gradient() const {
  return prediction_ ? forward_.has_derivatives() : model().evaluate_gradient && !joint_;
}
bool Experiment::has_curvature() const { return !prediction_ && has_gradient() && model().evaluate_curvature; }

models::PointOutcome Experiment::outputs_at(std::size_t reading, const std::vector<models::Gradient>& point,
                                            std::vector<models::Gradient>& out) const {
  if (!prediction_) return forward_.measurands(reading, point, out);
  const auto outcome = forward_.indications(reading, point, out);
  for (std::size_t k = 0; k < layout().indications.size(); ++k) out[k] = out[k] + point[layout().indications[k]];
  return outcome;
}

models::PointOutcome Experiment::outputs_at(std::size_t reading, const std::vector<models::Curvature>& point,
                                            std::vector<models::Curvature>& out) const {
  return forward_.measurands(reading, point, out);
}

void Experiment::run_drawn(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  if (!mean_) return run_model(n, w, outputs, status);
  const std::size_t readings = scenario_.readings.size(), rows = outputs_.size();
  w.single.resize(readings * rows * n);
  run_model(n, w, w.single.data(), status);
  const double share = 1 / static_cast<double>(readings);
  for (std::size_t i = 0; i < rows * n; ++i) {
    double sum = 0;
    for (std::size_t r = 0; r < readings; ++r) sum += w.single[r * rows * n + i];
    outputs[i] = sum * share;
  }
}

/// Points the block's columns at the drawn ones, or at the estimates; indications at the workspace's.
void Experiment::wire(Workspace& w, std::size_t n, bool estimates) const {
  const std::size_t readings = scenario_.readings.size();
  const Range noise = layout().indications;
  w.block.clear(n);
  for (std::size_t r = 0; r < readings; ++r) {
    w.row.clear();
    for (std::size_t q = 0; q < layout().size(); ++q) {
      const std::size_t c = plan_.gather[r][q];
      if (noise.contains(q))
        w.row.push_back({&w.indications[(r * noise.size() + q - noise.begin) * n], 1});
      else
        w.row.push_back(estimates ? models::Column{&column_estimates_[c], 0} : w.drawn[c]);
    }
    forward_.add(w.block, r, w.row);
  }
  w.block.solved_as = solved_as_;
  w.block.first_sample = w.first_sample;
}

/// The machine under the drawn quantities: what it would read, and the truth.
void Experiment::simulate(std::size_t rows, std::size_t n, Workspace& w, std::uint8_t* status) const {
  w.truth.resize(rows * n);
  point_at_rows(w.true_measurands, rows, w.truth.data(), n);
  point_at_rows(w.simulated, w.indications.size() / n, w.indications.data(), n);
  auto call = forward_.call(w.block, w.simulated.data(), w.true_measurands.data(), status);
  // The machine itself, not what an approximate evaluation takes it for.
  if (!joint_) call.evaluation = model().machine_of ? model().machine_of(call.evaluation) : 0;
  model().kernels()->simulate(call);
}

/// Indications: what was read (or simulated) plus the drawn noise. Stated effects: the evaluation subtracts the drawn
/// size; in a virtual experiment the indication contains it, and the estimate is subtracted.
void Experiment::add_noise(std::size_t n, Workspace& w) const {
  const Range noise = layout().indications;
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r)
    for (std::size_t k = 0; k < noise.size(); ++k) {
      double* x = &w.indications[(r * noise.size() + k) * n];
      const models::Column drawn = w.drawn[plan_.gather[r][noise[k]]];
      const double read = virtual_ ? 0 : scenario_.readings[r].indications[k];
      for (std::size_t i = 0; i < n; ++i) x[i] = (virtual_ ? x[i] : read) + drawn.data[i * drawn.stride];
    }
  for (const StatedSize& s : forward_.stated())
    for (std::size_t r = 0; r < scenario_.readings.size() && noise.contains(s.target); ++r) {
      double* x = &w.indications[(r * noise.size() + s.target - noise.begin) * n];
      const models::Column size = w.drawn[plan_.gather[r][s.quantity]];
      const double held = virtual_ ? column_estimates_[plan_.gather[r][s.quantity]] : 0;
      const double loading = virtual_ ? s.loading[r] : -s.loading[r];
      for (std::size_t i = 0; i < n; ++i) x[i] += (size.data[i * size.stride] - held) * loading;
    }
}

void Experiment::predict_linear(std::size_t n, Workspace& w) const {
  const std::size_t indications = layout().indications.size();
  for (std::size_t row = 0; row < linear_.rows; ++row) {
    double* const x = &w.indications[row * n];
    std::fill_n(x, n, linear_.values[row]);
    for (std::size_t p = 0; p < partials_.size(); ++p) {
      const double slope = linear_.derivatives[p * linear_.rows + row];
      const std::size_t c = plan_.gather[row / indications][partials_[p].quantity];
      const models::Column drawn = w.drawn[c];
      if (slope == 0 || drawn.stride == 0) continue;
      for (std::size_t i = 0; i < n; ++i) x[i] += slope * (drawn.data[i] - column_estimates_[c]);
    }
  }
}

/// What the machine would read, stated effects and noise included.
void Experiment::predict(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  if (linear_.rows > 0) {
    predict_linear(n, w);
  } else {
    wire(w, n, false);
    const BlockValues found = forward_.simulate(w.block);
    std::copy(found.status.begin(), found.status.end(), status);
    std::ranges::copy(found.indications, w.indications.begin());
  }
  const Range noise = layout().indications;
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r)
    for (std::size_t k = 0; k < noise.size(); ++k) {
      const std::size_t row = (r * noise.size() + k) * n;
      const models::Column drawn = w.drawn[plan_.gather[r][noise[k]]];
      for (std::size_t i = 0; i < n; ++i) outputs[row + i] = w.indications[row + i] += drawn.data[i * drawn.stride];
    }
  mark_failed(outputs_.size(), n, outputs, status);
}

void Experiment::evaluate(Workspace& w, std::uint8_t* status) const {
  const auto call = forward_.call(w.block, nullptr, w.measurands.data(), status);
  // Columns to which stated effects add are made anew for each block, perhaps where others were.
  const bool keeps = keeping_ && !virtual_ && w.block.moved.empty();
  if (keeps && w.keeping == Workspace::Keeping::keep)
    keeping_->keep(call, w.kept);
  else if (keeps && w.keeping == Workspace::Keeping::go_on)
    keeping_->go_on(call, w.kept);
  else
    model().kernels()->evaluate(call);
}

void Experiment::run_model(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  const std::size_t readings = scenario_.readings.size(), rows = outputs_.size() * (mean_ ? readings : 1);
  w.indications.resize(readings * layout().indications.size() * n);
  std::fill_n(status, n, std::uint8_t{0});
  if (prediction_) return predict(n, w, outputs, status);
  wire(w, n, false);
  if (virtual_) {
    simulate(rows, n, w, status);
    add_noise(n, w);
    wire(w, n, true);
  } else {
    add_noise(n, w);
  }
  point_at_rows(w.measurands, rows, outputs, n);
  evaluate(w, status);
  if (virtual_)
    for (std::size_t row = 0; row < rows; ++row)
      if (!measurands_[row % measurands_.size()].diagnostic)
        for (std::size_t i = row * n; i < (row + 1) * n; ++i) outputs[i] -= w.truth[i];
  mark_failed(rows, n, outputs, status);
}

} // namespace gumshoe::propagation
