/// Formulas: a line `name = formula` is a measurand if it is the first, `name := formula` an indication's, and any
/// other line an intermediate. The quantities a to e and the condition x are there to be named.
#include <algorithm>

#include "base/error.h"
#include "formula/compile.h"
#include "formula/finite.h"
#include "formula/interpreter.h"
#include "fuzz/harness.h"

namespace gumshoe::fuzz {
namespace {

formula::Stated stated(std::string_view line, int number) {
  const std::size_t equals = std::min(line.find('='), line.size());
  formula::Stated out;
  std::string_view name = line.substr(0, equals);
  while (name.ends_with(' ') || name.ends_with(':')) name.remove_suffix(1);
  out.formula.name = "model." + std::string(name);
  out.formula.text = line.substr(std::min(equals + 1, line.size()));
  out.formula.where = {"s.toml", number, static_cast<int>(equals) + 2};
  return out;
}

formula::Statement statement(std::string_view input) {
  formula::Statement s;
  s.quantities = {
      {"a", "mm", "m", ""}, {"b", "m", "m", ""}, {"c", "1", "1", ""}, {"d", "deg", "rad", ""}, {"e", "degC", "K", ""}};
  s.conditions = {{"x", "mm/min", "m/s", ""}};
  for (int number = 1; !input.empty(); ++number) {
    const std::size_t end = std::min(input.find('\n'), input.size());
    const std::string_view line = input.substr(0, end);
    const formula::Stated one = stated(line, number);
    const bool simulated = line.find(":=") != std::string_view::npos;
    if (simulated) s.indications.push_back({one.formula.short_name(), "", "", ""});
    (simulated ? s.simulated : s.measurands.empty() ? s.measurands : s.intermediates).push_back(one);
    input.remove_prefix(std::min(end + 1, input.size()));
  }
  return s;
}

} // namespace

void formula(std::string_view input) {
  std::vector<std::string> notes;
  const formula::Compiled compiled = formula::compile(statement(input), notes);
  const double quantities[] = {0.01, 2, 0.5, 0.3, 293.15}, conditions[] = {0.1};
  const std::vector<double> indications(compiled.statement.indications.size(), 1);
  const formula::Inputs<double> at{quantities, conditions, indications.data()};
  for (const auto* program : {&compiled.evaluate, &compiled.simulate, &compiled.explain})
    formula::require_finite(compiled, *program, at);
}

} // namespace gumshoe::fuzz
