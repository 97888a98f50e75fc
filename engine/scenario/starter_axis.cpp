#include "scenario/starter.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/units.h"
#include "math/senses.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {

namespace {

/// The label of alignments, each of which has quantities of its own; empty: there is none.
std::string alignment_of(const NamedColumns& labels) {
  const auto found = std::ranges::find(labels, ColumnRole::alignment, [](const auto& l) { return l.second->role; });
  return found == labels.end() ? "" : found->first;
}

/// A quantity that is fitted: one, or one of each alignment.
std::string fitted(const RecognisedData& data, const NamedColumns& labels, const std::string& unit) {
  const std::string zero = fmt::format("\"0 {}\"", unit);
  for (const auto& [name, c] : labels) {
    if (c->role != ColumnRole::alignment) continue;
    std::string all;
    std::set<std::string> known;
    for (const auto& row : data.csv.rows)
      if (const std::string& text = row[static_cast<std::size_t>(data.csv.find(c->name))].text;
          known.insert(text).second)
        all += fmt::format("{}{} = {}", all.empty() ? "" : ", ", toml_string(text), zero);
    return fmt::format("{{ estimated = true, by.{} = {{ {} }} }}", name, all);
  }
  return fmt::format("{{ estimated = true, value = {} }}", zero);
}

/// The reading, and other columns of its kind that are errors at the same positions: the channels of a laser. Where the
/// reading was guessed, those of the first such column's kind; where the user told it, those that the user told.
std::vector<const RecognisedColumn*> channels(const RecognisedData& data, const RecognisedColumn& position,
                                              const RecognisedColumn& reading) {
  const auto is_error = [&](const RecognisedColumn& c) {
    if (!c.number || c.gaps || (c.role != ColumnRole::other && c.role != ColumnRole::reading) || c.unit == "?" ||
        c.unit == "1" || counts_rows(c) || names_parts(c) || is_circumstance(c))
      return false;
    const std::string si_unit = units::si_unit_of(c.unit);
    const bool small = c.unit == "um" || c.unit == "nm" || c.unit == "arcsec" || c.unit == "urad";
    return (si_unit == "m" || si_unit == "rad") && (small || !was_set(data, c)) &&
           !measured_position(data, position, c);
  };
  if (!is_error(reading)) return {&reading};
  const bool guessed = reading.basis == Basis::place, told = reading.basis == Basis::user;
  std::vector<const RecognisedColumn*> out;
  for (const RecognisedColumn& c : data.columns) {
    if (&c != &reading && (!is_error(c) || (told && c.role != ColumnRole::reading))) continue;
    const RecognisedColumn& first = !guessed ? reading : out.empty() ? c : *out[0];
    if (units::convertible(c.unit, units::si_unit_of(first.unit))) out.push_back(&c);
  }
  return out;
}

/// The direction of positions that go up and down, as of a load that is put on and taken off.
std::optional<RecognisedColumn> both_ways(const RecognisedData& data, const RecognisedColumn& position) {
  std::vector<double> x;
  std::set<std::pair<double, double>> met;
  for (const auto& row : data.csv.rows) {
    const CsvCell& cell = row[static_cast<std::size_t>(data.csv.find(position.name))];
    if (!says_missing(cell.text)) x.push_back(data.csv.number(cell, data.decimal));
  }
  const auto way = senses(x);
  for (std::size_t from = 0, to = 0; from < x.size(); from = to) {
    while (to < x.size() && x[to] == x[from]) ++to;
    if (way[from] == way[to - 1]) met.emplace(x[from], way[from]); // it passed, and did not turn there
  }
  std::set<double> inner(x.begin(), x.end());
  if (inner.size() < 4) return std::nullopt;
  inner.erase(inner.begin());
  inner.erase(std::prev(inner.end()));
  const auto both = std::ranges::count_if(inner, [&](double v) {
    return met.contains({v, 1}) && met.contains({v, -1});
  });
  if (2 * static_cast<std::size_t>(both) < inner.size()) return std::nullopt;
  // Few turns: positions in any order turn at every other reading.
  std::size_t turns = 0;
  for (std::size_t i = 1; i < x.size(); ++i) turns += way[i] != way[i - 1];
  if (3 * turns > x.size()) return std::nullopt;
  RecognisedColumn out = position;
  out.take(ColumnRole::direction, Basis::cells, "as the positions go up and down");
  out.sense = true;
  return out;
}

/// Circumstances with a known unit, which vary: a feed, a humidity, and what else was set to a few values, as a radius;
/// and coordinates, whose unit the user knows.
NamedColumns circumstances(const RecognisedData& data, Names& names, const std::set<std::string>& used) {
  constexpr std::size_t few = 10;
  NamedColumns out;
  const auto set = [&](const RecognisedColumn& c) { return different(data, c) <= few && was_set(data, c); };
  for (const RecognisedColumn& c : data.columns)
    if (c.number && !c.gaps && c.role == ColumnRole::other && (c.unit != "?" || is_coordinate(c)) &&
        (is_circumstance(c) || set(c)) && !counts_rows(c) && !names_parts(c) && !used.contains(c.name) &&
        different(data, c) > 1)
      out.emplace_back(names.add(c.name), &c);
  return out;
}

/// A reading of the scenario and the quantities that are fitted to it.
struct Channel {
  const RecognisedColumn* column;
  std::string name, offset = {}, gain = {}, reversal = {}, eccentricity_x = {}, eccentricity_y = {}; ///< empty: none
};

/// What the model of an axis has.
struct AxisModel {
  bool measured;  ///< the readings are positions, and not their errors
  bool turns;     ///< its error comes back: no gain
  bool eccentric; ///< its alignments differ
  bool reversal;
  std::string reference; ///< from which positions count whose zero is no zero of their size, as 0 degC; empty: none
};

std::vector<Channel> named_channels(const std::vector<const RecognisedColumn*>& columns, const AxisModel& model,
                                    Names& names) {
  const bool several = columns.size() > 1;
  std::vector<Channel> out;
  for (const RecognisedColumn* c : columns)
    out.push_back({c, names.add(several ? c->name : model.measured ? "measured" : "deviation")});
  for (Channel& c : out) {
    const auto quantity = [&](bool fitted, const char* name) {
      return fitted ? names.add((several ? c.name + '_' : "") + name) : "";
    };
    c.offset = quantity(true, "offset");
    c.gain = quantity(!model.turns, "gain");
    c.reversal = quantity(model.reversal, "reversal");
    c.eccentricity_x = quantity(model.eccentric, "eccentricity_x");
    c.eccentricity_y = quantity(model.eccentric, "eccentricity_y");
  }
  return out;
}

std::string formula_of(const Channel& c, const AxisModel& model) {
  std::string out = (model.measured ? "position + " : "") + c.offset;
  if (model.eccentric)
    out += fmt::format(" + {} * cos(position) + {} * sin(position)", c.eccentricity_x, c.eccentricity_y);
  if (!model.turns)
    out += fmt::format(" + {} * {}", c.gain,
                       model.reference.empty() ? "position" : "(position - " + model.reference + ")");
  if (model.reversal) out += fmt::format(" + {} * direction", c.reversal);
  return out;
}

} // namespace

std::string starter_axis(const StarterData& data, const std::string& scenario) {
  const RecognisedData& found = data.found;
  const RecognisedColumn* const position = found.find(ColumnRole::position);
  const RecognisedColumn* reading = found.find(ColumnRole::reading);
  if (!position || !reading) require_readable(found);
  if (!position || !reading)
    throw InputError(found.csv.file + ": there is no column of readings", "numbers that were measured are needed",
                     "tell which it is: --role COLUMN=reading");
  require_numbers(found, *position, "positions");
  require_numbers(found, *reading, "readings");
  const std::optional<RecognisedColumn> way =
      found.find(ColumnRole::direction) ? std::nullopt : both_ways(found, *position);
  const RecognisedColumn* const direction = way ? &*way : found.find(ColumnRole::direction);
  const RecognisedColumn* const sd = uncertainty_of(found);
  const auto columns = channels(found, *position, *reading);
  if (std::ranges::find(columns, reading) == columns.end()) reading = columns[0];
  const bool measured = measured_position(found, *position, *reading);
  const bool turns = full_turn(found, *position); // its error comes back: no gain
  const std::string pos = unit_or(*position, "mm");
  const NamedColumns labels = labels_of(found);
  NamedColumns conditions{{"position", position}};
  if (direction) conditions.emplace_back("direction", direction);
  Names names{"position", "direction"};
  const std::string pos_difference = difference_unit_or(*position, "mm");
  const AxisModel model{measured, turns, turns && found.find(ColumnRole::alignment), direction != nullptr,
                        pos == pos_difference ? "" : names.add("reference")};
  const std::vector<Channel> all = named_channels(columns, model, names);
  std::set<std::string> used{position->name};
  for (const RecognisedColumn* c : columns) used.insert(c->name);
  if (direction) used.insert(direction->name);
  if (sd) used.insert(sd->name);
  NamedColumns measured_too;
  for (const auto& [own, c] : circumstances(found, names, used)) {
    used.insert(c->name);
    (was_set(found, *c) ? conditions : measured_too).emplace_back(own, c);
  }
  const std::string recorded = columns_of(found, names, used, "", measured_too);

  std::string out =
      fmt::format("# Question: which errors do the readings in {} show that {}{} do{} not explain?\n"
                  "#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is wrong.\n\n",
                  data.file, turns ? "an offset" : "a straight line", direction ? " and a reversal" : "",
                  direction ? "" : "es", scenario);
  out += fmt::format("schema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n[model.indications]\n",
                     toml_string(data.file));
  for (const Channel& c : all)
    out += line(c.name, toml_string(formula_of(c, model)),
                measured ? "guessed: the readings span what the positions span" : "guessed: the readings are errors");
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n";
  if (!model.reference.empty())
    out += line(model.reference, fmt::format("\"0 {}\"", pos), "offset holds here, not at 0 K");
  const std::string alignment = alignment_of(labels);
  const std::string comment = alignment.empty() ? "" : by_label_comment(alignment, "");
  for (const Channel& c : all) {
    // What is added to a temperature is a difference.
    const std::string difference = difference_unit_or(*c.column, "um");
    out += line(c.offset, fitted(found, labels, measured ? difference : unit_or(*c.column, "um")), comment);
    if (!turns)
      out +=
          line(c.gain, fitted(found, labels, units::quotient(measured ? pos_difference : difference, pos_difference)),
               comment);
    for (const std::string& axis : {c.eccentricity_x, c.eccentricity_y})
      if (!axis.empty()) out += line(axis, fitted(found, labels, difference), comment);
    if (direction)
      out += line(c.reversal, fmt::format("{{ estimated = true, value = \"0 {}\" }}", difference),
                  "half of the reversal error");
  }
  for (const Channel& c : all) {
    out += fmt::format("\n[indications.{}]\n", c.name) +
           line("readings", toml_string(c.column->name),
                c.column->why.empty() ? "guessed: an error at the positions" : "recognised " + c.column->why);
    out += noise_line(*c.column, c.column == reading ? sd : nullptr);
  }
  return out + "\n[trace]\n" + blocks_of(found, labels) + recorded;
}

} // namespace gumshoe::scenario
