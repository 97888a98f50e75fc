/// [model] name = "expression": tables of formulas.
#include <algorithm>
#include <cctype>

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
    for (const Member& m : table->members()) {
      if (m.key.find('.') != m.key.npos) // else what follows it would be the name
        model.problems().add(m, fmt::format("{}: '{}' cannot be the name of a formula", table->path(m.key), m.key),
                             "use letters, digits and _, with no digit first", "");
      out.push_back(read_formula(m.value, table->path(m.key), with_unit, model.problems()));
    }
  return out;
}

bool mentions(const std::string& text, const std::string& name) {
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !in_name(text[at - 1])) && (end == text.size() || !in_name(text[end]))) return true;
  }
  return false;
}

/// What a problem of dimensions does not see: that a plain number is a column of which nobody stated the unit.
class UnitHints {
public:
  UnitHints(const formula::Statement& s, const Declared& declared) : columns_(declared.columns_without_unit) {
    for (const auto* formulas : {&s.intermediates, &s.measurands, &s.simulated})
      for (const formula::Stated& f : *formulas) formulas_.emplace_back(f.formula.name, f.formula.text);
    for (const formula::Stated& f : s.intermediates) intermediates_ += ' ' + f.formula.text;
  }

  void add(Problem& p) const {
    if ((p.what + p.why).find("plain number") == std::string::npos) return;
    for (const auto& [path, text] : formulas_) {
      if (!p.what.starts_with(path + ": ") && !p.what.starts_with(path + ".unit: ")) continue;
      for (const auto& [name, column] : columns_)
        if (mentions(text + intermediates_, name) || path.ends_with("." + name))
          p.remedy += fmt::format("{}state the unit of the column '{}', without which {} is a plain number",
                                  p.remedy.empty() ? "" : "; or ", column, name);
      return;
    }
  }

private:
  std::vector<std::pair<std::string, std::string>> columns_, formulas_;
  std::string intermediates_;
};

/// A measurand may have the name of a quantity, as its true value from which readings are simulated, unless a formula
/// of the evaluation has that name in it: it would mean the quantity.
void refuse_names_of_quantities(const formula::Statement& s, Problems& problems) {
  const auto ambiguous = [&](const std::string& name) {
    const auto other = [&](const formula::Stated& f) {
      return f.formula.text != name && mentions(f.formula.text, name);
    };
    return std::ranges::any_of(s.measurands, other) || std::ranges::any_of(s.intermediates, other);
  };
  for (const formula::Stated& m : s.measurands) {
    const std::string name = m.formula.short_name();
    if (m.formula.text == name || std::ranges::find(s.quantities, name, &Symbol::name) == s.quantities.end()) continue;
    if (ambiguous(name))
      problems.add({m.formula.where, fmt::format("{}: '{}' is a quantity, too", m.formula.name, name),
                    fmt::format("'{}' in a formula means the quantity", name), "rename one of them"});
  }
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
  const bool virtual_experiment = method && method->text == "virtual_experiment";
  if (!virtual_experiment) refuse_names_of_quantities(s, context.problems);
  if (s.measurands.empty() && s.simulated.empty())
    model.add("model: there is no formula", "an expression needs at least one measurand",
              "[model.measurands] y = \"a + b\"");
  if (context.problems.size() != before) return nullptr;
  const UnitHints hints(s, declared);
  try {
    return models::expression::make(std::move(s), context.notes, virtual_experiment);
  } catch (const InputError& error) {
    for (Problem p : error.problems()) {
      hints.add(p);
      if (p.where.file.empty()) p.where = {context.problems.file(), model.node().line, model.node().column};
      context.problems.add(InputError(std::vector<Problem>{std::move(p)}));
    }
    return nullptr;
  }
}

} // namespace gumshoe::scenario
