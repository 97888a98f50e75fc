#include "scenario/row_filter.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gumshoe::scenario {

void RowFilter::add(Table& table, const Csv& csv, const Columns& labels) {
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
    return where.problems().add(m,
                                fmt::format("{}: '{}' is neither a label of these readings nor a column of '{}'",
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
  return shape::map(shape::any_of({texts, shape::table({excluded})}),
                    R"("propertyNames": {"not": {"const": "reading"}})");
}

Key where_key() { return {"where", shape::reference("where"), "only the rows with these cells"}; }

} // namespace gumshoe::scenario
