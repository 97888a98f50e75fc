#pragma once
/// A statement made ready to compute: formulas parsed and resolved, dimensions checked, units settled, programs built.
#include "formula/program.h"
#include "formula/statement.h"

namespace gumshoe::formula {

struct Compiled {
  Statement statement;           ///< indications without a unit have received that of their formula
  std::vector<Formula> formulas; ///< parsed: intermediates, measurands, simulated. An Origin counts these.
  std::vector<Symbol> explained; ///< name and unit of every intermediate and measurand, in the order of `formulas`
  Program evaluate;              ///< outputs: measurands
  Program simulate; ///< outputs: indications, then true measurands. Empty unless every indication has a formula.
  Program explain;  ///< outputs: intermediates, measurands

  bool simulates() const { return !simulate.outputs.empty(); }
  /// Indices into `formulas`: measurands are [first_measurand, first_simulated).
  std::size_t first_measurand() const { return statement.intermediates.size(); }
  std::size_t first_simulated() const { return first_measurand() + statement.measurands.size(); }
};

/// Compiles a statement. Throws InputError with every problem, each at its character. Adds to `notes` what the reader of
/// the scenario should know: names that no formula uses.
Compiled compile(Statement statement, std::vector<std::string>& notes);

} // namespace gumshoe::formula
