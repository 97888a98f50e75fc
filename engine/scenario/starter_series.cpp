#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "scenario/starter_order.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {
namespace {

/// The reading, and other columns of numbers that were measured: no circumstances, and not set. Without names.
NamedColumns readings_of(const RecognisedData& data) {
  NamedColumns out;
  for (const RecognisedColumn& c : data.columns)
    if (const bool told = c.role == ColumnRole::reading && c.basis == Basis::user;
        c.number && (told || (!counts_rows(c) && !names_parts(c))) &&
        (c.role == ColumnRole::reading ||
         (c.role == ColumnRole::other && c.basis != Basis::user && !was_set(data, c) && !is_circumstance(c))))
      out.emplace_back("", &c);
  return out;
}

/// The readings of a column by the text in another.
std::map<std::string, std::vector<double>> by_text(const RecognisedData& data, const RecognisedColumn& reading,
                                                   const RecognisedColumn& text) {
  const auto y = static_cast<std::size_t>(data.csv.find(reading.name)),
             at = static_cast<std::size_t>(data.csv.find(text.name));
  std::map<std::string, std::vector<double>> out;
  for (const auto& row : data.csv.rows)
    if (!says_missing(row[y].text)) out[row[at].text].push_back(data.csv.number(row[y], data.decimal));
  return out;
}

/// Whether each part has a value of its own: parts differ ten times as much as readings of one part, such as tools by
/// their lengths.
bool differ(const std::map<std::string, std::vector<double>>& parts) {
  const auto mean = [](const std::vector<double>& y) {
    return std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  };
  const auto squares = [&](const std::vector<double>& y) {
    const double m = mean(y);
    return std::accumulate(y.begin(), y.end(), 0.0, [&](double sum, double x) { return sum + (x - m) * (x - m); });
  };
  std::vector<double> means;
  double within = 0, readings = 0;
  for (const auto& [part, y] : parts) {
    means.push_back(mean(y));
    within += squares(y), readings += static_cast<double>(y.size());
  }
  const double parts_n = static_cast<double>(parts.size());
  constexpr double far = 10;
  return parts_n > 1 && readings > parts_n &&
         squares(means) / (parts_n - 1) > far * far * within / (readings - parts_n);
}

/// Whether the values of a label have no size of their own: people, machines and lots that should agree, and what
/// follows one after the other in time. There one offset is fitted to all, so that a trace finds what differs, be it
/// ever so large.
bool should_agree(const RecognisedData& data, const RecognisedColumn& c) {
  static const std::set<std::string> names{"operator", "bediener",   "observer", "inspector", "pruefer", "prüfer",
                                           "lab",      "laboratory", "labor",    "batch",     "lot",     "charge",
                                           "machine",  "maschine",   "station",  "week",      "month",   "session"};
  const auto words = words_of(c.name);
  return c.role == ColumnRole::cycle || counts_blocks(c) || !comes_back(data, c) ||
         std::ranges::any_of(words, [&](const std::string& w) { return names.contains(w); });
}

/// The constant that is fitted to a column of readings: one, or one of each part; and a comment.
std::pair<std::string, std::string> offset_of(const RecognisedData& data, const RecognisedColumn& reading,
                                              const NamedColumns& labels) {
  const std::string zero = fmt::format("\"0 {}\"", unit_or(reading, "um"));
  for (const auto& [name, c] : labels) {
    const bool told = c->role == ColumnRole::alignment && c->basis == Basis::user;
    if (!told && should_agree(data, *c)) continue;
    const auto parts = by_text(data, reading, *c);
    if (!told && !differ(parts)) continue;
    std::string all;
    for (const auto& [part, y] : parts)
      all += fmt::format("{}{} = {}", all.empty() ? "" : ", ", toml_string(part), zero);
    return {fmt::format("{{ estimated = true, by.{} = {{ {} }} }}", name, all),
            told ? by_label_comment(name, "as told")
                 : "guessed: " + by_label_comment(name, "because they differ ten times as much as readings of one do")};
  }
  return {fmt::format("{{ estimated = true, value = {} }}", zero), ""};
}

} // namespace

std::string starter_series(const StarterData& data, const std::string& scenario) {
  const RecognisedData& found = data.found;
  const NamedColumns labels = labels_of(found);
  NamedColumns readings = readings_of(found);
  if (readings.empty()) require_readable(found);
  if (readings.empty())
    throw InputError(found.csv.file + ": there is no column of readings", "numbers that were measured are needed",
                     "tell which it is: --role COLUMN=reading");
  std::set<std::string> used;
  for (const auto& [name, c] : readings) used.insert(c->name);
  Names names;
  // Rows that agree in labels and conditions would be repeats of one reading: the time tells them apart.
  NamedColumns conditions;
  const RecognisedColumn* const time = found.find(ColumnRole::time);
  if (time) {
    conditions.emplace_back(names.add(course_name(*time)), time);
    used.insert(time->name);
  }
  for (auto& [name, c] : readings) name = names.add(c->name);
  std::map<std::string, std::string> offsets; // by reading
  for (const auto& [name, c] : readings) offsets[name] = names.add(name + "_offset");
  NamedColumns further;
  for (const RecognisedColumn& c : found.columns)
    if (c.number && c.role == ColumnRole::other && !counts_rows(c) && !names_parts(c) && !names_levels(found, c) &&
        !used.contains(c.name) && different(found, c) > 1) {
      further.emplace_back(names.add(c.name), &c);
      used.insert(c.name);
    }
  const std::string order = conditions.empty() ? "" : conditions[0].first;
  const std::string recorded = columns_of(found, names, used, order, further);

  std::string out =
      fmt::format("# Question: what do the readings in {} depend on?\n#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is "
                  "wrong.\n\nschema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n"
                  "[model.indications]                     # guessed: no column of positions, which "
                  "--role COLUMN=position tells\n",
                  data.file, scenario, toml_string(data.file));
  for (const auto& [name, c] : readings) out += line(name, toml_string(offsets[name]), "");
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n";
  for (const auto& [name, c] : readings) {
    const auto [offset, comment] = offset_of(found, *c, labels);
    out += line(offsets[name], offset, comment);
  }
  for (const auto& [name, c] : readings)
    out += fmt::format("\n[indications.{}]\n", name) +
           line("readings", toml_string(c->name),
                c->why.empty() ? "guessed: numbers that were measured" : "recognised " + c->why) +
           noise_line(*c, nullptr);
  return out + "\n[trace]\n" + blocks_of(found, labels) + recorded;
}

} // namespace gumshoe::scenario
