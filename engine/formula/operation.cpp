#include "formula/operation.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace gumshoe::formula {
namespace {

constexpr std::array list{
    Function{"sin", Operation::sin, 1},     Function{"cos", Operation::cos, 1},
    Function{"tan", Operation::tan, 1},     Function{"asin", Operation::asin, 1},
    Function{"acos", Operation::acos, 1},   Function{"atan", Operation::atan, 1},
    Function{"atan2", Operation::atan2, 2}, Function{"sinh", Operation::sinh, 1},
    Function{"cosh", Operation::cosh, 1},   Function{"tanh", Operation::tanh, 1},
    Function{"exp", Operation::exp, 1},     Function{"log", Operation::log, 1},
    Function{"ln", Operation::log, 1},      Function{"log10", Operation::log10, 1},
    Function{"sqrt", Operation::sqrt, 1},   Function{"abs", Operation::abs, 1},
    Function{"min", Operation::min, 2},     Function{"max", Operation::max, 2},
    Function{"pow", Operation::power, 2},   Function{"hypot", Operation::hypot, 2},
};

constexpr double pi = std::numbers::pi, e = std::numbers::e;

} // namespace

std::span<const Function> functions() { return list; }

const Function* find_function(std::string_view name) {
  const auto it = std::ranges::find(list, name, &Function::name);
  return it == list.end() ? nullptr : &*it;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const Function& f : list) names.emplace_back(f.name);
  return names;
}

const double* find_constant(std::string_view name) { return name == "pi" ? &pi : name == "e" ? &e : nullptr; }

std::string_view reserved_as(std::string_view name) {
  return find_constant(name) ? "a constant of formulas" : find_function(name) ? "a function of formulas" : "";
}

std::string_view word(Operation operation) {
  switch (operation) {
  case Operation::number:
    return "number";
  case Operation::name:
    return "name";
  case Operation::add:
    return "+";
  case Operation::subtract:
  case Operation::negate:
    return "-";
  case Operation::multiply:
    return "*";
  case Operation::divide:
    return "/";
  case Operation::power:
    return "^";
  default:
    return std::ranges::find(list, operation, &Function::operation)->name;
  }
}

} // namespace gumshoe::formula
