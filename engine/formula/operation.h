#pragma once
/// What a formula may do: one list for the parser, the dimension check and the interpreter.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gumshoe::formula {

enum class Operation : std::uint8_t {
  number,
  name,
  add,
  subtract,
  multiply,
  divide,
  negate,
  power,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  log10,
  sqrt,
  abs,
  min,
  max,
  hypot,
};

struct Function {
  std::string_view name;
  Operation operation;
  int arguments;
};

/// Every function a formula may call; `log` is natural, `ln` another name of it.
std::span<const Function> functions();
/// Null if there is no function of this name.
const Function* find_function(std::string_view name);
std::vector<std::string> function_names();

/// pi and e; null for any other name.
const double* find_constant(std::string_view name);

/// "a constant of formulas" or "a function of formulas" where the name is one; else empty: for messages.
std::string_view reserved_as(std::string_view name);

/// "division", "log", "+": for messages.
std::string_view word(Operation operation);

/// True if the operation has two operands.
constexpr bool is_binary(Operation o) {
  switch (o) {
  case Operation::add:
  case Operation::subtract:
  case Operation::multiply:
  case Operation::divide:
  case Operation::power:
  case Operation::atan2:
  case Operation::min:
  case Operation::max:
  case Operation::hypot:
    return true;
  default:
    return false;
  }
}
/// True if the operation has no operands.
constexpr bool is_leaf(Operation o) { return o == Operation::number || o == Operation::name; }

} // namespace gumshoe::formula
