#pragma once
/// Formulas compiled: a list of steps, each on the values of earlier ones. Equal subexpressions are one step,
/// constants are folded.
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "formula/formula.h"

namespace gumshoe::formula {

enum class Source : std::uint8_t { step, constant, quantity, condition, indication };

/// The origin of a step, for messages: a node of a formula.
struct Origin {
  std::size_t formula = 0, node = 0;
};

/// One value. A constant holds its number, an input the index of its column, a step its operation and operands.
struct Step {
  Source source = Source::step;
  Operation operation = Operation::number;
  std::uint32_t a = 0, b = 0; ///< indices of earlier steps; of an input: a is its column
  double value = 0;
  std::uint32_t home = 0; ///< register that holds its values while a block is computed
  Origin origin;
};

struct Program {
  std::vector<Step> steps;
  std::vector<std::uint32_t> outputs; ///< steps
  std::uint32_t registers = 0;
};

/// Builds a program value by value; handed numbers are indices of steps.
class Builder {
public:
  using Value = std::uint32_t;
  Value constant(double value);
  Value input(Source source, std::size_t column);
  /// Powers with small whole exponents become products, x^0.5 a square root.
  Value operation(Operation operation, Value a, Value b, const Origin& origin);
  /// Leaves out what no output needs and assigns registers.
  Program finish(std::span<const Value> outputs) const;
  const Step& step(Value v) const { return steps_[v]; }

private:
  Value keep(Step step);
  Value whole_power(Value base, int exponent, const Origin& origin);
  using Key = std::tuple<Source, Operation, std::uint32_t, std::uint32_t, std::uint64_t>;
  std::vector<Step> steps_;
  std::map<Key, Value> known_;
};

} // namespace gumshoe::formula
