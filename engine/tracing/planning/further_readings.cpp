#include "tracing/planning/further_readings.h"

#include <algorithm>

#include "models/model.h"
#include "quantities/cells.h"

namespace gumshoe::tracing {
namespace {

using quantities::Entry;
using quantities::InputQuantity;
using quantities::Labels;
using scenario::AllowedReading;
using scenario::Scenario;

const ModelCard& card_of(const Scenario& s) { return s.made ? *s.made->card : *models::find(s.model)->card; }

/// A new value of a label is declared as the first reading's value is.
void declare(InputQuantity& q, const Labels& labels, const Labels& known) {
  const auto holds = [&](const Labels& of) {
    return [&](const Entry& entry) { return quantities::holds_for(entry.labels, of); };
  };
  if (std::ranges::any_of(q.entries, holds(labels))) return;
  const auto pattern = std::ranges::find_if(q.entries, holds(known));
  if (pattern == q.entries.end()) return;
  Entry fresh = *pattern;
  for (auto& [label, value] : fresh.labels) value = *quantities::label_value(labels, label);
  q.entries.push_back(std::move(fresh));
}

/// The labels with the first reading's value in place of every new one.
Labels known_labels(const Scenario& s, const AllowedReading& reading) {
  Labels out = reading.labels;
  for (const auto& [label, fresh] : new_values(s, reading))
    for (auto& [name, value] : out)
      if (const std::string* first = quantities::label_value(s.readings.front().labels, label); name == label && first)
        value = *first;
  return out;
}

} // namespace

bool has_readings(const Scenario& s) {
  return std::ranges::all_of(s.readings, [](const auto& r) { return !r.indications.empty(); });
}

std::vector<std::pair<std::string, std::string>> new_values(const Scenario& s, const AllowedReading& reading) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto& conditions = card_of(s).conditions;
  const bool some = has_readings(s);
  for (const auto& [label, value] : reading.labels) {
    if (std::ranges::find(conditions, label, &VariableCard::name) != conditions.end()) continue;
    const bool known = some && std::ranges::any_of(s.readings, [&](const auto& r) {
                         const std::string* has = quantities::label_value(r.labels, label);
                         return has && *has == value;
                       });
    if (!known) out.emplace_back(label, value);
  }
  return out;
}

Scenario with_readings(const Scenario& s, const std::vector<int>& count) {
  Scenario out = s;
  const std::size_t indications = card_of(s).indications.size();
  if (!has_readings(s)) {
    out.readings.clear();
    out.trace.order.clear();
    for (auto& column : out.trace.columns) column.values.clear();
    for (auto& effect : out.stated_effects)
      for (auto& part : effect.parts) part.loading.clear();
  }
  out.spreads.clear();
  double last = out.trace.order.empty() ? 0 : *std::ranges::max_element(out.trace.order);
  for (std::size_t i = 0; i < count.size(); ++i) {
    const AllowedReading& allowed = s.plan->readings[i];
    if (count[i] == 0) continue;
    const Labels known = known_labels(s, allowed);
    for (InputQuantity& q : out.quantities) declare(q, allowed.labels, known);
    for (int n = 0; n < count[i]; ++n) {
      out.readings.push_back({allowed.labels, allowed.conditions, std::vector<double>(indications, 0.0)});
      if (!out.trace.order.empty()) out.trace.order.push_back(++last);
      for (std::size_t c = 0; c < out.trace.columns.size(); ++c)
        out.trace.columns[c].values.push_back(allowed.columns[c]);
      for (auto& effect : out.stated_effects)
        for (auto& part : effect.parts)
          part.loading.push_back(part.loading_at        ? part.loading_at(allowed.conditions, allowed.columns)
                                 : part.loading.empty() ? 0
                                                        : part.loading.front());
    }
  }
  return out;
}

} // namespace gumshoe::tracing
