#pragma once
/// What the names in formulas stand for, and the order in which formulas can be computed.
#include <map>
#include <optional>

#include "formula/program.h"
#include "formula/statement.h"

namespace gumshoe::formula {

/// A column of the model, or another formula.
struct Meaning {
  Source source = Source::step; ///< step: a formula
  std::size_t index = 0;
  const Symbol* symbol = nullptr; ///< of a column
};

class Names {
public:
  /// Problems: names taken twice, names that formulas cannot write. `formulas` in the order of Compiled::formulas.
  Names(const Statement& statement, const std::vector<Formula>& formulas, std::vector<Problem>& problems);
  /// Null if unknown or a constant. Where an indication has a formula, `simulating` chooses it over the reading.
  const Meaning* find(const std::string& name, bool simulating) const;
  /// Problems at every name that means nothing.
  void check(const Formula& formula, std::vector<Problem>& problems) const;
  /// Indices of `roots` and of all they need, each after what it needs; a problem, and an empty list, if they go
  /// round in a circle.
  std::vector<std::size_t> order(const std::vector<std::size_t>& roots, bool simulating,
                                 std::vector<Problem>& problems) const;

private:
  const std::vector<Formula>& formulas_;
  std::map<std::string, Meaning> meanings_, simulated_;
};

} // namespace gumshoe::formula
