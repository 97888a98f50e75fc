#pragma once
/// Cards of models that are made at run time: as ModelCard, but they own their texts.
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "base/symbol.h"
#include "chain/machine.h"

namespace gumshoe::models {

struct CardTexts {
  std::string name, title, summary, source;
  std::vector<Symbol> quantities, conditions, indications, measurands;
  std::vector<std::pair<std::string, std::string>> equations = {}; ///< as EquationCard; empty: of an unknown function
  std::vector<AxisCard> axes = {};                                 ///< copied with their names
};

class MadeCard {
public:
  explicit MadeCard(const CardTexts& texts);
  MadeCard(const MadeCard&) = delete;
  MadeCard& operator=(const MadeCard&) = delete;
  const ModelCard& card() const { return card_; }

private:
  std::string_view keep(const std::string& text) { return texts_.emplace_back(text); }
  std::vector<VariableCard> variables(const std::vector<Symbol>& symbols);
  std::deque<std::string> texts_;
  std::vector<QuantityCard> quantities_;
  std::vector<VariableCard> conditions_, indications_, measurands_;
  std::vector<EquationCard> equations_;
  std::vector<AxisCard> axes_;
  std::vector<EvaluationCard> evaluations_;
  ModelCard card_{};
};

/// Another name, meaning or default of a quantity, condition, measurand of a joint evaluation or axis of a card.
struct Renamed {
  std::string from, name, meaning = {}; ///< an empty meaning stays
  double default_value = 0;             ///< of a quantity
};

/// A copy of a model's card for another machine: some rows renamed, other axes, all else as it is.
class RenamedCard {
public:
  RenamedCard(const ModelCard& card, const std::vector<Renamed>& renamed, std::vector<AxisCard> axes);
  RenamedCard(const RenamedCard&) = delete;
  RenamedCard& operator=(const RenamedCard&) = delete;
  const ModelCard& card() const { return card_; }

private:
  std::string_view keep(const std::string& text) { return texts_.emplace_back(text); }
  std::deque<std::string> texts_;
  std::vector<QuantityCard> quantities_;
  std::vector<VariableCard> conditions_;
  std::deque<std::vector<VariableCard>> measurands_; ///< of each evaluation
  std::vector<EvaluationCard> evaluations_;
  std::vector<AxisCard> axes_;
  ModelCard card_;
};

/// The axes of a machine as a card lists them; their names are the machine's.
std::vector<AxisCard> cards_of_axes(const chain::Machine& machine);

} // namespace gumshoe::models
