#include "analysis/scale_points.h"

#include <cmath>

#include <fmt/format.h>

#include "analysis/differences.h"
#include "base/units.h"

namespace gumshoe::analysis {
namespace {

bool has_own_zero(const std::string& unit, const std::string& si_unit) { return units::to_si(0, unit, si_unit) != 0; }
bool of_own_zero(const quantities::InputQuantity& q) { return has_own_zero(q.unit, q.si_unit); }

} // namespace

std::vector<std::string> scale_point_notes(const propagation::Experiment& e, const propagation::Workers& workers) {
  std::vector<std::string> notes;
  const auto& quantities = e.scenario().quantities;
  // What is read of an indication is a point; to a prediction, which simulates it, its noise is a difference.
  const bool predicted = e.scenario().method == scenario::Method::prediction;
  const auto is_point = [&](std::size_t q) {
    return of_own_zero(quantities[q]) && !(predicted && e.layout().indications.contains(q));
  };
  std::size_t points = 0;
  for (std::size_t q = 0; q < quantities.size(); ++q) points += is_point(q);
  const std::size_t measurands = e.measurands().size();
  std::vector<Derivatives> all;
  for (std::size_t m = 0; m < measurands && m < e.outputs().size(); ++m) {
    const auto& output = e.outputs()[m];
    // A result in K is noted only where two or more such inputs are added, one of another kind where it is
    // proportional.
    const bool as_point = has_own_zero(output.unit, output.si_unit), other = output.si_unit != "K";
    if (!as_point && points < (other ? 1 : 2)) continue;
    if (other && stencils_at_estimates(e)) continue; // runs of the model for one note
    const auto point = e.point(output.reading);
    if (all.empty())
      all = stencils_at_estimates(e)
                ? differences_from(stencil_values(e, output.reading, workers), e, output.reading, false)
                : differentiate(e, output.reading, point, false);
    const Derivatives& d = all[m];
    const auto& columns = e.columns_at(output.reading);
    double weight = 0, from_zero = 0;
    std::size_t any = 0, last = 0;
    for (std::size_t q = 0; q < point.size(); ++q) {
      if (d.first[q] == 0 || !is_point(e.plan().columns[columns[q]].quantity)) continue;
      weight += d.first[q];
      from_zero += d.first[q] * point[q];
      last = e.plan().columns[columns[q]].quantity;
      ++any;
    }
    if (any == 0 || std::isnan(weight)) continue;
    if (other && any == 1 && std::fabs(from_zero - d.value) <= 1e-9 * std::fabs(d.value))
      notes.push_back(fmt::format("{}: proportional to {}, counted from 0 K; state a difference of temperatures in K",
                                  output.measurand, quantities[last].name));
    if (other || std::fabs(weight - 1) < 1e-6) continue;
    if (as_point)
      notes.push_back(
          fmt::format("{}: its inputs in {} enter with weights that add up to {:.4g}, not to 1, so that it is no "
                      "point on this scale; state a difference of temperatures in K",
                      output.measurand, output.unit, weight));
    else if (weight > 1 && std::fabs(weight - std::round(weight)) < 1e-6)
      notes.push_back(
          fmt::format("{}: {:.0f} inputs with a zero of their own, such as degC, are added, each from 0 K on; "
                      "state a correction or a difference of temperatures in K",
                      output.measurand, weight));
  }
  return notes;
}

} // namespace gumshoe::analysis
