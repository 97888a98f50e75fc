#include "formula/compile.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "formula/assemble.h"
#include "formula/dimensions.h"
#include "formula/result_units.h"

namespace gumshoe::formula {
namespace {

void raise(const std::vector<Problem>& problems) {
  if (!problems.empty()) throw InputError(problems);
}

void parse_all(std::vector<Formula>& formulas, std::vector<Problem>& problems) {
  for (Formula& f : formulas) {
    try {
      parse(f);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      f.nodes.clear();
    }
  }
}

void note_unused(const Compiled& c, const Names& names, std::vector<std::string>& notes) {
  std::set<const Symbol*> used;
  std::set<std::size_t> formulas;
  for (const Formula& f : c.formulas)
    for (const Node& n : f.nodes)
      if (const Meaning* m = n.operation == Operation::name ? names.find(n.name, false) : nullptr) {
        if (m->symbol)
          used.insert(m->symbol);
        else
          formulas.insert(m->index);
      }
  for (const Symbol& q : c.statement.quantities)
    if (!used.contains(&q)) notes.push_back(fmt::format("quantities.{}: no formula uses this quantity", q.name));
  for (std::size_t i = 0; i < c.first_measurand(); ++i)
    if (!formulas.contains(i)) notes.push_back(fmt::format("{}: no formula uses this quantity", c.formulas[i].name));
}

} // namespace

Compiled compile(Statement statement, std::vector<std::string>& notes) {
  Compiled c;
  c.statement = std::move(statement);
  for (const auto* list : {&c.statement.intermediates, &c.statement.measurands, &c.statement.simulated})
    for (const Stated& s : *list) c.formulas.push_back(s.formula);
  std::vector<Problem> problems;
  parse_all(c.formulas, problems);
  const Names names(c.statement, c.formulas, problems);
  for (const Formula& f : c.formulas) names.check(f, problems);
  raise(problems);
  const auto everything = indices(0, c.formulas.size());
  names.order(everything, false, problems);
  raise(problems);
  // An indication without readings has the unit that its formula gives.
  const bool unread = std::ranges::any_of(c.statement.indications, [](const Symbol& s) { return s.unit.empty(); });
  const auto all = names.order(everything, unread, problems);
  raise(problems);
  const auto kinds = kinds_of(c.formulas, all, names, unread, problems);
  raise(problems);
  settle_units(c, kinds, problems);
  raise(problems);
  note_unused(c, names, notes);
  assemble(c, names, problems);
  raise(problems);
  return c;
}

} // namespace gumshoe::formula
