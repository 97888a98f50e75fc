#include "models/made_card.h"

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
  card_ = {keep(texts.name), keep(texts.title), keep(texts.summary), keep(texts.source), quantities_,
           conditions_,      indications_,      measurands_,         evaluations_,       {}, {}, axes_};
}

} // namespace gumshoe::models
