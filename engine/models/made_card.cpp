#include "models/made_card.h"

#include <algorithm>

namespace gumshoe::models {

std::vector<VariableCard> MadeCard::variables(const std::vector<Symbol>& symbols) {
  std::vector<VariableCard> cards;
  for (const Symbol& s : symbols)
    cards.push_back({keep(s.name), keep(s.unit), keep(s.si_unit), s.default_value, keep(s.meaning)});
  return cards;
}

namespace {

/// y = f(x) for each measurand, and what f and x are.
std::vector<std::pair<std::string, std::string>> unknown_function(const CardTexts& texts) {
  std::string inputs;
  for (const auto* symbols : {&texts.indications, &texts.quantities, &texts.conditions})
    for (const Symbol& s : *symbols) inputs += (inputs.empty() ? "" : ", ") + s.name;
  std::vector<std::pair<std::string, std::string>> equations;
  for (const Symbol& y : texts.measurands)
    equations.emplace_back(y.name + " = f(x)", equations.empty() ? "f: the " + texts.name + "; x: " + inputs : "");
  return equations;
}

} // namespace

MadeCard::MadeCard(const CardTexts& texts) {
  for (const Symbol& s : texts.quantities)
    quantities_.push_back(
        {keep(s.name), keep(s.unit), keep(s.si_unit), s.default_value, s.limits, "", keep(s.meaning)});
  conditions_ = variables(texts.conditions);
  indications_ = variables(texts.indications);
  measurands_ = variables(texts.measurands);
  for (const auto& [text, where] : texts.equations.empty() ? unknown_function(texts) : texts.equations)
    equations_.push_back({keep(text), keep(where)});
  evaluations_ = {{.name = "full", .meaning = "as the scenario states it", .equations = equations_}};
  for (AxisCard axis : texts.axes) {
    axis.name = keep(std::string(axis.name));
    axes_.push_back(axis);
  }
  card_ = {keep(texts.name),
           keep(texts.title),
           keep(texts.summary),
           keep(texts.source),
           quantities_,
           conditions_,
           indications_,
           measurands_,
           evaluations_,
           {},
           {},
           axes_};
}

RenamedCard::RenamedCard(const ModelCard& card, const std::vector<Renamed>& renamed, std::vector<AxisCard> axes)
    : quantities_(card.quantities.begin(), card.quantities.end()),
      conditions_(card.conditions.begin(), card.conditions.end()),
      evaluations_(card.evaluations.begin(), card.evaluations.end()), axes_(std::move(axes)), card_(card) {
  for (const EvaluationCard& e : card.evaluations) measurands_.emplace_back(e.measurands.begin(), e.measurands.end());
  const auto rename = [&](const auto& from, auto& rows, const Renamed& to, const auto& further) {
    const auto at = std::ranges::find(from, to.from, &std::ranges::range_value_t<decltype(from)>::name) - from.begin();
    if (at == std::ssize(from)) return;
    auto& row = rows[static_cast<std::size_t>(at)];
    row.name = keep(to.name);
    if (!to.meaning.empty()) row.meaning = keep(to.meaning);
    further(row);
  };
  for (const Renamed& to : renamed) {
    rename(card.quantities, quantities_, to, [&](QuantityCard& q) { q.default_value = to.default_value; });
    rename(card.conditions, conditions_, to, [](VariableCard&) {});
    for (std::size_t e = 0; e < evaluations_.size(); ++e)
      rename(card.evaluations[e].measurands, measurands_[e], to, [](VariableCard&) {});
  }
  for (std::size_t e = 0; e < evaluations_.size(); ++e) evaluations_[e].measurands = measurands_[e];
  for (AxisCard& axis : axes_) axis.name = keep(std::string(axis.name));
  card_.quantities = quantities_, card_.conditions = conditions_, card_.evaluations = evaluations_, card_.axes = axes_;
}

std::vector<AxisCard> cards_of_axes(const chain::Machine& machine) {
  std::vector<AxisCard> cards;
  for (const chain::Axis& a : machine.axes())
    cards.push_back(
        {a.name, cards.size() < machine.on_workpiece_side(), a.rotary, a.direction, {a.point.x, a.point.y, a.point.z}});
  return cards;
}

} // namespace gumshoe::models
