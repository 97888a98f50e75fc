#include "scenario/starter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"

namespace gumshoe::scenario {
namespace {

using Role = ColumnRole;
/// Name in the scenario, column.
using Named = std::vector<std::pair<std::string, const RecognisedColumn*>>;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + '"';
}

/// A name that formulas and TOML take without quotes.
std::string plain_name(const std::string& text) {
  std::string out;
  for (const std::string& word : words_of(text)) out += (out.empty() ? "" : "_") + word;
  std::erase_if(out, [](unsigned char c) { return c >= 0x80; });
  return out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0 ? "column_" + out : out;
}

/// "pos_mm", or a table of its map or clock.
std::string column_text(const RecognisedColumn& c) {
  if (!c.clock.empty()) return fmt::format("{{ column = {}, clock = {} }}", quoted(c.name), quoted(c.clock));
  if (c.words.empty() || c.number) return quoted(c.name);
  std::string map;
  for (const auto& [word, sign] : c.words) map += fmt::format("{}{} = {}", map.empty() ? "" : ", ", quoted(word), sign);
  return fmt::format("{{ column = {}, map = {{ {} }} }}", quoted(c.name), map);
}

std::string line(const std::string& key, const std::string& value, const std::string& comment) {
  const std::string text = fmt::format("{} = {}", key, value);
  return comment.empty() ? text + '\n' : fmt::format("{:<39} # {}\n", text, comment);
}

std::size_t different(const RecognisedData& data, const RecognisedColumn& c) {
  std::set<std::string> texts;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  for (const auto& row : data.csv.rows) texts.insert(row[column].text);
  return texts.size();
}

/// Columns whose words tell readings apart: cycles, and texts that recur.
Named labels_of(const RecognisedData& data) {
  Named out;
  for (const RecognisedColumn& c : data.columns) {
    const std::size_t n = different(data, c);
    const bool recurs = !c.number && c.clock.empty() && c.words.empty() && n > 1 && 2 * n <= data.csv.rows.size();
    if (c.role == Role::cycle || (c.role == Role::other && recurs)) out.emplace_back(plain_name(c.name), &c);
  }
  return out;
}

std::string data_section(const StarterData& data, const Named& labels, const Named& conditions,
                         const std::set<std::string>& used) {
  std::string out = "[data]\n" + line("file", quoted(data.file), "several files as one: \"run_{run}.csv\"");
  if (!data.found.delimiter.empty()) out += line("delimiter", quoted(data.found.delimiter), "");
  if (data.found.decimal == ',') out += line("decimal", "\",\"", "");
  std::string names;
  for (const auto& [name, c] : labels)
    names += fmt::format("{}{} = {}", names.empty() ? "" : ", ", name, quoted(c->name));
  if (!names.empty()) out += line("labels", "{ " + names + " }", "guessed: what tells repeated series apart");
  std::string where;
  for (const RecognisedColumn& c : data.found.columns)
    if (c.gaps && used.contains(c.name))
      where += fmt::format("{}{} = {{ not = \"\" }}", where.empty() ? "" : ", ", quoted(c.name));
  if (!where.empty()) out += line("where", "{ " + where + " }", "rows without a number are left out");
  out += "\n[data.units]\n";
  for (const RecognisedColumn& c : data.found.columns)
    if (c.number && c.unit != "1" && used.contains(c.name))
      out += line(quoted(c.name), quoted(c.unit),
                  c.unit == "?" ? "the file does not say it: write the unit, such as \"mm\"" : "from its header");
  if (!conditions.empty()) out += "\n[data.conditions]\n";
  for (const auto& [name, c] : conditions) out += line(name, column_text(*c), "recognised " + c->why);
  return out;
}

/// Whether the readings are the positions themselves, measured, and not their errors: then they span what the positions
/// span.
bool measured_position(const RecognisedData& data, const RecognisedColumn& position, const RecognisedColumn& reading) {
  const auto range = [&](const RecognisedColumn& c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    const auto column = static_cast<std::size_t>(data.csv.find(c.name));
    for (const auto& row : data.csv.rows) {
      if (row[column].text.empty()) continue;
      const double x = data.csv.number(row[column], data.decimal);
      low = std::min(low, x), high = std::max(high, x);
    }
    double scale = 1;
    if (c.unit != "?" && c.unit != "1")
      scale = units::to_si(1, c.unit, units::si_unit_of(c.unit), units::Kind::difference);
    return scale * (high - low);
  };
  const double share = range(reading) / range(position);
  return share > 0.5 && share < 2; // an axis errs by less than half of its travel
}

std::string unit_or(const RecognisedColumn& c, const char* otherwise) { return c.unit == "?" ? otherwise : c.unit; }

/// Blocks of [trace]: a label with enough values, or stretches.
std::string blocks_of(const RecognisedData& data, const Named& labels) {
  for (const auto& [name, c] : labels)
    if (different(data, *c) >= 4) return line("blocks", quoted(name), "an effect should recur in each of them");
  if (data.csv.rows.size() < 12)
    return "# blocks = { count = 6 }                # too few rows for blocks; an effect should recur in each of "
           "them\n";
  return line("blocks", "{ count = 6 }", "guessed: no column tells four or more cycles apart");
}

std::string columns_of(const RecognisedData& data, std::set<std::string>& used) {
  std::string out;
  bool ordered = false;
  for (const RecognisedColumn& c : data.columns) {
    if (c.role != Role::time && c.role != Role::temperature) continue;
    if (c.role == Role::time && !c.number && c.clock.empty()) continue;
    if (c.role == Role::time && ordered) continue;
    used.insert(c.name);
    if (c.role == Role::time) {
      ordered = true;
      out = line("order", "\"time\"", "") + "\n[trace.columns]\n" +
            line("time", column_text(c), "recognised " + c.why) + out;
    } else {
      out += line(plain_name(c.name), column_text(c), "recognised " + c.why);
    }
  }
  return ordered || out.empty() ? out : "\n[trace.columns]\n" + out;
}

} // namespace

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

std::string starter_axis(const StarterData& data, const std::string& scenario) {
  const RecognisedData& found = data.found;
  const RecognisedColumn* const position = found.find(Role::position);
  const RecognisedColumn* const reading = found.find(Role::reading);
  if (!position || !reading)
    throw InputError(found.csv.file + ": there are no two columns of numbers", "a position and a reading are needed",
                     "tell which they are: --role COLUMN=position --role COLUMN=reading");
  const RecognisedColumn* const direction = found.find(Role::direction);
  const RecognisedColumn* const sd = found.find(Role::uncertainty);
  const bool measured = measured_position(found, *position, *reading);
  const std::string name = measured ? "measured" : "deviation";
  const std::string pos = unit_or(*position, "mm"), read = unit_or(*reading, "um");
  const Named labels = labels_of(found);
  Named conditions{{"position", position}};
  if (direction) conditions.emplace_back("direction", direction);
  std::set<std::string> used{position->name, reading->name};
  if (sd && sd->number) used.insert(sd->name);
  const std::string recorded = columns_of(found, used);

  std::string out =
      fmt::format("# Question: which errors do the readings in {} show that a straight line{} do{} not explain?\n"
                  "#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is wrong.\n\n",
                  data.file, direction ? " and a reversal" : "", direction ? "" : "es", scenario);
  out += fmt::format("schema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n[model.indications]\n",
                     quoted(data.file));
  out += line(name,
              fmt::format("\"{}offset + gain * position{}\"", measured ? "position + " : "",
                          direction ? " + reversal * direction" : ""),
              measured ? "guessed: the readings span what the positions span" : "guessed: the readings are errors");
  out += '\n' + data_section(data, labels, conditions, used);
  out += "\n[quantities]                            # fitted to the readings\n";
  out += line("offset", fmt::format("{{ estimated = true, value = \"0 {}\" }}", read), "");
  out += line("gain", fmt::format("{{ estimated = true, value = \"0 ({})/({})\" }}", measured ? pos : read, pos), "");
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

namespace {

/// The text of an example by its sections: header line and what follows it, comments in front included.
struct Section {
  std::string name; ///< "quantities.rod_length"; empty: before the first
  std::vector<std::string> lines;
};

std::vector<Section> sections_of(const std::string& text) {
  static const std::regex header(R"(^\[+([^\]]+)\]+.*)");
  std::vector<Section> out(1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string row = text.substr(at, end - at);
    at = end + 1;
    std::smatch found;
    if (std::regex_match(row, found, header)) out.push_back({found[1], {}});
    if (!row.starts_with("#:schema")) out.back().lines.push_back(row);
  }
  return out;
}

std::string limits_text(const QuantityCard& q) {
  const auto shown = [&](double x) { return units::from_si(x, std::string(q.unit), std::string(q.si_unit)); };
  const bool low = std::isfinite(q.limits.low), high = std::isfinite(q.limits.high);
  if (!low && !high) return "";
  if (!high) return fmt::format("; {} {:g} {}", q.limits.low_open ? "above" : "at least", shown(q.limits.low), q.unit);
  if (!low) return fmt::format("; {} {:g} {}", q.limits.high_open ? "below" : "at most", shown(q.limits.high), q.unit);
  return fmt::format("; {:g} to {:g} {}", shown(q.limits.low), shown(q.limits.high), q.unit);
}

std::string key_of(const std::string& row) {
  static const std::regex key(R"(^([A-Za-z_0-9]+) *=.*)");
  std::smatch found;
  return std::regex_match(row, found, key) ? std::string(found[1]) : "";
}

std::string value_text(double si, std::string_view unit, std::string_view si_unit) {
  const double x = units::from_si(si, std::string(unit), std::string(si_unit));
  return unit == "1" ? fmt::format("{:g}", x) : fmt::format("\"{:g} {}\"", x, unit);
}

/// Writes the sections of an example, with what the card says of each quantity and condition.
class ModelStarter {
public:
  ModelStarter(const ModelCard& card, const StarterData* data) : card_(card), data_(data) {
    if (data) match();
  }

  std::string write(const std::string& example) {
    std::string out;
    bool written = !data_;
    for (const Section& section : sections_of(example)) {
      const bool replaced = data_ && (section.name.starts_with("indications") || section.name == "conditions");
      if (!written && !section.name.empty() && section.name != "model") {
        out += data_text();
        written = true;
      }
      out += replaced ? kept(section) : commented(section);
    }
    if (!written) out += data_text();
    return out + (example.find("estimated = true") == std::string::npos ? "" : trace_text()) + others();
  }

private:
  bool is(const RecognisedColumn& c, std::string_view name) const {
    auto words = words_of(c.name), wanted = words_of(std::string(name));
    const auto unit = words_of(c.unit);
    std::erase_if(words, [&](const std::string& w) {
      return std::ranges::find(unit, w) != unit.end() && std::ranges::find(wanted, w) == wanted.end();
    });
    return words == wanted;
  }

  void match() {
    const auto& columns = data_->found.columns;
    for (const VariableCard& i : card_.indications) {
      auto c = std::ranges::find_if(columns, [&](const auto& one) { return one.number && is(one, i.name); });
      const RecognisedColumn* only = card_.indications.size() == 1 ? data_->found.find(Role::reading) : nullptr;
      readings_.emplace_back(i.name, c != columns.end() ? &*c : only);
      if (readings_.back().second) used_.insert(readings_.back().second->name);
    }
    for (const VariableCard& v : card_.conditions)
      for (const RecognisedColumn& c : columns) {
        if (used_.contains(c.name)) continue;
        const bool role = v.name == scenario::name(c.role); // a condition "other" there is not
        if (!(is(c, v.name) && c.number) && !role) continue;
        conditions_.emplace_back(v.name, &c);
        used_.insert(c.name);
        break;
      }
  }

  std::string data_text() const {
    std::string out = data_section(*data_, labels_of(data_->found), conditions_, used_) + '\n';
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const VariableCard& card = card_.indications[i];
      const RecognisedColumn* c = readings_[i].second;
      out += fmt::format("[indications.{}]", card.name);
      out += fmt::format("{}# {}, {}\n",
                         std::string(std::max<std::size_t>(1, 25 - std::min<std::size_t>(24, card.name.size())), ' '),
                         card.meaning, card.unit);
      out += line("readings", c ? quoted(c->name) : "\"?\"",
                  c ? "recognised " + (c->why.empty() ? std::string("by its name") : c->why)
                    : "which column? Write its name; the file has " +
                          fmt::format("{}", fmt::join(data_->found.csv.names(), ", ")));
      out += "# u = \"...\"                              # standard uncertainty of one reading, or { column = \"...\" "
             "}\n\n";
    }
    return out;
  }

  /// What tracing asks of the data, where the example has something to fit.
  std::string trace_text() const {
    if (!data_) return "";
    const bool timed = std::ranges::any_of(conditions_, [](const auto& c) { return c.first == "time"; });
    return "\n[trace]\n" + blocks_of(data_->found, labels_of(data_->found)) +
           (timed ? line("order", "\"time\"", "") : "");
  }

  /// Single conditions that the data do not give.
  std::string kept(const Section& section) const {
    if (section.name != "conditions") return "";
    std::string out;
    for (const std::string& row : section.lines) {
      const std::string key = key_of(row);
      const bool in_data = std::ranges::any_of(conditions_, [&](const auto& c) { return c.first == key; });
      const bool listed = row.find("= [") != std::string::npos || row.find("= {") != std::string::npos;
      if (!key.empty() && !in_data && !listed) out += row + '\n';
    }
    return out.empty()
               ? out
               : "[conditions]                            # as in the model's example: replace them\n" + out + '\n';
  }

  std::string commented(const Section& section) {
    std::string out;
    for (const std::string& row : section.lines) {
      const std::string key = key_of(row);
      if (section.name == "model" && key == "method" && data_) {
        out += "method = \"propagation\"\n";
        continue;
      }
      if (section.name == "quantities" && row[0] != '[') out += comment(key);
      if (section.name.starts_with("quantities.") && row.starts_with("[")) out += comment(section.name.substr(11));
      if (section.name == "conditions")
        for (const VariableCard& v : card_.conditions)
          if (v.name == key) out += fmt::format("# {}: {}\n", v.name, v.meaning);
      out += row + '\n';
    }
    if (section.name.empty())
      out = "# Written by gumshoe new: the example of the model " + std::string(card_.name) +
            ", whose numbers and sources are to be replaced by yours.\n" + out;
    return out;
  }

  std::string comment(const std::string& quantity) {
    for (const QuantityCard& q : card_.quantities)
      if (q.name == quantity.substr(0, quantity.find('.')) && told_.insert(quantity).second)
        return fmt::format("# {}: {}{}\n", q.name, q.meaning, limits_text(q));
    return "";
  }

  std::string others() const {
    std::string out;
    for (const QuantityCard& q : card_.quantities)
      if (!told_.contains(std::string(q.name)))
        out += fmt::format("#\n# [quantities.{}]  # {}{}\n# value = {}\n", q.name, q.meaning, limits_text(q),
                           value_text(q.default_value, q.unit, q.si_unit));
    return out.empty() ? out : "\n# Further quantities, exact at these values unless stated:\n" + out;
  }

  const ModelCard& card_;
  const StarterData* data_;
  Named readings_, conditions_;
  std::set<std::string> used_, told_;
};

} // namespace

std::string starter_model(const ModelCard& card, const std::string& example, const StarterData* data) {
  return ModelStarter(card, data).write(example);
}

} // namespace gumshoe::scenario
