#include "scenario/starter_parts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"

namespace gumshoe::scenario {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + '"';
}

namespace {

/// Letters of European languages as one spells them without their marks: Kuehlmittel, temperature (from température).
std::string in_ascii(std::string text) {
  static constexpr std::pair<std::string_view, std::string_view> letters[] = {
      {"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"}, {"Ü", "Ue"}, {"ß", "ss"}, {"é", "e"},
      {"è", "e"},  {"ê", "e"},  {"à", "a"},  {"â", "a"},  {"á", "a"},  {"í", "i"},  {"ó", "o"},  {"ú", "u"},
      {"ñ", "n"},  {"ç", "c"},  {"å", "a"},  {"ø", "o"},  {"æ", "ae"}, {"É", "E"},  {"Å", "A"},  {"Ø", "O"},
      {"Æ", "Ae"}, {"č", "c"},  {"š", "s"},  {"ž", "z"},  {"ł", "l"},  {"ř", "r"},  {"ě", "e"},  {"ý", "y"}};
  for (const auto& [marked, plain] : letters)
    for (std::size_t at = text.find(marked); at != std::string::npos; at = text.find(marked, at + plain.size()))
      text.replace(at, marked.size(), plain);
  return text;
}

} // namespace

std::string plain_name(const std::string& text) {
  std::string out;
  for (const std::string& word : words_of(in_ascii(text))) out += (out.empty() ? "" : "_") + word;
  std::erase_if(out, [](unsigned char c) { return c >= 0x80; });
  return out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0 ? "column_" + out : out;
}

namespace {

/// "pos_mm", or a table of its map, clock or sense.
std::string column_text(const RecognisedColumn& c) {
  const std::string column = c.date.empty() ? quoted(c.name) : fmt::format("[{}, {}]", quoted(c.date), quoted(c.name));
  if (c.sense) return fmt::format("{{ column = {}, sense = true }}", column);
  if (!c.clock.empty()) return fmt::format("{{ column = {}, clock = {} }}", column, quoted(c.clock));
  if (c.words.empty() || c.number) return quoted(c.name);
  std::string map;
  for (const auto& [word, sign] : c.words) map += fmt::format("{}{} = {}", map.empty() ? "" : ", ", quoted(word), sign);
  return fmt::format("{{ column = {}, map = {{ {} }} }}", quoted(c.name), map);
}

} // namespace

std::string line(const std::string& key, const std::string& value, const std::string& comment) {
  const std::string text = fmt::format("{} = {}", key, value);
  return comment.empty() ? text + '\n' : fmt::format("{:<39} # {}\n", text, comment);
}

bool is_named(const RecognisedColumn& c, std::string_view name) {
  auto words = words_of(c.name), wanted = words_of(std::string(name));
  const auto unit = words_of(c.unit);
  std::erase_if(words, [&](const std::string& w) {
    return std::ranges::find(unit, w) != unit.end() && std::ranges::find(wanted, w) == wanted.end();
  });
  return words == wanted;
}

NamedColumns labels_of(const RecognisedData& data) {
  NamedColumns out;
  for (const RecognisedColumn& c : data.columns) {
    const std::size_t n = different(data, c);
    const bool recurs =
        (!c.number || names_parts(c)) && c.clock.empty() && c.words.empty() && n > 1 && 2 * n <= data.csv.rows.size();
    if (c.role == ColumnRole::cycle || c.role == ColumnRole::alignment || (c.role == ColumnRole::other && recurs))
      out.emplace_back(plain_name(c.name), &c);
  }
  return out;
}

namespace {

/// The texts of a column's cells that are no numbers: "\"\"", or a list.
std::string missing_of(const RecognisedData& data, const RecognisedColumn& c) {
  std::set<std::string> texts;
  for (const auto& row : data.csv.rows)
    if (const std::string& text = row[static_cast<std::size_t>(data.csv.find(c.name))].text; says_missing(text))
      texts.insert(quoted(text));
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
  std::string out = "[data]\n" + line("file", quoted(data.file), "several files as one: \"run_{run}.csv\"");
  if (!data.found.form.empty()) out += line("form", quoted(data.found.form), "description of its lines");
  if (data.found.header > 0) out += line("header", std::to_string(data.found.header), "line of the column names");
  if (data.found.first_row > 0) out += line("first_row", std::to_string(data.found.first_row), "line of the first row");
  if (!data.found.delimiter.empty()) out += line("delimiter", quoted(data.found.delimiter), "");
  if (data.found.decimal == ',') out += line("decimal", "\",\"", "");
  std::string names;
  for (const auto& [name, c] : labels)
    names += fmt::format("{}{} = {}", names.empty() ? "" : ", ", name, quoted(c->name));
  if (!names.empty()) out += line("labels", "{ " + names + " }", "guessed: what tells repeated series apart");
  std::string where;
  for (const RecognisedColumn& c : data.found.columns)
    if (c.gaps && used.contains(c.name))
      where +=
          fmt::format("{}{} = {{ not = {} }}", where.empty() ? "" : ", ", quoted(c.name), missing_of(data.found, c));
  if (recur(data.found, labels, conditions))
    out += line("repeats", "\"apart\"", "rows that agree in all this are readings of their own, in their order");
  if (!where.empty()) out += line("where", "{ " + where + " }", "rows without a number are left out");
  out += "\n[data.units]\n";
  for (const RecognisedColumn& c : data.found.columns)
    if (c.number && c.unit != "1" && used.contains(c.name))
      out += line(quoted(c.name), quoted(c.unit),
                  c.unit == "?"    ? "the file does not say it: write the unit, such as \"mm\""
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

void require_numbers(const RecognisedData& data, const RecognisedColumn& c, const std::string& role) {
  if (c.number) return;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  for (const auto& row : data.csv.rows)
    if (!says_missing(row[column].text)) try {
        data.csv.number(row[column], data.decimal);
      } catch (const InputError& error) {
        Problem problem = error.problems().front();
        problem.why = fmt::format("the column '{}' has the {}", c.name, role);
        problem.remedy = fmt::format(
            "write numbers without signs between thousands, or tell another column: --role COLUMN={}", name(c.role));
        throw InputError({problem});
      }
}

std::string unit_or(const RecognisedColumn& c, const char* otherwise) { return c.unit == "?" ? otherwise : c.unit; }

std::string noise_line(const RecognisedColumn& reading, const RecognisedColumn* uncertainty) {
  if (uncertainty && uncertainty->number)
    return line("u", fmt::format("{{ column = {} }}", quoted(uncertainty->name)), "recognised " + uncertainty->why);
  return line("# u", quoted("0.2 " + unit_or(reading, "um")), "state the noise of a reading if you know it");
}

namespace {

/// Whether the words of a column alternate: each part was measured again after others.
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

} // namespace

std::string blocks_of(const RecognisedData& data, const NamedColumns& labels) {
  for (const bool cycle : {true, false}) // what counts cycles, before other words that recur
    for (const auto& [name, c] : labels)
      if ((c->role == ColumnRole::cycle || c->role == ColumnRole::alignment) == cycle && different(data, *c) >= 4 &&
          (cycle || !comes_back(data, *c)))
        return line("blocks", quoted(name), "an effect should recur in each of them");
  if (data.csv.rows.size() < 12)
    return "# blocks = { count = 6 }                # too few rows for blocks; an effect should recur in each of "
           "them\n";
  return line("blocks", "{ count = 6 }", "guessed: no column tells four or more cycles apart");
}

std::string course_name(const RecognisedColumn& time) { return counts_rows(time) ? plain_name(time.name) : "time"; }

std::string columns_of(const RecognisedData& data, std::set<std::string>& used, const NamedColumns& further) {
  std::string out;
  bool ordered = false;
  for (const RecognisedColumn& c : data.columns) {
    if (c.role != ColumnRole::time && c.role != ColumnRole::temperature && c.role != ColumnRole::direction) continue;
    if (c.role == ColumnRole::time && !c.number && c.clock.empty()) continue;
    if ((c.role == ColumnRole::time && ordered) || used.contains(c.name)) continue;
    used.insert(c.name);
    if (c.role == ColumnRole::time) {
      ordered = true;
      out = line("order", quoted(course_name(c)), "") + "\n[trace.columns]\n" +
            line(course_name(c), column_text(c), "recognised " + c.why) + out;
    } else {
      out += line(plain_name(c.name), column_text(c), "recognised " + c.why);
    }
  }
  for (const auto& [name, c] : further) out += line(name, column_text(*c), "recorded with the readings");
  return ordered || out.empty() ? out : "\n[trace.columns]\n" + out;
}

} // namespace gumshoe::scenario
