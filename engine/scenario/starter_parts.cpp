#include "scenario/starter_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "scenario/starter_order.h"
#include "scenario/trace_options.h"

namespace gumshoe::scenario {

namespace {

/// "pos_mm", or a table of its map, clock or sense.
std::string column_text(const RecognisedColumn& c) {
  const std::string column =
      c.date.empty() ? toml_string(c.name) : fmt::format("[{}, {}]", toml_string(c.date), toml_string(c.name));
  if (c.sense) return fmt::format("{{ column = {}, sense = true }}", column);
  if (!c.clock.empty()) return fmt::format("{{ column = {}, clock = {} }}", column, toml_string(c.clock));
  if (c.words.empty() || c.number) return toml_string(c.name);
  std::string map;
  for (const auto& [word, sign] : c.words)
    map += fmt::format("{}{} = {}", map.empty() ? "" : ", ", toml_string(word), sign);
  return fmt::format("{{ column = {}, map = {{ {} }} }}", toml_string(c.name), map);
}

} // namespace

std::string line(const std::string& key, const std::string& value, const std::string& comment) {
  const std::string text = fmt::format("{} = {}", key, value);
  std::string one_line = comment; // a cell's text may have lines
  std::ranges::replace_if(
      one_line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return comment.empty() ? text + '\n' : fmt::format("{:<39} # {}\n", text, one_line);
}

bool is_named(const RecognisedColumn& c, std::string_view name) {
  auto words = words_of(c.name), wanted = words_of(std::string(name));
  const auto unit = words_of(c.unit);
  std::erase_if(words, [&](const std::string& w) {
    return std::ranges::find(unit, w) != unit.end() && std::ranges::find(wanted, w) == wanted.end();
  });
  return words == wanted;
}

namespace {

/// The texts of a column's cells that are no numbers: "\"\"", or a list.
std::string missing_of(const RecognisedData& data, const RecognisedColumn& c) {
  std::set<std::string> texts;
  for (const auto& row : data.csv.rows)
    if (const std::string& text = row[static_cast<std::size_t>(data.csv.find(c.name))].text; says_missing(text))
      texts.insert(toml_string(text));
  return texts.size() == 1 ? *texts.begin() : fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Whether two rows agree in all labels and conditions.
bool recur(const RecognisedData& data, const NamedColumns& labels, const NamedColumns& conditions) {
  std::set<std::vector<std::string>> known;
  return std::ranges::any_of(data.csv.rows, [&](const auto& row) {
    std::vector<std::string> key;
    for (const auto* columns : {&labels, &conditions})
      for (const auto& [name, c] : *columns) key.push_back(row[static_cast<std::size_t>(data.csv.find(c->name))].text);
    return !known.insert(std::move(key)).second;
  });
}

} // namespace

std::string data_section(const StarterData& data, const NamedColumns& labels, const NamedColumns& conditions,
                         const std::set<std::string>& used) {
  std::string out = "[data]\n" + line("file", toml_string(data.file), "several files as one: \"run_{run}.csv\"");
  if (!data.found.form.empty()) out += line("form", toml_string(data.found.form), "description of its lines");
  if (data.found.header > 0) out += line("header", std::to_string(data.found.header), "line of the column names");
  if (data.found.first_row > 0) out += line("first_row", std::to_string(data.found.first_row), "line of the first row");
  if (!data.found.delimiter.empty()) out += line("delimiter", toml_string(data.found.delimiter), "");
  if (data.found.decimal == ',') out += line("decimal", "\",\"", "");
  std::string names;
  for (const auto& [name, c] : labels)
    names += fmt::format("{}{} = {}", names.empty() ? "" : ", ", name, toml_string(c->name));
  if (!names.empty()) out += line("labels", "{ " + names + " }", "guessed: what tells repeated series apart");
  std::string where;
  for (const RecognisedColumn& c : data.found.columns)
    if (c.gaps && used.contains(c.name))
      where += fmt::format("{}{} = {{ not = {} }}", where.empty() ? "" : ", ", toml_string(c.name),
                           missing_of(data.found, c));
  for (const auto& [name, c] : labels)
    if (has_empty_cells(data.found, *c))
      where += fmt::format("{}{} = {{ not = \"\" }}", where.empty() ? "" : ", ", toml_string(c->name));
  if (recur(data.found, labels, conditions))
    out += line("repeats", "\"apart\"", "rows that agree in all this are readings of their own, in their order");
  if (!where.empty()) out += line("where", "{ " + where + " }", "rows without a number or a label are left out");
  out += "\n[data.units]\n";
  for (const RecognisedColumn& c : data.found.columns)
    if (c.number && c.unit != "1" && used.contains(c.name))
      out += line(toml_string(c.name), toml_string(c.unit),
                  c.unit == "?"    ? "the file does not say it: write the unit, such as \"mm\""
                  : c.unit_told    ? "as told"
                  : c.unit_guessed ? "guessed: temperatures of 10 to 45, or as the others"
                                   : "from its header");
  if (!conditions.empty()) out += "\n[data.conditions]\n";
  for (const auto& [name, c] : conditions)
    out += line(name, column_text(*c), "recognised " + (c->why.empty() ? "by its name" : c->why));
  return out;
}

namespace {

/// Of the numbers of a column, SI; in its own unit where that is not told.
double range(const RecognisedData& data, const RecognisedColumn& c) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  for (const auto& row : data.csv.rows) {
    if (says_missing(row[column].text)) continue;
    const double x = data.csv.number(row[column], data.decimal);
    low = std::min(low, x), high = std::max(high, x);
  }
  double scale = 1;
  if (c.unit != "?" && c.unit != "1")
    scale = units::to_si(1, c.unit, units::si_unit_of(c.unit), units::Kind::difference);
  return scale * (high - low);
}

} // namespace

bool full_turn(const RecognisedData& data, const RecognisedColumn& position) {
  return position.unit != "?" && units::si_unit_of(position.unit) == "rad" &&
         range(data, position) > 1.8 * std::numbers::pi;
}

bool measured_position(const RecognisedData& data, const RecognisedColumn& position, const RecognisedColumn& reading) {
  const auto kind = [](const RecognisedColumn& c) { return c.unit == "?" ? "m" : units::si_unit_of(c.unit); };
  if (kind(position) != kind(reading)) return false;
  const double share = range(data, reading) / range(data, position);
  return share > 0.5 && share < 2; // an axis errs by less than half of its travel
}

void require_readable(const RecognisedData& data) {
  for (const RecognisedColumn& c : data.columns) {
    if (const CsvCell* const cell = cell_with_unit(data, c))
      throw InputError(
          {{data.csv.at(*cell), fmt::format("the cells of the column '{}' are no numbers: '{}'", c.name, cell->text),
            "they hold their unit", "write numbers alone, and the unit in the column's name, as size (mm)"}});
    if (const auto odd = cells_that_are_no_number(data, c); !odd.empty() && c.clock.empty() && c.words.empty())
      throw InputError({{data.csv.at(*odd[0]),
                         fmt::format("the column '{}' has a cell that is no number: '{}'", c.name, odd[0]->text),
                         odd.size() == 1 ? "" : fmt::format("{} more of its cells are none", odd.size() - 1),
                         "leave such cells empty: their rows are left out"}});
  }
}

void require_numbers(const RecognisedData& data, const RecognisedColumn& c, const std::string& role) {
  if (c.number) return;
  const std::string remedy = fmt::format("tell another column: --role COLUMN={}", name(c.role));
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  for (const auto& row : data.csv.rows)
    if (!says_missing(row[column].text)) try {
        data.csv.number(row[column], data.decimal);
      } catch (const InputError& error) {
        Problem problem = error.problems().front();
        problem.why = fmt::format("the column '{}' has the {}", c.name, role);
        problem.remedy = "write numbers without signs between thousands, or " + remedy;
        throw InputError({problem});
      }
  throw InputError(fmt::format("{}: the column '{}' has too few numbers", data.csv.file, c.name), "it has the " + role,
                   remedy);
}

std::string by_label_comment(const std::string& label, const std::string& why) {
  return fmt::format("fitted for each {} by itself{}: what differs from one {} to the next is not judged", label,
                     why.empty() ? "" : ", " + why, label);
}

std::string unit_or(const RecognisedColumn& c, const char* otherwise) { return c.unit == "?" ? otherwise : c.unit; }

std::string difference_unit_or(const RecognisedColumn& c, const char* otherwise) {
  const std::string unit = unit_or(c, otherwise);
  return unit == "?" ? unit : units::difference_unit(unit, units::si_unit_of(unit));
}

std::string noise_line(const RecognisedColumn& reading, const RecognisedColumn* uncertainty) {
  if (uncertainty && uncertainty->number)
    return line("u", fmt::format("{{ column = {} }}", toml_string(uncertainty->name)),
                "recognised " + uncertainty->why);
  return line("# u", toml_string("0.2 " + unit_or(reading, "um")), "state the noise of a reading if you know it");
}

std::string blocks_of(const RecognisedData& data, const NamedColumns& labels) {
  std::vector<const RecognisedColumn*> columns;
  for (const auto& label : labels) columns.push_back(label.second);
  const std::vector<const RecognisedColumn*> sorted = sorted_by(data, columns);
  if (const auto* const label = sorted.size() > 1 ? nullptr : block_label(data, labels))
    return line("blocks", toml_string(label->first), "an effect should recur in each of them");
  if (data.csv.rows.size() < 12)
    return "# blocks = { count = 6 }                # too few rows for blocks; an effect should recur in each of "
           "them\n";
  if (!sorted.empty()) {
    std::vector<std::string> names;
    for (const RecognisedColumn* c : sorted) names.push_back(toml_string(c->name));
    return line("blocks", "{ count = 6, interleaved = true }",
                fmt::format("guessed: the rows are sorted by {}, of which a stretch would {}", fmt::join(names, ", "),
                            sorted.size() > 1 ? "hold a few" : "be an end")) +
           (data.find(ColumnRole::time) ? ""
                                        : line("order", toml_string(unknown_order),
                                               "guessed: leave it out if they were read in the order of the rows"));
  }
  return line("blocks", "{ count = 6 }", "guessed: no column tells four or more cycles apart");
}

std::string course_name(const RecognisedColumn& time) { return counts_rows(time) ? plain_name(time.name) : "time"; }

std::string columns_of(const RecognisedData& data, Names& names, std::set<std::string>& used, const std::string& order,
                       const NamedColumns& further) {
  const auto fits = [](const RecognisedColumn& c) {
    if (c.role == ColumnRole::time) return c.number || !c.clock.empty();
    return (c.role == ColumnRole::temperature && c.number) ||
           (c.role == ColumnRole::direction && (c.number || !c.words.empty()));
  };
  std::string first, others, ordered_by = order;
  const RecognisedColumn* timed = data.find(ColumnRole::time);
  for (const RecognisedColumn& c : data.columns) {
    if (!fits(c) || used.contains(c.name)) continue;
    if (c.role == ColumnRole::time) {
      if (!ordered_by.empty()) continue; // there is one time
      ordered_by = names.add(course_name(c));
      timed = &c;
      first = line(ordered_by, column_text(c), "recognised " + c.why);
    } else {
      others += line(names.add(c.name), column_text(c), "recognised " + c.why);
    }
    used.insert(c.name);
  }
  for (const auto& [name, c] : further) others += line(name, column_text(*c), "recorded with the readings");
  const auto restarts =
      ordered_by.empty() || !timed ? std::vector<const RecognisedColumn*>{} : restarted_by(data, *timed);
  // A time that goes on from the first reading to the last says more than the number of a block, and so does the order
  // of the rows of cycles, which follow one another at once unless a time says otherwise.
  if (!restarts.empty() || ordered_by.empty())
    for (const RecognisedColumn* c : numbered_blocks(data))
      if (!restarts.empty() || c->role != ColumnRole::cycle)
        others += line(names.add(c->name + "_number"), column_text(*c),
                       fmt::format("what changes from one {} to the next", c->name));
  if (ordered_by.empty())
    for (const RecognisedColumn* c : days_in_order(data))
      others += line(names.add(c->name + "_time"), column_text(*c), "what changes from one day to the next");
  const std::string columns = first + others;
  std::string in_order = ordered_by.empty() ? "" : line("order", toml_string(ordered_by), "");
  if (!restarts.empty()) {
    std::vector<std::string> blocks;
    for (const RecognisedColumn* c : restarts) blocks.push_back(c->name);
    in_order = line("# order", toml_string(ordered_by),
                    fmt::format("it starts anew with each {}: the readings are in the order of the rows",
                                fmt::join(blocks, " or ")));
  }
  return in_order + (columns.empty() ? "" : "\n[trace.columns]\n" + columns);
}

} // namespace gumshoe::scenario
