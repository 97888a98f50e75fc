/// [model] name = "expression": tables of formulas.
#include <algorithm>

#include <fmt/format.h>

#include "models/expression/expression.h"
#include "scenario/declared.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {
namespace {

/// Place of the first character of the text; the node's place is that of its quote.
Location place_of(const Node& node, const std::string& file) { return {file, node.line, node.column + 1}; }

formula::Stated read_formula(const Node& node, const std::string& path, bool with_unit, Problems& problems) {
  formula::Stated out;
  out.formula.name = path;
  if (node.kind == Node::Kind::table && with_unit) {
    Table table(node, path, problems);
    if (const Node* formula = table.require("formula", "formula = \"...\"")) {
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

std::vector<formula::Stated> read_formulas(Table& model, const char* key, bool with_unit) {
  std::vector<formula::Stated> out;
  if (auto table = model.table(key))
    for (const Member& m : table->members())
      out.push_back(read_formula(m.value, table->path(m.key), with_unit, model.problems()));
  return out;
}

} // namespace

models::MadeModel make_expression(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const std::size_t before = context.problems.size();
  formula::Statement s;
  s.intermediates = read_formulas(model, "intermediates", false);
  s.measurands = read_formulas(model, "measurands", true);
  s.simulated = read_formulas(model, "indications", false);
  Declared declared = declared_symbols(top, context.problems);
  context.own_quantities = true;
  s.quantities = std::move(declared.quantities);
  s.conditions = std::move(declared.conditions);
  s.indications = std::move(declared.indications);
  for (const auto& f : s.simulated) { // readouts may be missing, in a virtual experiment
    const std::string name = f.formula.name.substr(f.formula.name.rfind('.') + 1);
    if (std::ranges::find(s.indications, name, &Symbol::name) == s.indications.end())
      s.indications.push_back({name, "", "", ""});
  }
  const Node* method = model.find("method");
  if (s.measurands.empty() && s.simulated.empty())
    model.add("model: there is no formula", "an expression needs at least one measurand",
              "[model.measurands] y = \"a + b\"");
  if (context.problems.size() != before) return nullptr;
  try {
    return models::expression::make(std::move(s), context.notes,
                                    method && method->text == "virtual_experiment");
  } catch (const InputError& error) {
    for (Problem p : error.problems()) {
      if (p.where.file.empty()) p.where = {context.problems.file(), model.node().line, model.node().column};
      context.problems.add(InputError(std::vector<Problem>{std::move(p)}));
    }
    return nullptr;
  }
}

} // namespace gumshoe::scenario
