#pragma once
/// A model that a scenario states as formulas.
///
/// Measurands are formulas of quantities, conditions, indications and intermediates; formulas of indications say what
/// the readouts would be, for virtual experiments and fits. All values are SI.
#include <memory>

#include "models/expression/program.h"
#include "models/made_card.h"
#include "models/model.h"

namespace gumshoe::models::expression {

struct Stated {
  Formula formula;
  std::string unit;  ///< of a measurand, as stated; empty: derived
  Location unit_place;
};

struct Statement {
  std::vector<Symbol> quantities, conditions, indications;
  std::vector<Stated> intermediates, measurands;
  std::vector<Stated> simulated; ///< formulas of indications, by their names
  bool virtual_experiment = false;
};

/// What Model::context points to.
struct Expression {
  Statement statement;
  std::vector<Formula> formulas; ///< intermediates, measurands, simulated: what an Origin counts
  Program evaluate; ///< outputs: measurands
  Program simulate; ///< outputs: indications, then true measurands; empty if not every indication has a formula
  Program explain;  ///< outputs: intermediates, measurands
  std::vector<Symbol> explained;
  std::unique_ptr<MadeCard> card;
  Model model{};
};

/// Throws InputError with every problem, each at its character. Notes are decisions a reader should see.
MadeModel make(Statement statement, std::vector<std::string>& notes);

} // namespace gumshoe::models::expression
