#include "scenario/choose_variables.h"

#include <algorithm>

#include "scenario/option.h"

namespace gumshoe::scenario {
namespace {

/// { low, high, steps, scale }
struct Range {
  int steps = 5;
  bool logarithmic = false;
};

Options<Range> range_options() {
  return {
      option::by_hand<Range>("low", shape::reference("measure"), "smallest value").needed(),
      option::by_hand<Range>("high", shape::reference("measure"), "largest value").needed(),
      option::whole("steps", &Range::steps, 2, 1000, "values of the coarse grid, both ends included"),
      option::word("scale", &Range::logarithmic, {{"linear", false}, {"log", true}}, "scale on which the values are "
                                                                                     "evenly spaced"),
  };
}

void read_range(Table table, KnobReader& knobs, Variable& v) {
  if (v.knob.kind == Knob::Kind::evaluation) {
    table.refuse("evaluations must be listed", "", "evaluation = [\"...\"]");
    return;
  }
  Range range;
  read_options(table, range_options(), range);
  const Node *low = table.find("low"), *high = table.find("high");
  const auto a = low ? knobs.value(*low, table.path("low"), v.knob) : std::nullopt;
  const auto b = high ? knobs.value(*high, table.path("high"), v.knob) : std::nullopt;
  table.refuse_unknown();
  if (!a || !b) return;
  if (!(*a < *b)) return table.refuse("low must be below high");
  if (range.logarithmic && *a <= 0)
    return table.refuse_key("low", "not above 0", "a logarithmic scale has no zero", "scale = \"linear\"");
  v.range = true;
  v.logarithmic = range.logarithmic;
  v.steps = range.steps;
  v.values = {*a, *b};
  std::vector<double> grid;
  for (int i = 0; i < v.steps; ++i) {
    const double x = v.at(i, v.steps - 1);
    if (grid.empty() || x > grid.back()) grid.push_back(x);
  }
  v.values = std::move(grid);
}

void read_list(const Member& m, const std::string& path, KnobReader& knobs, Problems& problems, Variable& v) {
  if (m.value.items.empty()) problems.add(m.value, path + ": empty", "there is nothing to choose from");
  for (const Node& item : m.value.items) {
    const auto x = knobs.value(item, path, v.knob);
    if (x && std::ranges::find(v.values, *x) != v.values.end())
      problems.add(item, path + ": the value is listed twice");
    else if (x)
      v.values.push_back(*x);
  }
}

} // namespace

Shape setting_shape() { return shape::any_of({shape::number(), shape::text()}); }

Shape variables_shape() {
  return shape::map(shape::any_of({shape::list(setting_shape(), R"("minItems": 1)"), table_shape(range_options())}),
                    R"("minProperties": 1)");
}

std::vector<Variable> read_variables(Table& table, KnobReader& knobs) {
  std::vector<Variable> out;
  for (const Member& m : table.members()) {
    const auto knob = knobs.find(m, table.path(), false);
    if (!knob) continue;
    Variable v{*knob, {}};
    if (m.value.kind == Node::Kind::table)
      read_range(Table(m.value, table.path(m.key), table.problems()), knobs, v);
    else if (table.array(m.key))
      read_list(m, table.path(m.key), knobs, table.problems(), v);
    if (!v.values.empty()) out.push_back(std::move(v));
  }
  if (table.members().empty()) table.refuse("empty", "there is nothing to choose from");
  return out;
}

} // namespace gumshoe::scenario
