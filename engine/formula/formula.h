#pragma once
/// A formula as written: its text, its place and its tree.
///
///   sum     = product { ("+" | "-") product }
///   product = signed { ("*" | "/") signed }
///   signed  = ("-" | "+") signed | power
///   power   = primary [ "^" signed ]              right-associative; -x^2 is -(x^2)
///   primary = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "formula/operation.h"

namespace gumshoe::formula {

/// Operands are indices of earlier nodes: the order of the nodes is an order of computation, and no walk recurses.
struct Node {
  Operation operation = Operation::number;
  std::size_t at = 0; ///< byte in the text: of the operator, the function's name, the number
  std::size_t a = 0, b = 0;
  double value = 0; ///< number
  std::string name; ///< name
};

struct Formula {
  std::string name, text;
  Location where;          ///< of the text's first character
  std::vector<Node> nodes; ///< the last one is the result

  /// The name without the path before it: "y" of "model.measurands.y".
  std::string short_name() const { return name.substr(name.rfind('.') + 1); }
  /// The place of a byte of the text. A text of several lines is placed as a whole.
  Location place(std::size_t at) const;
  /// The text that node `n` stands for starts here: a sum's place is its operator, its start the first operand.
  std::size_t start(std::size_t n) const;
  Problem problem(std::size_t at, std::string what, std::string why = {}, std::string remedy = {}) const;
};

/// Fills `nodes` from `text`. Throws InputError at the character where the text stops being a formula.
void parse(Formula& formula);

/// True if formulas can call it: letters, digits and _, no digit first.
bool is_name(std::string_view word);

} // namespace gumshoe::formula
