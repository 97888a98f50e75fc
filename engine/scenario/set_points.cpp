#include "scenario/set_points.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "scenario/data_file.h"

namespace gumshoe::scenario {
namespace {

Node* find(Node& table, const std::string& key) {
  const auto it = std::ranges::find(table.members, key, &Member::key);
  return it == table.members.end() ? nullptr : &it->value;
}

/// The table of that key, which is made where there is none.
Node& table_at(Node& parent, const std::string& key, const Node& place) {
  if (Node* known = find(parent, key)) return *known;
  Node made;
  made.line = place.line, made.column = place.column;
  parent.members.push_back({key, place.line, place.column, std::move(made)});
  return parent.members.back().value;
}

Node text_at(const std::string& text, const Node& place) {
  Node out;
  out.kind = Node::Kind::text;
  out.line = place.line, out.column = place.column;
  out.text = text;
  return out;
}

class SetPoints {
public:
  SetPoints(Node& document, DataFiles& files, Problems& problems)
      : document_(document), files_(files), problems_(problems) {}

  void expand() {
    Node* const quantities = find(document_, "quantities");
    if (!quantities) return;
    for (Member& q : quantities->members)
      if (q.value.kind == Node::Kind::table && find(q.value, "column")) quantity(q);
  }

private:
  void quantity(Member& q) {
    Table table(q.value, "quantities." + q.key, problems_);
    for (const char* key : {"value", "by", "estimated"})
      if (table.has(key))
        return table.refuse_key(key, "given together with column", "the column has the values, which were set",
                                "leave it out");
    const Node place = *table.find("column");
    if (!open(table)) return;
    const int column = find_column(table, "column", *file_->csv);
    if (column < 0) return;
    const auto unit = unit_of(table, place.text);
    if (!unit) return;
    Node by = levels(q.value, place, static_cast<std::size_t>(column), *unit);
    Node& data = *find(document_, "data");
    Node& labels = table_at(data, "labels", place);
    if (const Node* known = find(labels, q.key); known && known->text != place.text)
      return table.refuse_key("column", fmt::format("data.labels.{} is another column", q.key), "",
                              "give the label another name");
    if (!find(labels, q.key)) labels.members.push_back({q.key, place.line, place.column, text_at(place.text, place)});
    if (Node& columns = table_at(table_at(document_, "trace", place), "columns", place);
        !find(columns, q.key + "_set")) {
      Node covariate;
      covariate.line = place.line, covariate.column = place.column;
      covariate.members.push_back({"column", place.line, place.column, text_at(place.text, place)});
      covariate.members.push_back({"unit", place.line, place.column, text_at(*unit, place)});
      columns.members.push_back({q.key + "_set", place.line, place.column, std::move(covariate)});
    }
    std::erase_if(q.value.members, [](const Member& m) { return m.key != "source" && m.key != "unit"; });
    Node own;
    own.line = place.line, own.column = place.column;
    own.members.push_back({q.key, place.line, place.column, std::move(by)});
    q.value.members.push_back({"by", place.line, place.column, std::move(own)});
  }

  /// As [data.units] or the quantity says; nothing and a problem if neither does, or they differ.
  std::optional<std::string> unit_of(Table& table, const std::string& column) {
    const auto told = file_->units.find(column);
    const auto own = table.text("unit");
    if (told == file_->units.end() && !own) {
      table.refuse_key("column", fmt::format("the unit of '{}' is not stated", column), "",
                       "state it as unit, or in [data.units]");
      return std::nullopt;
    }
    if (told != file_->units.end() && own && *own != told->second) {
      table.refuse_key("unit", fmt::format("data.units.{} is '{}'", column, told->second), "", "state one of them");
      return std::nullopt;
    }
    return own ? own : told->second;
  }

  /// [data], once; its problems are told by whoever reads it as a whole.
  bool open(Table& table) {
    const Node* const data = find(document_, "data");
    if (!data) {
      table.refuse_key("column", "there is no [data]", "set-points stand in the file of the readings",
                       "[data] file = \"readings.csv\"");
      return false;
    }
    if (!file_) {
      Problems elsewhere(problems_.file());
      Table whole(*data, "data", elsewhere);
      file_ = read_data_file(whole, files_, true);
      if (file_) file_->units = read_units(whole, *file_->csv);
    }
    return file_.has_value();
  }

  /// An entry for each text of the column: its number, and what the quantity says of deviations.
  Node levels(const Node& quantity, const Node& place, std::size_t column, const std::string& unit) {
    Node out;
    out.line = place.line, out.column = place.column;
    std::map<double, std::string> texts;
    const bool deviates = std::ranges::any_of(
        quantity.members, [](const Member& m) { return m.key != "column" && m.key != "unit" && m.key != "source"; });
    for (const auto& row : file_->csv->rows) {
      const std::string& text = row[column].text;
      if (find(out, text)) continue;
      const auto value = number(row[column]);
      if (!value) continue;
      const auto [known, fresh] = texts.try_emplace(*value, text);
      if (!fresh && deviates)
        problems_.add(place,
                      fmt::format("quantities: '{}' and '{}' in the column '{}' are one set-point", known->second, text,
                                  place.text),
                      "its deviation is drawn once", "write them alike");
      Node entry;
      entry.line = place.line, entry.column = place.column;
      entry.members.push_back({"value", place.line, place.column, text_at(fmt::format("{} {}", *value, unit), place)});
      for (const Member& m : quantity.members)
        if (m.key != "column" && m.key != "unit" && m.key != "source") entry.members.push_back(m);
      out.members.push_back({text, place.line, place.column, std::move(entry)});
    }
    return out;
  }

  /// Nothing of another text: rows that `where` leaves out may hold one; of a reading it is a label without a value.
  std::optional<double> number(const CsvCell& cell) const {
    try {
      return file_->csv->number(cell, file_->decimal);
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  Node& document_;
  DataFiles& files_;
  Problems& problems_;
  std::optional<DataFile> file_;
};

} // namespace

void expand_set_points(Node& document, DataFiles& files, Problems& problems) {
  SetPoints(document, files, problems).expand();
}

} // namespace gumshoe::scenario
