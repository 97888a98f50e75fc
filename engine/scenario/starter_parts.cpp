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

/// Whether two columns divide the rows alike, as the number of a point and its position.
bool divide_alike(const RecognisedData& data, const RecognisedColumn& a, const RecognisedColumn& b) {
  std::set<std::pair<std::string_view, std::string_view>> pairs;
  for (const auto& row : data.csv.rows)
    pairs.emplace(row[static_cast<std::size_t>(data.csv.find(a.name))].text,
                  row[static_cast<std::size_t>(data.csv.find(b.name))].text);
  return pairs.size() == different(data, a) && pairs.size() == different(data, b);
}

/// Whether the words or the role of a column tell readings apart.
bool tells_apart(const RecognisedData& data, const RecognisedColumn& c) {
  const std::size_t n = different(data, c);
  if (c.role == ColumnRole::cycle || c.role == ColumnRole::alignment) return n > 1;
  if (c.role == ColumnRole::label || names_levels(data, c)) return true;
  return c.role == ColumnRole::other && (!c.number || names_parts(c)) && c.clock.empty() && c.words.empty() && n > 1 &&
         2 * n <= data.csv.rows.size();
}

/// Number of rows with a reading in which the column is empty.
std::size_t empty_cells(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const RecognisedColumn* const reading = data.find(ColumnRole::reading);
  return static_cast<std::size_t>(std::ranges::count_if(data.csv.rows, [&](const auto& row) {
    return row[column].text.empty() &&
           !(reading && says_missing(row[static_cast<std::size_t>(data.csv.find(reading->name))].text));
  }));
}

/// Whether so many rows have no text in the column that it may be one of remarks.
bool mostly_empty(const RecognisedData& data, const RecognisedColumn& c) {
  return 10 * empty_cells(data, c) > data.csv.rows.size();
}

} // namespace

bool comes_back(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  std::set<std::string> left;
  std::string here;
  for (const auto& row : data.csv.rows) {
    const std::string& text = row[column].text;
    if (text == here) continue;
    if (left.contains(text)) return true;
    left.insert(here);
    here = text;
  }
  return false;
}

namespace {

/// The label with enough values for blocks; null: there is none.
const NamedColumns::value_type* block_label(const RecognisedData& data, const NamedColumns& labels) {
  for (const bool cycle : {true, false}) // what counts cycles, before other words that recur
    for (const auto& label : labels) {
      const RecognisedColumn& c = *label.second;
      if ((c.role == ColumnRole::cycle || c.role == ColumnRole::alignment) == cycle && different(data, c) >= 4 &&
          (cycle || !comes_back(data, c)))
        return &label;
    }
  return nullptr;
}

/// "line 5", or with several files "b.csv, line 5".
std::string line_of(const Csv& csv, const CsvCell& cell) {
  return fmt::format("{}line {}", csv.parts.empty() ? "" : csv.at(cell).file + ", ", cell.line);
}

/// The cells that keep a column from being one of numbers, in words; empty if there are none.
std::string odd_cells(const RecognisedData& data, const RecognisedColumn& c) {
  const std::vector<const CsvCell*> odd = cells_that_are_no_number(data, c);
  if (odd.empty()) return {};
  std::string out = fmt::format("'{}' in {} is not a number", odd[0]->text, line_of(data.csv, *odd[0]));
  if (odd.size() > 1) out += fmt::format(", nor are {} more of its cells", odd.size() - 1);
  return out;
}

/// Why a column of uncertainties is none.
std::string not_above_zero(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const auto bad = std::ranges::find_if(data.csv.rows, [&](const auto& row) {
    return !says_missing(row[column].text) && !(data.csv.number(row[column], data.decimal) > 0);
  });
  return bad == data.csv.rows.end() ? "it is not above 0 in every row"
                                    : fmt::format("it is not above 0 in every row: '{}' in {}", (*bad)[column].text,
                                                  line_of(data.csv, (*bad)[column]));
}

/// Whether a column has numbers of a unit, but for misprints: it tells nothing apart. Runs 1, 2 and 2b do.
bool is_misprinted(const RecognisedData& data, const RecognisedColumn& c) {
  std::string rest;
  const bool has_unit = (c.unit != "1" && c.unit != "?") || !unit_in(c.name, rest).empty();
  return has_unit && !odd_cells(data, c).empty();
}

} // namespace

bool has_empty_cells(const RecognisedData& data, const RecognisedColumn& label) { return empty_cells(data, label) > 0; }

namespace {

/// The column before it, or one with a role, that divides the rows alike and shares a word of its name, as part and
/// part_id do, or of numbers the position; null: there is none. An operator with a machine of his own is no other name.
const RecognisedColumn* other_name_of(const RecognisedData& data, const RecognisedColumn& c) {
  if (c.role != ColumnRole::other) return nullptr;
  const auto is = [&](const RecognisedColumn& other) {
    const bool known = other.role == ColumnRole::position || other.role == ColumnRole::cycle ||
                       other.role == ColumnRole::alignment || other.role == ColumnRole::label ||
                       (&other < &c && tells_apart(data, other));
    const auto words = words_of(other.name);
    const bool shared = std::ranges::any_of(
        words_of(c.name), [&](const std::string& w) { return std::ranges::find(words, w) != words.end(); });
    return &other != &c && known && (shared || (c.number && other.role == ColumnRole::position)) &&
           divide_alike(data, c, other);
  };
  const auto one = std::ranges::find_if(data.columns, is);
  return one == data.columns.end() ? nullptr : &*one;
}

} // namespace

NamedColumns labels_of(const RecognisedData& data, const std::set<std::string>& used) {
  NamedColumns out;
  for (const RecognisedColumn& c : data.columns)
    if (tells_apart(data, c) && !mostly_empty(data, c) && !is_misprinted(data, c) && !other_name_of(data, c) &&
        !(used.contains(c.name) && names_levels(data, c)))
      out.emplace_back("", &c);
  Names names{"reading", "row"};                       // labels that mean something else in a scenario
  if (!block_label(data, out)) names.reserve("block"); // stretches
  for (auto& [name, c] : out) name = names.add(c->name);
  return out;
}

const RecognisedColumn* uncertainty_of(const RecognisedData& data) {
  const RecognisedColumn* const sd = data.find(ColumnRole::uncertainty);
  if (!sd || !sd->number) return nullptr;
  const auto column = static_cast<std::size_t>(data.csv.find(sd->name));
  const bool above_zero = std::ranges::all_of(data.csv.rows, [&](const auto& row) {
    return says_missing(row[column].text) || data.csv.number(row[column], data.decimal) > 0;
  });
  return above_zero ? sd : nullptr;
}

std::string why_not_used(const RecognisedData& data, const RecognisedColumn& c) {
  const bool never_changes = data.csv.rows.size() > 1 && different(data, c) == 1;
  if (never_changes && (c.role == ColumnRole::cycle || c.role == ColumnRole::alignment || c.why.empty()))
    return "it is the same in every row";
  if (tells_apart(data, c) && mostly_empty(data, c))
    return "it is empty in more than a tenth of the rows, and a label is in none";
  if (const RecognisedColumn* const other = tells_apart(data, c) ? other_name_of(data, c) : nullptr)
    return fmt::format("it divides the rows as {} does", other->name);
  const RecognisedColumn* const first = data.find(c.role);
  if (c.role == ColumnRole::time && first && first != &c && first->date != c.name) return "the time is " + first->name;
  if (c.role == ColumnRole::uncertainty && first == &c && !uncertainty_of(data))
    if (c.number) return not_above_zero(data, c);
  if (const CsvCell* const cell = cell_with_unit(data, c))
    return fmt::format("its cells hold their unit, as '{}': write numbers alone, and the unit in the column's name",
                       cell->text);
  if (std::string odd = odd_cells(data, c); !odd.empty() && c.words.empty()) return odd;
  if (!c.number && c.words.empty() &&
      (c.role == ColumnRole::temperature || c.role == ColumnRole::direction || c.role == ColumnRole::uncertainty))
    return "not all of its cells are numbers";
  return c.why;
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
                fmt::format("guessed: the rows are sorted by {}, of which a stretch would be {}",
                            fmt::join(names, ", "), sorted.size() > 1 ? "a few" : "an end")) +
           line("order", toml_string(unknown_order),
                "guessed: leave it out if they were read in the order of the rows");
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
