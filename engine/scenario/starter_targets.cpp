#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {
namespace {

/// The words of a column's name but for those of its role: "cmd_x" as a position is x. Empty: it is named otherwise.
std::string axis_of(const RecognisedColumn& c, const std::set<std::string>& role) {
  std::vector<std::string> words = words_of(c.name);
  return std::erase_if(words, [&](const std::string& w) { return role.contains(w); }) > 0
             ? fmt::format("{}", fmt::join(words, "_"))
             : "";
}

} // namespace

TargetColumns target_columns(const RecognisedData& data) {
  static const std::set<std::string> set{"cmd",  "command", "commanded", "target", "tgt",  "nominal", "nom",
                                         "soll", "set",     "setpoint",  "prog",   "theo", "planned"};
  static const std::set<std::string> read{"act", "actual", "measured", "meas", "ist", "real", "tracker"};
  std::map<std::string, const RecognisedColumn*> targets;
  for (const RecognisedColumn& c : data.columns)
    if (const std::string axis = axis_of(c, set); c.number && !axis.empty()) targets.try_emplace(axis, &c);
  TargetColumns out;
  for (const RecognisedColumn& c : data.columns)
    if (const auto found = targets.find(axis_of(c, read)); c.number && found != targets.end())
      out.emplace_back(found->second, &c), targets.erase(found);
  return out;
}

std::string starter_targets(const StarterData& data, const TargetColumns& columns, const std::string& scenario) {
  const RecognisedData& found = data.found;
  NamedColumns conditions, readings;
  std::set<std::string> used;
  Names names;
  for (const auto& [target, reading] : columns) {
    conditions.emplace_back(names.add(target->name), target);
    readings.emplace_back(names.add(reading->name), reading);
    used.insert({target->name, reading->name});
  }
  const NamedColumns labels = labels_of(found, used);

  std::string out =
      fmt::format("# Question: which errors do the readings in {} show that offsets, scales and turned axes do not "
                  "explain?\n#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is wrong.\n\n"
                  "schema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n[model.indications]\n",
                  data.file, scenario, toml_string(data.file));
  std::string quantities;
  const auto fitted = [&](const std::string& name, const std::string& unit) {
    std::string own = names.add(name);
    quantities += line(own, fmt::format("{{ estimated = true, value = \"0 {}\" }}", unit), "");
    return own;
  };
  // Targets whose zero is none of their size, such as 0 degC, count from it all the same.
  std::map<std::string, std::string> references;
  const auto reference_of = [&](const std::string& unit) {
    std::string& known = references[unit];
    if (known.empty()) {
      known = names.add("reference");
      quantities += line(known, fmt::format("\"0 {}\"", unit), "offsets hold here, not at 0 K");
    }
    return known;
  };
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto& [name, reading] = readings[i];
    const std::string unit = difference_unit_or(*reading, "mm");
    std::string formula = fmt::format("{} + {}", conditions[i].first, fitted(name + "_offset", unit));
    for (const auto& [other, column] : conditions) {
      const std::string difference = difference_unit_or(*column, "mm"), own = unit_or(*column, "mm");
      formula += fmt::format(" + {} * {}", fitted(name + "_by_" + other, units::quotient(unit, difference)),
                             own == difference ? other : fmt::format("({} - {})", other, reference_of(own)));
    }
    out += line(name, toml_string(formula), "guessed: read where it was commanded to");
  }
  const std::string recorded = columns_of(found, names, used);
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n" + quantities;
  for (const auto& [name, reading] : readings)
    out += fmt::format("\n[indications.{}]\n", name) +
           line("readings", toml_string(reading->name), "recognised by its name") +
           "# u = \"0.02 mm\"                         # state the noise of a reading if you know it\n";
  return out + "\n[trace]\n" + blocks_of(found, labels) + recorded;
}

} // namespace gumshoe::scenario
