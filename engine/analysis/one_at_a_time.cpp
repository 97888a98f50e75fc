#include <algorithm>
#include <cmath>

#include "analysis/screening.h"

namespace gumshoe::analysis {

namespace {

/// Positions of the table's quantities in the scenario.
std::vector<std::size_t> quantities_of(const propagation::Experiment& e, const scenario::OneAtATime& study) {
  const auto& known = e.scenario().quantities;
  std::vector<std::size_t> out;
  for (const auto& step : study.steps)
    out.push_back(static_cast<std::size_t>(std::ranges::find(known, step.quantity, &quantities::InputQuantity::name) -
                                           known.begin()));
  return out;
}

/// Points of a table: the estimates, then each step up and down.
std::size_t points_of(const scenario::OneAtATime& study) { return 1 + 2 * study.steps.size(); }

/// Outputs at points [first, last): out[point * outputs + output].
void moved_outputs(const propagation::Experiment& e, const scenario::OneAtATime& study, std::size_t first,
                   std::size_t last, double* out) {
  const auto& plan = e.plan();
  const std::vector<std::size_t> quantities = quantities_of(e, study);
  const std::size_t n = (last - first + 7) / 8 * 8, outputs = e.outputs().size();
  std::vector<std::vector<double>> columns(plan.columns.size());
  for (std::size_t i = first; i < last; ++i) {
    if (i == 0) continue;
    const std::size_t k = (i - 1) / 2;
    for (const auto& of_reading : plan.gather) {
      const std::size_t c = of_reading[quantities[k]];
      const double estimate = e.column_estimates()[c];
      if (columns[c].empty()) columns[c].assign(n, estimate);
      columns[c][i - first] = i % 2 == 1 ? estimate + study.steps[k].step : estimate - study.steps[k].step;
    }
  }
  std::vector<const double*> pointers;
  for (const auto& column : columns) pointers.push_back(column.empty() ? nullptr : column.data());
  propagation::Workspace w;
  std::vector<double> y(outputs * n);
  std::vector<std::uint8_t> status(n);
  e.run_columns(pointers, n, w, y.data(), status.data());
  for (std::size_t i = 0; i < last - first; ++i)
    for (std::size_t o = 0; o < outputs; ++o) out[i * outputs + o] = y[o * n + i];
}

} // namespace

std::vector<propagation::Work> one_at_a_time_work(const propagation::Experiment& e) {
  std::vector<propagation::Work> all;
  for (const auto& study : e.scenario().analysis.one_at_a_time)
    all.push_back({.name = "one at a time " + std::to_string(all.size()),
                   .units = points_of(study),
                   .values = e.outputs().size(),
                   .together = points_of(study),
                   .compute = [&](std::uint64_t first, std::uint64_t last, double* out) {
                     moved_outputs(e, study, first, last, out);
                   }});
  return all;
}

std::vector<OneAtATimeTable> one_at_a_time(const propagation::Experiment& e, const propagation::Workers& workers) {
  const auto& studies = e.scenario().analysis.one_at_a_time;
  const std::vector<propagation::Work> work = one_at_a_time_work(e);
  std::vector<OneAtATimeTable> tables;
  for (std::size_t t = 0; t < studies.size(); ++t) {
    const auto& study = studies[t];
    OneAtATimeTable table;
    table.title = study.title;
    table.outputs = e.outputs();
    const std::vector<std::size_t> quantities = quantities_of(e, study);
    const std::vector<double> all = workers.values(work[t]);
    const auto y = [&](std::size_t point, std::size_t o) { return all[point * table.outputs.size() + o]; };
    for (std::size_t k = 0; k < study.steps.size(); ++k) {
      const auto& q = e.scenario().quantities.at(quantities[k]);
      OneAtATimeRow row{q.name, q.unit, q.si_unit, study.steps[k].step, {}, {}};
      for (std::size_t o = 0; o < table.outputs.size(); ++o) {
        row.up.push_back(y(1 + 2 * k, o) - y(0, o));
        row.down.push_back(y(2 + 2 * k, o) - y(0, o));
      }
      table.rows.push_back(row);
    }
    tables.push_back(table);
  }
  return tables;
}

} // namespace gumshoe::analysis
