#include "scenario/data_column.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gumshoe::scenario {

std::vector<Key> column_keys() {
  return {{"column", shape::text(), "column name in the first row of the file", true},
          {"unit", shape::text(), "unit of the numbers in the column; default: a plain number"}};
}

std::vector<Key> data_column_keys() {
  std::vector<Key> keys = column_keys();
  keys.insert(keys.begin(), {"file", shape::text(), "CSV file, relative to the scenario", true});
  keys.push_back({"decimal", shape::words({".", ","}), "decimal sign of the numbers in the file", false, "\".\""});
  return keys;
}

int find_column(Table& table, const std::string& key, const Csv& csv) {
  const auto name = table.text(key);
  if (!name) return -1;
  const int column = csv.find(*name);
  if (column < 0)
    table.refuse_key(key, fmt::format("'{}' has no column '{}'", csv.file, *name), "",
                     did_you_mean(*name, csv.names()));
  return column;
}

char read_decimal(Table& table) { return table.choice("decimal", {".", ","}).value_or(0) == 1 ? ',' : '.'; }

std::optional<DataColumn> read_data_column(Table& table, const std::string& si_unit, DataFiles& files,
                                           bool of_readings) {
  DataColumn out;
  const Node* file = table.require("file");
  const Node* column = table.require("column");
  const auto unit = table.text("unit");
  out.decimal = read_decimal(table);
  if (file)
    out.csv = of_readings ? files.open_readings(*file, table.path("file"), table.problems())
                          : files.open(*file, table.path("file"), table.problems());
  if (!table.has("unit") && si_unit != "1")
    table.add(fmt::format("{} is missing", table.path("unit")), "numbers in a column carry no unit", "unit = \"mm\"");
  out.unit = unit.value_or("1");
  const bool known = table.has("unit") ? unit && units::convertible(out.unit, si_unit) : si_unit == "1";
  if (unit && !known) {
    try {
      units::to_si(0, *unit, si_unit);
    } catch (const InputError& error) {
      table.problems().add(*table.find("unit"), table.path("unit"), error);
    }
  }
  if (out.csv && column) out.column = find_column(table, "column", *out.csv);
  if (out.column < 0 || !known) return std::nullopt;
  return out;
}

std::optional<double> read_cell(const Csv& csv, const CsvCell& cell, const std::string& unit, char decimal,
                                const Dimension& dimension, Problems& problems) {
  try {
    return units::to_si(csv.number(cell, decimal), unit, dimension.si_unit, dimension.kind);
  } catch (const InputError& error) {
    problems.add(error);
    return std::nullopt;
  }
}

RowFilter::RowFilter(Table& table, const Csv& csv, const Columns& labels) {
  if (auto where = table.table("where"))
    for (const Member& m : where->members()) read_rule(*where, m, csv, labels);
}

void RowFilter::read_rule(Table& where, const Member& m, const Csv& csv, const Columns& labels) {
  Rule rule;
  rule.name = m.key;
  const auto label = std::ranges::find(labels, m.key, &Columns::value_type::first);
  rule.label = label != labels.end();
  const int column = rule.label ? static_cast<int>(label->second) : csv.find(m.key);
  if (column < 0) {
    std::vector<std::string> names = csv.names();
    for (const auto& [name, at] : labels) names.push_back(name);
    return where.problems().add(m, fmt::format("{}: '{}' is neither a label of these readings nor a column of '{}'",
                                               where.path(), m.key, csv.file),
                                "where selects rows by their cells", did_you_mean(m.key, names));
  }
  rule.column = static_cast<std::size_t>(column);
  bool nothing = m.value.kind == Node::Kind::array && m.value.items.empty();
  if (m.value.kind == Node::Kind::table) {
    Table inner(m.value, where.path(m.key), where.problems());
    const Node* texts = inner.require("not", "{ not = \"...\" }");
    if (texts) rule.texts = inner.texts("not");
    nothing = texts && texts->kind == Node::Kind::array && texts->items.empty();
    rule.excluded = true;
    inner.refuse_unknown();
  } else {
    rule.texts = where.texts(m.key);
  }
  std::vector<std::string> known;
  for (const auto& row : csv.rows) known.push_back(row[rule.column].text);
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const std::string& text : rule.texts)
    if (!std::ranges::binary_search(known, text))
      where.refuse_key(m.key, fmt::format("no row of '{}' has {} = '{}'", csv.file, m.key, text), "",
                       did_you_mean(text, known));
  if (nothing) where.refuse_key(m.key, "no value is named", "", "give a text, a list, or { not = \"...\" }");
  rules_.push_back(std::move(rule));
}

bool RowFilter::keeps(const std::vector<CsvCell>& row, bool labels) const {
  return std::ranges::all_of(rules_, [&](const Rule& r) {
    return r.label != labels || (std::ranges::find(r.texts, row[r.column].text) != r.texts.end()) != r.excluded;
  });
}

quantities::Labels RowFilter::fixed() const {
  quantities::Labels out;
  for (const Rule& r : rules_)
    if (r.label && !r.excluded && r.texts.size() == 1) out.emplace_back(r.name, r.texts.front());
  return out;
}

std::string RowFilter::text() const {
  std::string out;
  for (const Rule& r : rules_)
    out += fmt::format("{}{} = {}{}", out.empty() ? "" : ", ", r.name, r.excluded ? "not " : "",
                       fmt::join(r.texts, r.excluded ? " and not " : " or "));
  return out;
}

Shape where_shape() {
  const Shape texts = shape::texts(R"("minItems": 1)");
  const Key excluded{"not", texts, "the rows without these", true};
  return shape::map(shape::any_of({texts, shape::table({excluded})}), R"("propertyNames": {"not": {"const": "reading"}})");
}

Key where_key() { return {"where", shape::reference("where"), "only the rows with these cells"}; }

namespace {

std::vector<Key> series_keys() {
  std::vector<Key> keys = data_column_keys();
  keys.push_back(where_key());
  return keys;
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
    source.declare(series_keys());
    if (const auto data = read_data_column(source, dimension.si_unit, context.files)) {
      const RowFilter filter(source, *data->csv, {});
      for (const auto& row : data->csv->rows)
        if (filter.keeps_columns(row))
          if (const auto v = read_cell(*data->csv, row[static_cast<std::size_t>(data->column)], data->unit,
                                       data->decimal, dimension, context.problems))
            x.push_back(*v);
      if (x.empty() && context.problems.size() == problems)
        source.refuse(fmt::format("no row of '{}' is left", data->csv->file), filter.text());
    }
    source.find("where");
    source.refuse_unknown();
  } else if (const auto* items = table.array(key)) {
    for (const Node& item : *items)
      if (const auto v = read_measure(item, table.path(key), dimension, context.problems)) x.push_back(*v);
  }
  if (context.problems.size() > problems) return std::nullopt;
  return x;
}

} // namespace gumshoe::scenario
