#pragma once
/// What a scenario states as formulas: the columns that they may name, and the formulas themselves. All values are SI.
#include "base/symbol.h"
#include "formula/formula.h"

namespace gumshoe::formula {

struct Stated {
  Formula formula;
  std::string unit; ///< of a measurand, as stated; empty: derived
  Location unit_place;
};

struct Statement {
  std::vector<Symbol> quantities, conditions, indications;
  std::vector<Stated> intermediates, measurands;
  std::vector<Stated> simulated; ///< formulas of indications, by their names
};

} // namespace gumshoe::formula
