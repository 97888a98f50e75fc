#include "scenario/series.h"

#include <fmt/format.h>

#include "scenario/data_file.h"
#include "scenario/row_filter.h"

namespace gumshoe::scenario {
namespace {

std::vector<Key> series_keys() {
  std::vector<Key> keys = data_file_keys();
  keys.push_back({"column", shape::text(), "column name in the first row of the file", true});
  keys.push_back({"unit", shape::text(), "unit of the numbers in the column; default: a plain number"});
  keys.push_back(where_key());
  keys.front().required = true;
  return keys;
}

/// The unit of the column; nothing and a problem if it is missing or of another kind.
std::optional<std::string> read_unit(Table& table, const std::string& si_unit) {
  const auto unit = table.text("unit");
  if (!table.has("unit")) {
    if (si_unit == "1") return "1";
    table.add(fmt::format("{} is missing", table.path("unit")), "numbers in a column carry no unit", "unit = \"mm\"");
    return std::nullopt;
  }
  if (!unit || units::convertible(*unit, si_unit)) return unit;
  try {
    units::to_si(0, *unit, si_unit);
  } catch (const InputError& error) {
    table.problems().add(*table.find("unit"), table.path("unit"), error);
  }
  return std::nullopt;
}

void read_column(Table& source, const Dimension& dimension, Context& context, std::vector<double>& x) {
  source.declare(series_keys());
  const std::size_t problems = context.problems.size();
  const auto data = read_data_file(source, context.files);
  const Node* named = source.require("column");
  const auto unit = read_unit(source, dimension.si_unit);
  const int column = data && named ? find_column(source, "column", *data->csv) : -1;
  RowFilter filter;
  if (data) filter.add(source, *data->csv, {});
  source.find("where");
  source.refuse_unknown();
  if (column < 0 || !unit) return;
  if (source.has("unit")) note_other_unit(*data, named->text, *unit, dimension.si_unit);
  for (const auto& row : data->csv->rows)
    if (filter.keeps_columns(row))
      if (const auto v =
              read_cell(*data, row[static_cast<std::size_t>(column)], named->text, *unit, dimension, context.problems))
        x.push_back(*v);
  if (x.empty() && context.problems.size() == problems)
    source.refuse(fmt::format("no row of '{}' is left", data->csv->file), filter.text());
}

} // namespace

Shape series_shape() {
  return shape::any_of({shape::list(shape::reference("measure"), R"("minItems": 1)"), shape::table(series_keys())});
}

std::optional<std::vector<double>> read_series(Table& table, const std::string& key, const Dimension& dimension,
                                               Context& context) {
  const Node* node = table.find(key);
  if (!node) return std::nullopt;
  const std::size_t problems = context.problems.size();
  std::vector<double> x;
  if (node->kind == Node::Kind::table) {
    Table source(*node, table.path(key), context.problems);
    read_column(source, dimension, context, x);
  } else if (const auto* items = table.array(key)) {
    for (const Node& item : *items)
      if (const auto v = read_measure(item, table.path(key), dimension, context.problems)) x.push_back(*v);
  }
  if (context.problems.size() > problems) return std::nullopt;
  return x;
}

} // namespace gumshoe::scenario
