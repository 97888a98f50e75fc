#include <fmt/format.h>

#include "scenario/starter_parts.h"

namespace gumshoe::scenario {
namespace {

/// Columns of numbers that were measured: of the same kind as the reading, and not set.
NamedColumns readings_of(const RecognisedData& data) {
  NamedColumns out;
  for (const RecognisedColumn& c : data.columns)
    if (c.number && !counts_rows(c) && !names_parts(c) &&
        (c.role == ColumnRole::reading || (c.role == ColumnRole::other && !was_set(data, c))))
      out.emplace_back(plain_name(c.name), &c);
  return out;
}

} // namespace

std::string starter_series(const StarterData& data, const std::string& scenario) {
  const RecognisedData& found = data.found;
  const NamedColumns readings = readings_of(found), labels = labels_of(found);
  if (readings.empty())
    throw InputError(found.csv.file + ": there is no column of readings", "numbers that were measured are needed",
                     "tell which it is: --role COLUMN=reading");
  std::set<std::string> used;
  for (const auto& [name, c] : readings) used.insert(c->name);
  // Rows that agree in labels and conditions would be repeats of one reading: the time tells them apart.
  NamedColumns conditions;
  const RecognisedColumn* const time = found.find(ColumnRole::time);
  if (time && (time->number || !time->clock.empty())) {
    conditions.emplace_back("time", time);
    used.insert(time->name);
  }
  std::string recorded = columns_of(found, used);
  if (recorded.find("[trace.columns]") == std::string::npos) recorded += "\n[trace.columns]\n";
  for (const RecognisedColumn& c : found.columns)
    if (c.number && c.role == ColumnRole::other && !counts_rows(c) && !names_parts(c) && !used.contains(c.name) &&
        different(found, c) > 1) {
      recorded += line(plain_name(c.name), quoted(c.name), "recorded with the readings");
      used.insert(c.name);
    }

  std::string out =
      fmt::format("# Question: what do the readings in {} depend on?\n#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is "
                  "wrong.\n\nschema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n"
                  "[model.indications]                     # guessed: no column of positions, which "
                  "--role COLUMN=position tells\n",
                  data.file, scenario, quoted(data.file));
  for (const auto& [name, c] : readings) out += line(name, quoted(name + "_offset"), "");
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n";
  for (const auto& [name, c] : readings)
    out += line(name + "_offset", fmt::format("{{ estimated = true, value = \"0 {}\" }}", unit_or(*c, "um")), "");
  for (const auto& [name, c] : readings)
    out += fmt::format("\n[indications.{}]\n", name) +
           line("readings", quoted(c->name),
                c->why.empty() ? "guessed: numbers that were measured" : "recognised " + c->why) +
           "# u = \"0.2 um\"                          # state the noise of a reading if you know it\n";
  return out + "\n[trace]\n" + blocks_of(found, labels) + (conditions.empty() ? "" : line("order", "\"time\"", "")) +
         recorded;
}

} // namespace gumshoe::scenario
