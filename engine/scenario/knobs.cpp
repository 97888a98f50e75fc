#include "scenario/knobs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/conditions.h"
#include "scenario/quantity.h"

namespace gumshoe::scenario {

namespace {
using Kind = Knob::Kind;
} // namespace

KnobReader::KnobReader(const ChooseScope& scope, Problems& problems) : scope_(scope), problems_(problems) {
  for (const EvaluationCard& e : scope.model.evaluations) evaluations_.emplace_back(e.name);
}

std::optional<double> KnobReader::value(const Node& node, const std::string& path, const Knob& knob) {
  if (knob.kind == Kind::evaluation) {
    const auto word = read_text(node, path, problems_);
    if (!word) return std::nullopt;
    const auto it = std::ranges::find(evaluations_, *word);
    if (it != evaluations_.end()) return static_cast<double>(it - evaluations_.begin());
    problems_.add(node, fmt::format("{}: {} has no evaluation '{}'", path, scope_.model.name, *word), "",
                  did_you_mean(*word, evaluations_));
    return std::nullopt;
  }
  if (knob.kind == Kind::readings) {
    const auto n = read_number(node, path, problems_);
    if (!n || (*n == std::floor(*n) && *n >= 1 && *n <= most_readings)) return n;
    problems_.add(node, fmt::format("{}: {} is not a valid number of readings", path, *n), "",
                  "use a whole number of at least 1");
    return std::nullopt;
  }
  const auto x = read_measure(node, path, {knob.si_unit}, problems_);
  const QuantityCard* card = knob.kind == Kind::quantity ? card_of(knob) : nullptr;
  if (x && card && !check_limits(*x, *card, node, path, problems_)) return std::nullopt;
  return x;
}

const QuantityCard* KnobReader::card_of(const Knob& knob) const {
  if (knob.index < scope_.model.quantities.size()) return &scope_.model.quantities[knob.index];
  for (const EffectCard* e : scope_.catalogue.effects)
    for (const QuantityCard& q : e->quantities)
      if (knob.name == std::string(e->name) + '.' + std::string(q.name)) return &q;
  return nullptr;
}

std::optional<Knob> KnobReader::find(const Member& m, const std::string& path, bool quantities_only) {
  const Scenario& s = scope_.scenario;
  const auto refuse = [&](const std::string& what, const std::string& why) {
    problems_.add(m, fmt::format("{}.{}: {}", path, m.key, what), why);
    return std::nullopt;
  };
  std::vector<std::string> names;
  if (!quantities_only) {
    if (m.key == "evaluation") return Knob{Kind::evaluation, m.key};
    if (m.key == "readings") {
      if (s.spreads.empty() && s.readings.size() > 1)
        return refuse("the readings are listed", "only the number of equal or evenly spread readings can vary");
      return Knob{Kind::readings, m.key};
    }
    names = {"evaluation", "readings"};
    for (std::size_t c = 0; c < scope_.model.conditions.size(); ++c) {
      const VariableCard& card = scope_.model.conditions[c];
      names.emplace_back(card.name);
      if (card.name != m.key) continue;
      for (const auto& r : s.readings)
        if (r.conditions[c] != s.readings.front().conditions[c])
          return refuse("it differs between the readings", "one value for all readings is needed");
      if (std::ranges::find(s.spreads, c, &Spread::condition) != s.spreads.end())
        return refuse("it is spread over the readings", "one value for all readings is needed");
      return Knob{Kind::condition, m.key, c, std::string(card.unit), std::string(card.si_unit)};
    }
  }
  const std::size_t own = s.quantities.size() - std::min(s.quantities.size(), scope_.model.indications.size());
  for (std::size_t i = 0; i < own; ++i) { // the rest is noise
    const quantities::InputQuantity& q = s.quantities[i];
    names.push_back(q.name);
    if (q.name != m.key) continue;
    if (q.entries.size() > 1)
      return refuse("its value differs between the readings", "one value for all readings is needed");
    return Knob{Kind::quantity, m.key, i, q.unit, q.si_unit};
  }
  problems_.add(m,
                fmt::format("{}: '{}' is not a {}", path, m.key,
                            quantities_only ? "quantity" : "condition or quantity of this scenario"),
                "", did_you_mean(m.key, names));
  return std::nullopt;
}

} // namespace gumshoe::scenario
