/// [model] name = "expression": tables of formulas.
#include <fmt/format.h>

#include "models/expression/expression.h"
#include "scenario/declared.h"
#include "scenario/made_model.h"

namespace gumshoe::scenario {
namespace {

namespace expression = models::expression;

/// Of the text's first character; the node lies at its quote.
Location place_of(const Node& node, const std::string& file) { return {file, node.line, node.column + 1}; }

expression::Stated read_formula(const Node& node, const std::string& path, bool with_unit, Problems& problems) {
  expression::Stated out;
  out.formula.name = path;
  if (node.kind == Node::Kind::table && with_unit) {
    Table table(node, path, problems);
    if (const Node* formula = table.require("formula", "formula = \"...\"?")) {
      if (const auto text = table.text("formula")) out.formula.text = *text;
      out.formula.where = place_of(*formula, problems.file());
    }
    if (const auto unit = table.text("unit")) {
      out.unit = *unit;
      out.unit_place = {problems.file(), table.find("unit")->line, table.find("unit")->column};
    }
    table.refuse_unknown();
    return out;
  }
  if (node.kind == Node::Kind::integer || node.kind == Node::Kind::real) {
    out.formula.text = fmt::format("{}", node.number);
  } else if (const auto text = read_text(node, path, problems)) {
    out.formula.text = *text;
  }
  out.formula.where = place_of(node, problems.file());
  return out;
}

std::vector<expression::Stated> read_formulas(Table& model, const char* key, bool with_unit) {
  std::vector<expression::Stated> out;
  if (auto table = model.table(key))
    for (const Member& m : table->members())
      out.push_back(read_formula(m.value, table->path(m.key), with_unit, model.problems()));
  return out;
}

} // namespace

models::MadeModel make_expression(Table& model, Table& top, Context& context) {
  const std::size_t before = context.problems.size();
  expression::Statement s;
  s.intermediates = read_formulas(model, "intermediates", false);
  s.measurands = read_formulas(model, "measurands", true);
  s.simulated = read_formulas(model, "indications", false);
  Declared declared = declared_symbols(top, context.problems);
  s.quantities = std::move(declared.quantities);
  s.conditions = std::move(declared.conditions);
  s.indications = std::move(declared.indications);
  const Node* method = model.find("method");
  s.virtual_experiment = method && method->text == "virtual_experiment";
  if (s.measurands.empty() && s.simulated.empty())
    model.add("model: no formula", "an expression states what is measured", "[model.measurands] y = \"a + b\"?");
  if (context.problems.size() != before) return nullptr;
  try {
    return expression::make(std::move(s), context.notes);
  } catch (const InputError& error) {
    context.problems.add(error);
    return nullptr;
  }
}

} // namespace gumshoe::scenario
