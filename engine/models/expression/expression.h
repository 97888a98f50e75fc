#pragma once
/// A model that a scenario states as formulas.
///
/// Measurands are formulas of quantities, conditions, indications and intermediates; formulas of indications give the
/// simulated readings, for virtual experiments and fits. All values are SI.
#include <memory>

#include "formula/compile.h"
#include "models/kept.h"
#include "models/made_card.h"
#include "models/model.h"

namespace gumshoe::models::expression {

/// Data of a model, to which Model::context points.
struct Expression {
  formula::Compiled formulas;
  bool virtual_experiment = false; ///< there are no readings at the estimates: `check` does not evaluate there
  std::unique_ptr<MadeCard> card;
  Model model{};
};

/// Makes a model of a statement. Throws InputError with every problem, each at its character. `notes` receives what a
/// reader of the scenario should know.
MadeModel make(formula::Statement statement, std::vector<std::string>& notes, bool virtual_experiment = false);

/// Null for a model of another kind.
const KeepingKernels* keeping_kernels(const Model& model);

} // namespace gumshoe::models::expression
