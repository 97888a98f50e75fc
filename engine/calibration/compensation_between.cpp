#include "calibration/compensation_between.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "models/model.h"
#include "scenario/conditions.h"

namespace gumshoe::calibration {
namespace {

using Curve = std::map<double, CompensationRow>; ///< by position, of one direction

std::map<int, Curve> by_direction(const std::vector<CompensationRow>& rows) {
  std::map<int, Curve> out;
  for (const auto& row : rows) out[row.direction][row.position] = row;
  return out;
}

std::size_t place_of(const scenario::Scenario& s, const ModelCard& card, const std::string& condition) {
  const auto at = std::ranges::find(card.conditions, condition, [](const auto& c) { return std::string(c.name); });
  if (at == card.conditions.end()) throw InputError(s.file + ": '" + condition + "' is not a condition", "", "");
  return static_cast<std::size_t>(at - card.conditions.begin());
}

/// The scenario with readings at `positions` alone, each between its neighbours of the same direction.
scenario::Scenario with_readings_at(const scenario::Scenario& s, const ModelCard& card, const Compensation& table,
                                    const std::vector<double>& positions) {
  const std::size_t position = place_of(s, card, table.position);
  std::map<int, std::map<double, std::size_t>> known;
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    const double way = table.direction.empty() ? 0 : s.readings[r].conditions[place_of(s, card, table.direction)];
    known[(way > 0) - (way < 0)].emplace(s.readings[r].conditions[position], r);
  }
  scenario::Scenario out = s;
  out.readings.clear();
  for (auto& column : out.trace.columns) column.values.clear();
  for (const auto& [direction, at] : known)
    for (const double x : positions) {
      const auto next = at.lower_bound(x);
      if (next == at.end() || (next == at.begin() && next->first != x)) continue;
      const auto& [x0, low] = next == at.begin() ? *next : *std::prev(next);
      const auto& [x1, high] = *next;
      const double share = x1 > x0 ? (x - x0) / (x1 - x0) : 0;
      const auto between = [&](double a, double b) { return a == b ? a : a + share * (b - a); };
      quantities::Reading reading{s.readings[low].labels, {}, {}};
      for (std::size_t c = 0; c < card.conditions.size(); ++c)
        if (const double here = s.readings[low].conditions[c]; c != position && card.conditions[c].si_unit == "1")
          reading.conditions.push_back(here); // a direction or a number of something has no values in between
        else
          reading.conditions.push_back(c == position ? x : between(here, s.readings[high].conditions[c]));
      out.readings.push_back(std::move(reading));
      for (std::size_t c = 0; c < out.trace.columns.size(); ++c)
        if (const auto& values = s.trace.columns[c].values; !values.empty())
          out.trace.columns[c].values.push_back(between(values[low], values[high]));
    }
  scenario::update_loadings(out);
  return out;
}

/// Whether every stated effect has a loading at every reading.
bool has_loadings(const scenario::Scenario& s) {
  return std::ranges::all_of(s.stated_effects, [](const auto& effect) {
    return std::ranges::all_of(effect.parts, [](const auto& part) {
      return std::ranges::all_of(part.loading, [](double x) { return std::isfinite(x); });
    });
  });
}

} // namespace

std::vector<CompensationRow> errors_at(const propagation::Experiment& experiment, const CompensationRequest& request,
                                       const Compensation& table, const std::vector<double>& positions) {
  constexpr std::size_t at_once = 256; // what a scenario costs grows faster than its readings
  const CompensationRequest held{.indication = table.indication,
                                 .position = table.position,
                                 .direction = table.direction,
                                 .with = request.with,
                                 .without = {},
                                 .only = table.holds};
  std::vector<CompensationRow> out;
  for (std::size_t i = 0; i < positions.size(); i += at_once) {
    const auto from = positions.begin() + static_cast<std::ptrdiff_t>(i);
    const auto to = positions.begin() + static_cast<std::ptrdiff_t>(std::min(positions.size(), i + at_once));
    const scenario::Scenario between =
        with_readings_at(experiment.scenario(), *experiment.model().card, table, {from, to});
    if (between.readings.empty()) continue;
    if (!has_loadings(between)) return {};
    try {
      const propagation::Experiment there(between);
      for (CompensationRow row : compensation(there, held).rows) {
        if (table.direction.empty()) row.direction = 0;
        out.push_back(row);
      }
    } catch (const InputError&) {
      return {};
    }
  }
  return out;
}

StraightLines straight_lines(const propagation::Experiment& experiment, const CompensationRequest& request,
                             const Compensation& table, const std::vector<double>& positions) {
  constexpr std::size_t most = 200;
  constexpr int places = 8;
  const std::size_t stride = (positions.size() + most - 1) / most;
  std::vector<double> within, at;
  for (std::size_t i = 0; i + 1 < positions.size(); i += stride) {
    at.insert(at.end(), {positions[i], positions[i + 1]});
    for (int k = 0; k < places; ++k)
      within.push_back(positions[i] + (k + 0.5) / places * (positions[i + 1] - positions[i]));
  }
  const auto ends = by_direction(errors_at(experiment, request, table, at));
  double missed = 0, varied = 0, uncertain = 0, n = 0;
  for (const auto& [direction, curve] : by_direction(errors_at(experiment, request, table, within))) {
    if (!ends.contains(direction)) continue;
    const Curve& known = ends.at(direction);
    double mean = 0;
    for (const auto& [x, row] : curve) mean += row.error / static_cast<double>(curve.size());
    for (const auto& [x, row] : curve) {
      const auto next = known.lower_bound(x);
      if (next == known.end() || next == known.begin()) continue;
      const auto& [x0, low] = *std::prev(next);
      const auto& [x1, high] = *next;
      const double line = low.error + (x - x0) / (x1 - x0) * (high.error - low.error);
      missed += (row.error - line) * (row.error - line);
      varied += (row.error - mean) * (row.error - mean);
      uncertain += row.u_of_sizes * row.u_of_sizes;
      n += 1;
    }
  }
  if (n == 0) return {};
  return {std::sqrt(varied / n), std::sqrt(missed / n), missed > 0.25 * varied && missed > 9 * uncertain};
}

double sufficient_step(const propagation::Experiment& experiment, const CompensationRequest& request,
                       const Compensation& table) {
  const double first = table.rows.front().position, travel = table.rows.back().position - first;
  std::size_t intervals = 0;
  for (std::size_t i = 1; i < table.rows.size(); ++i)
    intervals += table.rows[i].position > table.rows[i - 1].position ? 1 : 0;
  for (const std::size_t parts : {2, 4, 8, 16, 32, 64}) {
    const std::size_t all = parts * intervals;
    std::vector<double> positions;
    for (std::size_t i = 0; i <= all; ++i)
      positions.push_back(first + travel * static_cast<double>(i) / static_cast<double>(all));
    const StraightLines lines = straight_lines(experiment, request, table, positions);
    if (lines.errors > 0 && lines.missed <= 0.1 * lines.errors) return travel / static_cast<double>(all);
  }
  return 0;
}

} // namespace gumshoe::calibration
