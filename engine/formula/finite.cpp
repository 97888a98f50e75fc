#include "formula/finite.h"

#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe::formula {
namespace {

std::string why_not_finite(Operation operation, double a, double b) {
  switch (operation) {
  case Operation::divide:
    return b == 0 ? "division by zero" : "the quotient overflows";
  case Operation::log:
  case Operation::log10:
    return a == 0 ? "the logarithm of zero" : "the logarithm of a negative number";
  case Operation::sqrt:
    return "the square root of a negative number";
  case Operation::asin:
  case Operation::acos:
    return fmt::format("{} of {:.6g}, which is outside [-1, 1]", word(operation), a);
  case Operation::power:
    return a == 0  ? "a negative power of zero"
           : a < 0 ? "a fractional power of a negative number"
                   : "the power overflows";
  default:
    return fmt::format("the result of '{}' overflows", word(operation));
  }
}

/// "b = 0 m, c = 2": up to four quantities within the operator's second operand (or its only one), with their values.
std::string named_quantities(const Compiled& c, const Formula& f, std::size_t node, const Inputs<double>& at) {
  const Node& top = f.nodes[node];
  std::string named;
  std::vector<std::size_t> open{top.operation == Operation::divide ? top.b : node};
  std::set<std::string> seen;
  while (!open.empty() && seen.size() < 4) {
    const Node& n = f.nodes[open.back()];
    open.pop_back();
    if (n.operation == Operation::name && seen.insert(n.name).second)
      for (std::size_t i = 0; i < c.statement.quantities.size(); ++i)
        if (const Symbol& q = c.statement.quantities[i]; q.name == n.name)
          named += fmt::format("{}{} = {:.6g}{}", named.empty() ? "" : ", ", q.name,
                               units::from_si(at.quantities[i], q.unit, q.si_unit), units::suffix(q.unit));
    if (is_leaf(n.operation)) continue;
    if (is_binary(n.operation)) open.push_back(n.b);
    open.push_back(n.a);
  }
  return named;
}

} // namespace

NotFinite::NotFinite(const Problem& reason)
    : InputError({{reason.where, reason.what + " at the estimates", reason.why, reason.remedy}}), reason_(reason) {}

void require_finite(const Compiled& c, const Program& program, const Inputs<double>& at) {
  const auto values = interpret<double>(program, at);
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const Step& s = program.steps[i];
    if (s.source != Source::step || std::isfinite(values.steps[i])) continue;
    const Formula& f = c.formulas[s.origin.formula];
    throw NotFinite(f.problem(f.nodes[s.origin.node].at,
                              why_not_finite(s.operation, values.steps[s.a], values.steps[s.b]),
                              named_quantities(c, f, s.origin.node, at)));
  }
}

} // namespace gumshoe::formula
