#include "scenario/expected.h"

#include <fmt/format.h>

#include "scenario/studies.h"

namespace gumshoe::scenario {
namespace {

/// Text, or a bare number as the file's reader gave it back.
std::string figure_text(Table& table, const std::string& key) {
  const Node* node = table.find(key);
  if (!node) return {};
  if (node->kind == Node::Kind::integer) return fmt::format("{}", node->integer);
  if (node->kind == Node::Kind::real) return fmt::format("{}", node->number);
  return table.text(key).value_or("");
}

Expected read_one(Table table, const ModelCard& model, Context& context) {
  Expected out;
  out.where = {context.problems.file(), table.node().line, table.node().column};
  table.require("figure", "figure = \"standard_uncertainty\"");
  table.require("value");
  out.figure = table.text("figure").value_or("");
  std::vector<std::string> names;
  for (const VariableCard& m : model.measurands) names.emplace_back(m.name);
  if (const auto index = table.choice("of", names)) out.of = names[*index];
  out.labels = read_labels(table, context);
  out.value = figure_text(table, "value");
  out.source = table.rendered("source");
  out.tolerance = figure_text(table, "tolerance");
  out.why = table.text("why").value_or("");
  out.note = table.text("note").value_or("");
  if (!out.tolerance.empty() && out.why.empty())
    table.add(table.path() + ": a tolerance without a reason", "half a unit of the last digit is the rule",
              "why = \"...\"");
  table.refuse_unknown();
  return out;
}

} // namespace

std::vector<Expected> read_expected(Table& top, const ModelCard& model, Context& context) {
  std::vector<Expected> out;
  const auto* items = top.array("expected");
  for (std::size_t i = 0; items && i < items->size(); ++i)
    if (auto row = as_table((*items)[i], fmt::format("expected[{}]", i + 1), context.problems))
      out.push_back(read_one(*row, model, context));
  return out;
}

} // namespace gumshoe::scenario
