#include "models/made_card.h"

namespace gumshoe::models {

std::vector<VariableCard> MadeCard::variables(const std::vector<Symbol>& symbols) {
  std::vector<VariableCard> cards;
  for (const Symbol& s : symbols)
    cards.push_back({keep(s.name), keep(s.unit), keep(s.si_unit), s.default_value, keep(s.meaning)});
  return cards;
}

MadeCard::MadeCard(const CardTexts& texts) {
  for (const Symbol& s : texts.quantities)
    quantities_.push_back(
        {keep(s.name), keep(s.unit), keep(s.si_unit), s.default_value, s.limits, "", keep(s.meaning)});
  conditions_ = variables(texts.conditions);
  indications_ = variables(texts.indications);
  measurands_ = variables(texts.measurands);
  evaluations_ = {{"full", "as the scenario states it"}};
  card_ = {keep(texts.name), keep(texts.title), keep(texts.summary), keep(texts.source), quantities_,
           conditions_,      indications_,      measurands_,         evaluations_,       {}};
}

} // namespace gumshoe::models
