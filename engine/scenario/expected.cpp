#include "scenario/expected.h"

#include "scenario/studies.h"

namespace gumshoe::scenario {
namespace {

/// A number with a unit as text, or a bare one as the file's reader gave it back.
Option<Expected> figure(const std::string& key, std::string Expected::*member, std::string meaning) {
  return {{key, R"("type": ["string", "number"])", std::move(meaning)}, [=](Table& t, Expected& e) {
            const Node* node = t.find(key);
            if (node && node->kind == Node::Kind::integer)
              e.*member = fmt::format("{}", node->integer);
            else if (node && node->kind == Node::Kind::real)
              e.*member = fmt::format("{}", node->number);
            else
              e.*member = t.text(key).value_or("");
          }};
}

Options<Expected> expected_options() {
  return {
      option::text(
          "figure", &Expected::figure,
          "standard_uncertainty, gum.expanded_uncertainty, first[x1] ...: scenarios/gauge/README.md lists them")
          .needed("figure = \"standard_uncertainty\""),
      option::by_hand<Expected>("of", shape::text(), "measurand; may be left out if there is only one"),
      option::by_hand<Expected>(labels_key()),
      figure("value", &Expected::value, "value with its unit; the last digit sets the tolerance").needed(),
      option::source(&Expected::source),
      figure("tolerance", &Expected::tolerance,
             "tolerance, such as \"0.01 mg\" or \"1e-6 relative\"; default: half a unit of the last digit"),
      option::text("why", &Expected::why, "reason for the tolerance"),
      option::text("note", &Expected::note, "known reason for a difference, which is then reported as NOTE"),
  };
}

Expected read_one(Table table, const ModelCard& model, Context& context) {
  Expected out;
  out.where = {context.problems.file(), table.node().line, table.node().column};
  read_options(table, expected_options(), out);
  const std::vector<std::string> names = names_of(model.measurands);
  if (const auto index = table.choice("of", names)) out.of = names[*index];
  out.labels = read_labels(table, context);
  if (!out.tolerance.empty() && out.why.empty())
    table.refuse("a tolerance without a reason", "the default is half a unit of the last digit", "why = \"...\"");
  table.refuse_unknown();
  return out;
}

} // namespace

Shape expected_shape() { return table_shape(expected_options()); }

std::vector<Expected> read_expected(Table& top, const ModelCard& model, Context& context) {
  std::vector<Expected> out;
  for (const Table& row : top.tables("expected")) out.push_back(read_one(row, model, context));
  return out;
}

} // namespace gumshoe::scenario
