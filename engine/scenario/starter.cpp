#include "scenario/starter.h"

#include <fmt/format.h>

#include "scenario/starter_parts.h"

namespace gumshoe::scenario {

using Role = ColumnRole;

std::string starter_budget() {
  return R"(# Question: what is the uncertainty of a result that a formula computes from readings and stated quantities?
#
# Every number below is made up: replace it, its uncertainty and its source by yours. `gumshoe check` names what is wrong.

schema = 1
title  = "a length at 20 degC"

[model]
name = "expression"

[model.measurands]                      # the result; names below may be chosen freely
length = { formula = "reading * (1 - alpha * (temperature - reference)) + correction", unit = "mm" }

[indications.reading]                   # what was read; or a column of a file, see [data]
readings      = ["50.0021 mm", "50.0019 mm", "50.0022 mm", "50.0020 mm"]
resolution    = "0.1 um"
repeatability = "readings"              # from the scatter of these readings; or { s = "0.2 um" }

[quantities.correction]                 # a certificate: expanded uncertainty U with its k
value  = "0.3 um"
U      = "0.4 um"
k      = 2
source = "assumed: certificate"

[quantities.alpha]                      # limits: a rectangular distribution
value        = "11.5 um/m/K"
distribution = "rectangular"
half_width   = "1 um/m/K"
source       = "assumed: steel"

[quantities.temperature]                # a standard uncertainty
value  = "20.4 degC"
u      = "0.3 K"
source = "assumed: thermometer"

[quantities.reference]
value = "20 degC"

[run]
samples = 1_000_000
seed    = 1
)";
}

namespace {

/// A quantity that is fitted: one, or one of each alignment.
std::string fitted(const RecognisedData& data, const NamedColumns& labels, const std::string& unit) {
  const std::string zero = fmt::format("\"0 {}\"", unit);
  for (const auto& [name, c] : labels) {
    if (c->role != Role::alignment) continue;
    std::string all;
    std::set<std::string> known;
    for (const auto& row : data.csv.rows)
      if (const std::string& text = row[static_cast<std::size_t>(data.csv.find(c->name))].text;
          known.insert(text).second)
        all += fmt::format("{}{} = {}", all.empty() ? "" : ", ", quoted(text), zero);
    return fmt::format("{{ estimated = true, by.{} = {{ {} }} }}", name, all);
  }
  return fmt::format("{{ estimated = true, value = {} }}", zero);
}

} // namespace

std::string starter_axis(const StarterData& data, const std::string& scenario) {
  const RecognisedData& found = data.found;
  const RecognisedColumn* const position = found.find(Role::position);
  const RecognisedColumn* const reading = found.find(Role::reading);
  if (!position || !reading)
    throw InputError(found.csv.file + ": there is no column of readings", "numbers that were measured are needed",
                     "tell which it is: --role COLUMN=reading");
  require_numbers(found, *position, "positions");
  require_numbers(found, *reading, "readings");
  const RecognisedColumn* const direction = found.find(Role::direction);
  const RecognisedColumn* const sd = found.find(Role::uncertainty);
  const bool measured = measured_position(found, *position, *reading);
  const bool turns = full_turn(found, *position); // its error comes back: no gain
  const std::string name = measured ? "measured" : "deviation";
  const std::string pos = unit_or(*position, "mm"), read = unit_or(*reading, "um");
  const NamedColumns labels = labels_of(found);
  const bool eccentric = turns && found.find(Role::alignment);
  NamedColumns conditions{{"position", position}};
  if (direction) conditions.emplace_back("direction", direction);
  std::set<std::string> used{position->name, reading->name};
  if (direction) used.insert(direction->name);
  if (sd && sd->number) used.insert(sd->name);
  const std::string recorded = columns_of(found, used);

  std::string out =
      fmt::format("# Question: which errors do the readings in {} show that {}{} do{} not explain?\n"
                  "#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is wrong.\n\n",
                  data.file, turns ? "an offset" : "a straight line", direction ? " and a reversal" : "",
                  direction ? "" : "es", scenario);
  out += fmt::format("schema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n[model.indications]\n",
                     quoted(data.file));
  out += line(name,
              fmt::format("\"{}offset{}{}\"", measured ? "position + " : "",
                          eccentric ? " + eccentricity_x * cos(position) + eccentricity_y * sin(position)"
                          : turns   ? ""
                                    : " + gain * position",
                          direction ? " + reversal * direction" : ""),
              measured ? "guessed: the readings span what the positions span" : "guessed: the readings are errors");
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n";
  out += line("offset", fitted(found, labels, read), "");
  if (!turns) out += line("gain", fitted(found, labels, fmt::format("({})/({})", measured ? pos : read, pos)), "");
  for (const char* axis : {"eccentricity_x", "eccentricity_y"})
    if (eccentric) out += line(axis, fitted(found, labels, read), "");
  if (direction)
    out +=
        line("reversal", fmt::format("{{ estimated = true, value = \"0 {}\" }}", read), "half of the reversal error");
  out +=
      fmt::format("\n[indications.{}]\n", name) + line("readings", quoted(reading->name), "recognised " + reading->why);
  if (sd && sd->number)
    out += line("u", fmt::format("{{ column = {} }}", quoted(sd->name)), "recognised " + sd->why);
  else
    out += "# u = \"0.2 um\"                          # state the noise of a reading if you know it\n";
  return out + "\n[trace]\n" + blocks_of(found, labels) + recorded;
}

} // namespace gumshoe::scenario
