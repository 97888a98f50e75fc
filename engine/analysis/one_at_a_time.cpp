#include <algorithm>
#include <cmath>

#include "analysis/screening.h"

namespace gumshoe::analysis {

namespace {

/// Outputs with the quantities moved: first as estimated, then each step up and down; [point][output].
std::vector<std::vector<double>> moved_outputs(const propagation::Experiment& e, const scenario::OneAtATime& study,
                                               const std::vector<std::size_t>& quantities) {
  const auto& plan = e.plan();
  const std::size_t points = 1 + 2 * study.steps.size(), n = (points + 7) / 8 * 8;
  std::vector<std::vector<double>> columns(plan.columns.size());
  for (std::size_t k = 0; k < quantities.size(); ++k)
    for (const auto& of_reading : plan.gather) {
      const std::size_t c = of_reading[quantities[k]];
      const double estimate = e.column_estimates()[c];
      if (columns[c].empty()) columns[c].assign(n, estimate);
      columns[c][1 + 2 * k] = estimate + study.steps[k].step;
      columns[c][2 + 2 * k] = estimate - study.steps[k].step;
    }
  std::vector<const double*> pointers;
  for (const auto& column : columns) pointers.push_back(column.empty() ? nullptr : column.data());
  propagation::Workspace w;
  std::vector<double> y(e.outputs().size() * n);
  std::vector<std::uint8_t> status(n);
  e.run_columns(pointers, n, w, y.data(), status.data());
  std::vector<std::vector<double>> out(points, std::vector<double>(e.outputs().size()));
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t o = 0; o < e.outputs().size(); ++o) out[i][o] = y[o * n + i];
  return out;
}

} // namespace

std::vector<OneAtATimeTable> one_at_a_time(const propagation::Experiment& e) {
  std::vector<OneAtATimeTable> tables;
  for (const auto& study : e.scenario().analysis.one_at_a_time) {
    const auto& known = e.scenario().quantities;
    OneAtATimeTable table;
    table.title = study.title;
    table.outputs = e.outputs();
    std::vector<std::size_t> quantities;
    for (const auto& step : study.steps)
      quantities.push_back(static_cast<std::size_t>(
          std::ranges::find(known, step.quantity, &quantities::InputQuantity::name) - known.begin()));
    const auto y = moved_outputs(e, study, quantities);
    for (std::size_t k = 0; k < study.steps.size(); ++k) {
      const auto& q = known.at(quantities[k]);
      OneAtATimeRow row{q.name, q.unit, q.si_unit, study.steps[k].step, {}, {}};
      for (std::size_t o = 0; o < e.outputs().size(); ++o) {
        row.up.push_back(y[1 + 2 * k][o] - y[0][o]);
        row.down.push_back(y[2 + 2 * k][o] - y[0][o]);
      }
      table.rows.push_back(row);
    }
    tables.push_back(table);
  }
  return tables;
}

} // namespace gumshoe::analysis
