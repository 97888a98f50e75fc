#include "analysis/comparison.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "analysis/summary.h"
#include "analysis/tails.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

std::string label_value(const quantities::Labels& labels, const std::string& label) {
  for (const auto& [name, value] : labels)
    if (name == label) return value;
  return {};
}

bool matches(const quantities::Labels& labels, const quantities::Labels& wanted) {
  return std::ranges::all_of(wanted, [&](const auto& w) { return label_value(labels, w.first) == w.second; });
}

/// a - b, sample by sample.
Column difference_of(const Column& a, const Column& b) {
  return {a.size(),
          [&](std::size_t first, std::span<double> out) {
            Room room;
            a.copy(first, out);
            const auto subtracted = b.read(first, out.size(), room);
            for (std::size_t k = 0; k < out.size(); ++k) out[k] -= subtracted[k];
          },
          a.phase()};
}

/// Names all comparisons by their outputs where the values of one label do not distinguish them.
void tell_apart(std::span<ComparisonResult> results) {
  std::set<std::string> names;
  for (const ComparisonResult& r : results) names.insert(r.name);
  if (names.size() == results.size()) return;
  for (ComparisonResult& r : results) r.name = r.a + " - " + r.b;
}

} // namespace

std::vector<ComparisonResult> compare(const propagation::Experiment& e, const ValuesOf& values,
                                      const std::vector<Summary>& summaries, const std::vector<Budget>& budgets,
                                      int threads) {
  std::vector<ComparisonResult> results;
  for (const auto& c : e.scenario().analysis.comparisons) {
    const std::size_t before = results.size();
    for (std::size_t i = 0; i < e.outputs().size(); ++i)
      for (std::size_t j = i + 1; j < e.outputs().size(); ++j) {
        const auto &a = e.outputs()[i], &b = e.outputs()[j];
        const auto &la = a.labels, &lb = b.labels;
        if (a.measurand != c.measurand || b.measurand != c.measurand) continue;
        if (label_value(la, c.between) == label_value(lb, c.between)) continue;
        if (!c.within.empty() && label_value(la, c.within) != label_value(lb, c.within)) continue;
        Room rooms[2];
        const Column first = held(values(i), rooms[0], 2), second = held(values(j), rooms[1], 2);
        const Column difference = difference_of(first, second);
        KeptOrder order;
        Summary s = summarise(a, difference, e.scenario().analysis.coverage_probability, threads, &order);
        join_rounded(s);
        withhold(s, without_variance(e, budgets[i], &budgets[j]), difference, threads, order);
        ComparisonResult r;
        r.a = a.name;
        r.b = b.name;
        r.name = c.measurand + ": " + label_value(la, c.between) + " - " + label_value(lb, c.between);
        if (!c.within.empty()) r.name += ", " + c.within + " " + label_value(la, c.within);
        r.unit = a.unit;
        r.si_unit = a.si_unit;
        r.difference = s.estimate;
        r.standard_uncertainty = s.standard_uncertainty;
        r.root_sum_square = std::hypot(summaries[i].standard_uncertainty, summaries[j].standard_uncertainty);
        r.expanded_uncertainty = std::isfinite(s.standard_uncertainty) ? s.monte_carlo_expanded : nan;
        r.normalised_error = r.difference / r.expanded_uncertainty;
        results.push_back(r);
      }
    tell_apart(std::span(results).subspan(before));
  }
  return results;
}

std::vector<PrintedResult> beside_printed(const propagation::Experiment& e, const std::vector<Summary>& summaries) {
  std::vector<PrintedResult> results;
  for (const auto& printed : e.scenario().analysis.printed)
    for (std::size_t o = 0; o < e.outputs().size(); ++o) {
      const auto& output = e.outputs()[o];
      if (output.measurand != printed.measurand || !matches(output.labels, printed.labels)) continue;
      results.push_back({output.name, printed.source, output.unit, output.si_unit, printed.value, summaries[o].estimate,
                         summaries[o].expanded_uncertainty});
    }
  return results;
}

std::vector<PredictedReading> predicted_readings(const propagation::Experiment& e,
                                                 const std::vector<Summary>& summaries) {
  std::vector<PredictedReading> results;
  if (e.scenario().method != scenario::Method::prediction) return results;
  for (std::size_t o = 0; o < e.outputs().size(); ++o) {
    const auto& read = e.scenario().readings[e.outputs()[o].reading].indications;
    const Summary& s = summaries[o];
    if (read.empty() || std::isnan(s.shortest.low)) continue;
    const double x = read[o % e.measurands().size()];
    results.push_back({s.output.name, s.output.unit, s.output.si_unit, x, s.estimate, s.shortest.low, s.shortest.high,
                       s.shortest.low <= x && x <= s.shortest.high});
  }
  return results;
}

} // namespace gumshoe::analysis
