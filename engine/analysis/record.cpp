#include "analysis/record.h"

#include <cmath>
#include <set>

#include "analysis/gum.h"
#include "quantities/distribution.h"

namespace gumshoe::analysis {

std::vector<Equation> equations_of(const ModelCard& card, const std::string& evaluation) {
  std::vector<Equation> out;
  for (const EvaluationCard& e : card.evaluations)
    if (e.name == evaluation)
      for (const EquationCard& equation : e.equations)
        out.push_back({std::string(equation.text), std::string(equation.where)});
  return out;
}

std::vector<AxisRecord> axis_records(const ModelCard& card) {
  std::vector<AxisRecord> out;
  for (const AxisCard& axis : card.axes)
    out.push_back({std::string(axis.name), axis.carries_workpiece ? "workpiece" : "tool",
                   axis.rotary ? "rotary" : "linear", std::string(1, "XYZ"[axis.direction]), axis.point});
  return out;
}

std::vector<InputRecord> input_records(const scenario::Scenario& s) {
  std::vector<InputRecord> out;
  for (const auto& q : s.quantities)
    for (const auto& entry : q.entries) {
      InputRecord record;
      record.name = q.name;
      record.unit = q.unit;
      record.si_unit = q.si_unit;
      record.value = entry.value;
      record.source = entry.source;
      for (const auto& [label, value] : entry.labels)
        record.labels += (record.labels.empty() ? "" : ", ") + label + " " + value;
      double variance = 0;
      std::set<std::string> scopes;
      for (const auto& c : entry.components) {
        variance += std::pow(c.distribution.standard_uncertainty(), 2);
        record.value += c.distribution.mean();
        for (const auto& f : quantities::families())
          if (f.family == c.distribution.family)
            record.distribution += (record.distribution.empty() ? "" : " + ") + std::string(f.name);
        if (record.evaluation.find(c.evaluation) == std::string::npos) record.evaluation += c.evaluation;
        if (const std::string scope = scope_text(c); scopes.insert(scope).second)
          record.scope += (scopes.size() == 1 ? "" : " + ") + scope;
        if (!c.source.empty() && c.source != entry.source) record.source += (record.source.empty() ? "" : "; ") + c.source;
      }
      record.standard_uncertainty = std::sqrt(variance);
      out.push_back(record);
    }
  return out;
}

} // namespace gumshoe::analysis
