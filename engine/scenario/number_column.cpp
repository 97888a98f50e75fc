#include "scenario/number_column.h"

#include <algorithm>
#include <ranges>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/clock.h"
#include "math/senses.h"
#include "scenario/column_words.h"

namespace gumshoe::scenario {
namespace {

constexpr double day = 86400;

} // namespace

Node column_table(const Node& node) {
  if (node.kind != Node::Kind::text) return node;
  Node out;
  out.line = node.line;
  out.column = node.column;
  out.members = {{"column", node.line, node.column, node}};
  return out;
}

std::vector<Key> number_column_keys() {
  return {{"column", shape::texts(),
           "column name in the first row of the file; of a clock time also two, date and time", true},
          {"unit", shape::text(), "unit of the numbers in the column; default: that of [data], or a plain number"},
          {"map", shape::map(shape::reference("measure")), "word = number: what the words in the column stand for"},
          {"clock", shape::text(),
           "the column holds clock times, which become seconds since the first: \"iso\", \"excel\" (days), or a "
           "pattern such as "
           "\"%d.%m.%Y %H:%M:%S\""},
          {"since", shape::text(),
           "of a clock: the time from which seconds count, as the column writes it; default: the first"},
          {"sense", shape::flag(),
           "the way the numbers in the column go from row to row: 1 up, -1 down; for readings that a path up and down "
           "gave, without a column for its direction"}};
}

Shape number_column_shape() { return shape::any_of({shape::text(), shape::table(number_column_keys())}); }

std::map<std::string, std::string> stated_units(const Node* data) {
  std::map<std::string, std::string> out;
  if (const Node* units = data ? find_member(*data, "units") : nullptr)
    for (const Member& m : units->members)
      if (m.value.kind == Node::Kind::text) out[m.key] = m.value.text;
  return out;
}

std::string unit_of_column(const Node& node, const std::map<std::string, std::string>& units) {
  if (find_member(node, "clock")) return "s";
  if (find_member(node, "sense")) return "1";
  if (const Node* unit = find_member(node, "unit"); unit && unit->kind == Node::Kind::text) return unit->text;
  if (const Node* map = find_member(node, "map"))
    for (const Member& m : map->members)
      if (m.value.kind == Node::Kind::text) try {
          return units::parse(m.value.text).unit;
        } catch (const InputError&) { // told where the map is read
        }
  const Node* const column = node.kind == Node::Kind::text ? &node : find_member(node, "column");
  const auto known = column ? units.find(column->text) : units.end();
  return known == units.end() ? "" : known->second;
}

std::optional<NumberColumn> NumberColumn::read(Table& parent, const std::string& key, const DataFile& file,
                                               const Dimension& dimension) {
  const Node* const node = parent.find(key);
  if (!node) return std::nullopt;
  if (node->kind == Node::Kind::integer || node->kind == Node::Kind::real) {
    parent.refuse_key(key, fmt::format("the name of a column is expected, not {}", describe(node->kind)), "",
                      "put it in quotes; a value that all rows share stands in [conditions]");
    return std::nullopt;
  }
  const Node stated = column_table(*node);
  auto table = as_table(stated, parent.path(key), parent.problems());
  if (!table) return std::nullopt;
  table->declare(number_column_keys());
  const std::size_t problems = parent.problems().size();
  NumberColumn out(file, dimension);
  out.path_ = parent.path(key);
  const bool found = out.read_columns(*table);
  out.unit_ = unit_of_column(stated, file.units);
  const bool of_numbers = !table->has("clock") && !table->has("sense") && !table->has("map");
  const bool checked = of_numbers && !out.unit_.empty();
  if (table->has("clock"))
    out.read_clock(*table);
  else if (table->has("sense"))
    out.read_sense(*table);
  else if ((found || !out.unit_.empty()) && out.read_unit(*table) &&
           table->has("map")) // of no column the unit is unknown
    out.read_map(*table);
  if (table->has("since") && !table->has("clock"))
    table->refuse_key("since", "given without clock", "seconds count from a clock time", "leave it out");
  for (const char* other : {"unit", "map"}) table->find(other);
  table->refuse_unknown();
  if (!found || parent.problems().size() != problems) return std::nullopt;
  if (checked) note_other_unit(file, out.name_, out.unit_, out.si_unit());
  return out;
}

bool NumberColumn::read_columns(Table& table) {
  if (!table.require("column", "column = \"...\"")) return false;
  const std::vector<std::string> names = table.texts("column");
  if (names.empty() || (names.size() > 1 && !table.has("clock"))) {
    table.refuse_key("column", "one column is expected", "only a clock time may stand in two", "column = \"...\"");
    return false;
  }
  name_ = names.front();
  for (const std::string& name : names) {
    const int column = file_.csv->find(name);
    if (column < 0)
      table.refuse_key("column", fmt::format("'{}' has no column '{}'", file_.csv->file, name), "",
                       did_you_mean(name, file_.csv->names()));
    else
      columns_.push_back(static_cast<std::size_t>(column));
  }
  return columns_.size() == names.size();
}

bool NumberColumn::read_unit(Table& table) {
  const bool stated = !unit_.empty(), words = table.has("map");
  if (!stated) unit_ = "1";
  const Node* const own = table.find("unit");
  const Node& at = own ? *own : table.node();
  if (own && own->kind != Node::Kind::text) return table.text("unit").has_value();
  if (unknown_unit(at, table.path("unit"), unit_, name_, table.problems())) return false;
  std::string& si_unit = dimension_.si_unit;
  if (si_unit.empty()) {
    const auto found = read_si_unit(at, table.path("unit"), unit_, table.problems());
    si_unit = found.value_or("1");
    return found.has_value();
  }
  if (!stated && !words && si_unit != "1") {
    table.add(fmt::format("{} is missing", table.path("unit")), "numbers in a column carry no unit", "unit = \"mm\"");
    return false;
  }
  if (words || units::convertible(unit_, si_unit)) return true;
  try {
    units::to_si(0, unit_, si_unit);
  } catch (const InputError& error) {
    table.problems().add(at, table.path("unit"), error);
  }
  return false;
}

void NumberColumn::read_map(Table& table) {
  auto map = table.table("map");
  if (!map) return;
  for (const Member& m : map->members())
    if (const auto value = read_measure(m.value, map->path(m.key), dimension_, map->problems())) words_[m.key] = *value;
  if (map->node().members.empty()) map->refuse("no word is named", "", "map = { fwd = 1, bwd = -1 }");
}

void NumberColumn::read_clock(Table& table) {
  for (const char* other : {"unit", "map"})
    if (table.has(other))
      table.refuse_key(other, "given together with clock", "clock times become seconds", "leave it out");
  unit_ = "s";
  const auto pattern = table.text("clock");
  if (!dimension_.si_unit.empty() && dimension_.si_unit != "s")
    table.refuse_key("clock", fmt::format("a time is not {}", units::kind_name(dimension_.si_unit)),
                     "clock times become seconds");
  dimension_.si_unit = "s";
  if (!pattern) return;
  try {
    const ClockFormat checked(*pattern);
    if (const auto since = table.text("since"); since && !checked.parse(*since))
      table.refuse_key("since", fmt::format("'{}' is not a clock time", *since),
                       fmt::format("it is read as \"{}\"", *pattern), fmt::format("since = \"{}\"", checked.example()));
    else
      since_ = since.value_or("");
  } catch (const InputError& error) {
    table.problems().add(*table.find("clock"), table.path("clock"), error);
  }
  clock_ = *pattern;
}

void NumberColumn::read_sense(Table& table) {
  for (const char* other : {"unit", "map"})
    if (table.has(other)) table.refuse_key(other, "given together with sense", "a sense is 1 or -1", "leave it out");
  unit_ = "1";
  if (!dimension_.si_unit.empty() && dimension_.si_unit != "1")
    table.refuse_key("sense", fmt::format("a sense is not {}", units::kind_name(dimension_.si_unit)), "it is 1 or -1");
  dimension_.si_unit = "1";
  sense_ = table.boolean("sense").value_or(false);
  if (table.has("sense") && !sense_) table.refuse_key("sense", "false says nothing", "", "leave it out");
}

std::string NumberColumn::text_at(std::size_t row) const {
  std::string text;
  for (const std::size_t c : columns_) text += (text.empty() ? "" : " ") + file_.csv->rows[row][c].text;
  return text;
}

std::vector<std::optional<double>> NumberColumn::values(const std::vector<std::size_t>& rows,
                                                        Problems& problems) const {
  if (!clock_.empty()) return clock_values(rows, problems);
  if (sense_) return sense_values(rows, problems);
  if (words_.empty() && no_numbers(rows, problems)) return std::vector<std::optional<double>>(rows.size());
  std::vector<std::optional<double>> out;
  std::set<std::string> told;
  for (const std::size_t row : rows) {
    const CsvCell& cell = file_.csv->rows[row][columns_.front()];
    if (words_.empty() && says_missing(cell.text)) {
      out.emplace_back();
      if (told.insert(cell.text).second) refuse_missing(cell.text, rows, problems);
      continue;
    }
    if (words_.empty()) {
      out.push_back(read_cell(file_, cell, name_, unit_, dimension_, problems));
      continue;
    }
    const auto word = words_.find(cell.text);
    out.push_back(word == words_.end() ? std::nullopt : std::optional(word->second));
    if (word != words_.end() || !told.insert(cell.text).second) continue;
    std::vector<std::string> known;
    for (const auto& [text, value] : words_) known.push_back(text);
    problems.add({file_.csv->at(cell), fmt::format("'{}' has no number in {}.map", cell.text, path_),
                  fmt::format("column '{}': it has {}", name_, fmt::join(known, ", ")), "add the word to the map"});
  }
  return out;
}

/// All cells of a column that say alike that there is no number: one problem.
void NumberColumn::refuse_missing(const std::string& text, const std::vector<std::size_t>& rows,
                                  Problems& problems) const {
  constexpr std::size_t listed = 3;
  std::vector<const CsvCell*> cells;
  for (const std::size_t row : rows)
    if (const CsvCell& cell = file_.csv->rows[row][columns_.front()]; cell.text == text) cells.push_back(&cell);
  std::vector<int> lines;
  for (std::size_t i = 1; i < cells.size() && i <= listed; ++i) lines.push_back(cells[i]->line);
  std::string where = fmt::format("column '{}'", name_);
  if (!lines.empty())
    where += fmt::format("; so {} line{} {}", lines.size() == 1 ? "has" : "have", lines.size() == 1 ? "" : "s",
                         fmt::join(lines, ", "));
  if (cells.size() > listed + 1) where += fmt::format(" and {} more", cells.size() - listed - 1);
  problems.add({file_.csv->at(*cells.front()), fmt::format("'{}' is not a number", text), where,
                fmt::format("leave such rows out: where = {{ \"{}\" = {{ not = \"{}\" }} }}", name_, text)});
}

bool NumberColumn::no_numbers(const std::vector<std::size_t>& rows, Problems& problems) const {
  if (rows.empty()) return false;
  std::vector<std::string> texts;
  for (const std::size_t row : rows) texts.push_back(file_.csv->rows[row][columns_.front()].text);
  const CsvCell& first = file_.csv->rows[rows.front()][columns_.front()];
  if (const std::string form = clock_form(texts); !form.empty()) {
    problems.add({file_.csv->at(first),
                  fmt::format("'{}' is a clock time, and {} is read as numbers", first.text, path_), "",
                  fmt::format("clock = \"{}\" in {}: seconds since the first", form, path_)});
    return true;
  }
  const auto words = signs({texts.begin(), texts.end()});
  if (words.empty() || std::ranges::any_of(words, [](const auto& w) { return w.first.ends_with('1'); })) return false;
  std::vector<std::string> map;
  for (const auto& [text, sign] : words) map.push_back(fmt::format("\"{}\" = {}", text, sign));
  problems.add({file_.csv->at(first), fmt::format("'{}' is a word, and {} is read as numbers", first.text, path_), "",
                fmt::format("map = {{ {} }} in {}", fmt::join(map, ", "), path_)});
  return true;
}

std::vector<std::optional<double>> NumberColumn::sense_values(const std::vector<std::size_t>& rows,
                                                              Problems& problems) const {
  std::vector<double> numbers;
  for (const std::size_t row : rows) {
    const auto x = read_cell(file_, file_.csv->rows[row][columns_.front()], name_, "1", {"1"}, problems);
    if (!x) return std::vector<std::optional<double>>(rows.size());
    numbers.push_back(*x);
  }
  const auto way = senses(numbers);
  return {way.begin(), way.end()};
}

std::vector<std::optional<double>> NumberColumn::clock_values(const std::vector<std::size_t>& rows,
                                                              Problems& problems) const {
  const ClockFormat format(clock_);
  std::vector<std::optional<Moment>> moments;
  std::optional<Moment> zero = since_.empty() ? std::nullopt : format.parse(since_), first, last;
  std::string earliest;
  std::int64_t days = 0;
  for (const std::size_t row : rows) {
    const CsvCell& cell = file_.csv->rows[row][columns_.front()];
    auto moment = format.parse(text_at(row));
    if (!moment)
      problems.add({file_.csv->at(cell), fmt::format("'{}' is not a clock time of {}", text_at(row), path_),
                    fmt::format("column '{}': it is read as \"{}\", such as {}", name_, clock_, format.example()),
                    "correct the cell or the form"});
    if (moment && last && moment->zoned != last->zoned)
      problems.add({file_.csv->at(cell), "clock times with and without a zone stand in one column",
                    "the time between them is unknown", "state the zone everywhere or nowhere"});
    moments.push_back(moment);
    if (!moment) continue;
    if (!format.has_date() && last && moment->since(*last) < -day / 2) days += static_cast<std::int64_t>(day);
    last = moment;
    moments.back()->seconds += days;
    if (first && moments.back()->since(*first) >= 0) continue;
    first = moments.back();
    earliest = text_at(row);
  }
  if (zero && first && zero->zoned != first->zoned)
    problems.add({file_.csv->at(file_.csv->rows[rows.front()][columns_.front()]),
                  fmt::format("{}.since: '{}' has {} zone, and the column {}", path_, since_, zero->zoned ? "a" : "no",
                              zero->zoned ? "none" : "one"),
                  "the time between them is unknown", "write it as the column writes its times"});
  if (!zero) {
    zero = first;
    if (first && file_.files) file_.files->count_since(path_, earliest);
  }
  std::vector<std::optional<double>> out;
  for (const auto& moment : moments) out.push_back(moment ? std::optional(moment->since(*zero)) : std::nullopt);
  return out;
}

} // namespace gumshoe::scenario
