#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "models/cards.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {

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
  const bool low = q.limits.low > models::any.low, high = q.limits.high < models::any.high;
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
    // Before [data] is written: its columns are read there.
    const std::string trace = example.find("estimated = true") == std::string::npos ? "" : trace_text();
    for (const Section& section : sections_of(example)) {
      const bool replaced = data_ && (section.name.starts_with("indications") || section.name == "conditions");
      if (!written && !section.name.empty() && section.name != "model") {
        out += data_text();
        written = true;
      }
      out += replaced ? kept(section) : commented(section);
    }
    if (!written) out += data_text();
    return out + trace + others();
  }

private:
  void match() {
    const auto& columns = data_->found.columns;
    for (const VariableCard& i : card_.indications) {
      auto c = std::ranges::find_if(columns, [&](const auto& one) { return one.number && is_named(one, i.name); });
      const RecognisedColumn* only = card_.indications.size() == 1 ? data_->found.find(ColumnRole::reading) : nullptr;
      readings_.emplace_back(i.name, c != columns.end() ? &*c : only);
      if (readings_.back().second) used_.insert(readings_.back().second->name);
    }
    for (const VariableCard& v : card_.conditions)
      for (const RecognisedColumn& c : columns) {
        if (used_.contains(c.name)) continue;
        const bool role = v.name == scenario::name(c.role); // a condition "other" there is not
        if (!(is_named(c, v.name) && c.number) && !role) continue;
        conditions_.emplace_back(v.name, &c);
        used_.insert(c.name);
        break;
      }
  }

  std::string data_text() const {
    std::string out = data_section(*data_, labels_of(data_->found, used_), conditions_, used_) + '\n';
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const VariableCard& card = card_.indications[i];
      const RecognisedColumn* c = readings_[i].second;
      out += fmt::format("[indications.{}]", card.name);
      out += fmt::format("{}# {}, {}\n",
                         std::string(std::max<std::size_t>(1, 25 - std::min<std::size_t>(24, card.name.size())), ' '),
                         card.meaning, card.unit);
      out += line("readings", c ? toml_string(c->name) : "\"?\"",
                  c ? "recognised " + (c->why.empty() || is_named(*c, card.name) ? std::string("by its name") : c->why)
                    : "which column? Write its name; the file has " +
                          fmt::format("{}", fmt::join(data_->found.csv.names(), ", ")));
      out += "# u = \"...\"                              # standard uncertainty of one reading, or { column = \"...\" "
             "}\n\n";
    }
    return out;
  }

  /// What tracing asks of the data, where the example has something to fit.
  std::string trace_text() {
    if (!data_) return "";
    const bool timed = std::ranges::any_of(conditions_, [](const auto& c) { return c.first == "time"; });
    Names names;
    for (const auto* variables : {&card_.conditions, &card_.indications, &card_.measurands})
      for (const VariableCard& v : *variables) names.reserve(v.name);
    for (const QuantityCard& q : card_.quantities) names.reserve(q.name);
    return "\n[trace]\n" + blocks_of(data_->found, labels_of(data_->found, used_)) +
           columns_of(data_->found, names, used_, timed ? "time" : "");
  }

  /// Whether the model takes positions for deviations on request, and the data's readings are positions.
  bool reads_position() const {
    const auto* position = data_->found.find(ColumnRole::position);
    return std::ranges::find(card_.conditions, "reads_position", &VariableCard::name) != card_.conditions.end() &&
           position && readings_.size() == 1 && readings_[0].second &&
           measured_position(data_->found, *position, *readings_[0].second);
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
    if (reads_position()) out += line("reads_position", "1", "guessed: the readings span what the positions span");
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
  NamedColumns readings_, conditions_;
  std::set<std::string> used_, told_;
};

} // namespace

std::string filled_in(const ModelCard& card, const std::string& example, const StarterData* data) {
  return ModelStarter(card, data).write(example);
}

std::string starter_model(const ModelCard& card, const std::string& example, const StarterData* data) {
  return "# Written by gumshoe new: the example of the model " + std::string(card.name) +
         ", whose numbers and sources are to be replaced by yours.\n" + filled_in(card, example, data);
}

} // namespace gumshoe::scenario
