#include "scenario/quantity.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/uncertainty.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using quantities::Entry;
using quantities::InputQuantity;
using quantities::Labels;

class QuantityReader {
public:
  QuantityReader(const QuantityCard& card, InputQuantity& out, Context& context)
      : card_(card), out_(out), context_(context) {}

  void read(const Node& node, const std::string& path, const Labels& labels, const std::string& source) {
    if (node.kind != Node::Kind::table) return exact(node, path, labels, source);
    Table table(node, path, context_.problems);
    const std::string own = table.rendered("source");
    unit(table);
    const std::string& told = own.empty() ? source : own;
    if (labels.empty()) out_.estimated = table.boolean("estimated").value_or(false);
    if (table.has("by"))
      by(table, labels, told);
    else
      entry(table, labels, told);
    table.refuse_unknown();
  }

private:
  Dimension point() const { return {std::string(card_.si_unit)}; }

  /// Where a quantity has a card the key only repeats its kind; else it is where the card's unit comes from.
  void unit(Table& table) {
    const auto unit = table.text("unit");
    if (!unit || units::convertible(*unit, std::string(card_.si_unit))) return;
    context_.problems.add(*table.find("unit"),
                          fmt::format("{}: '{}' is not {}", table.path("unit"), *unit, units::kind_name(std::string(card_.si_unit))),
                          "must convert to " + std::string(card_.si_unit));
  }

  void exact(const Node& node, const std::string& path, const Labels& labels, const std::string& source) {
    const auto value = read_measure(node, path, point(), context_.problems);
    if (value) keep({labels, *value, {}, source}, node, path);
  }

  void entry(Table& table, const Labels& labels, const std::string& source) {
    const bool given = table.has("value");
    const auto value = table.measure("value", point());
    Entry e{labels, value.value_or(card_.default_value), {}, source};
    const std::size_t problems = context_.problems.size();
    if (table.has("components")) {
      for (const char* key : {"distribution", "u", "U", "observations", "half_width", "low", "high", "per"}) {
        if (!table.has(key)) continue;
        context_.problems.add(*table.find(key), fmt::format("{}: '{}' is given together with components", table.path(), key),
                              "each component states its own", "move it into a component");
      }
      e.components = read_components(table, std::string(card_.si_unit), given, e.value, context_);
    } else if (uncertain(table)) {
      const Form form{std::string(card_.si_unit), true, given ? value : std::nullopt, card_.default_value};
      if (auto uncertainty = read_uncertainty(table, form, context_)) {
        e.value = uncertainty->value;
        uncertainty->component.name = "c1";
        if (!uncertainty->exact) e.components.push_back(std::move(uncertainty->component));
      }
    } else if (!given && !out_.estimated) {
      table.add(table.path() + ": neither a value nor an uncertainty is given", "", "value = \"...\"");
    }
    if (given && !value) return;
    for (const Component& c : e.components) {
      if (!out_.estimated || c.per.empty()) continue;
      table.add(table.path() + ": estimated is given together with per", "a fit finds one value per label, not one draw per label",
                fmt::format("give a value per label: by.{}", c.per.front()));
      return;
    }
    if (out_.estimated && e.components.empty()) {
      const std::string note = out_.name + ": estimated, without a distribution; treated as exact at its start value until "
                                           "gumshoe estimate has fitted it";
      if (std::find(context_.notes.begin(), context_.notes.end(), note) == context_.notes.end())
        context_.notes.push_back(note);
    }
    if (context_.problems.size() == problems)
      keep(std::move(e), given ? *table.find("value") : table.node(), table.path());
  }

  /// Anything beside value and source states an uncertainty, or is a mistake that its reader finds.
  static bool uncertain(Table& table) {
    for (const Member& m : table.node().members)
      if (m.key == "distribution" || m.key == "u" || m.key == "U" || m.key == "observations" || m.key == "k" ||
          m.key == "half_width" || m.key == "low" || m.key == "high" || m.key == "per" || m.key == "evaluation" ||
          m.key == "degrees_of_freedom")
        return true;
    return false;
  }

  void by(Table& table, const Labels& labels, const std::string& source) {
    auto by = table.table("by");
    if (!by) return;
    if (by->members().size() != 1) {
      by->add(fmt::format("{}: there are {} labels", by->path(), by->members().size()), "a by-table has one label; tables can be nested",
              "nest them: by.rod.\"rod 1\".by.setup");
      return;
    }
    const Member& label = by->members().front();
    if (context_.readings_known && !context_.label_values.contains(label.key)) {
      context_.problems.add(label.line, label.column,
                            fmt::format("{}: no reading has the label '{}'", by->path(), label.key), "",
                            did_you_mean(label.key, context_.label_names()));
      return;
    }
    auto values = by->table(label.key);
    if (!values) return;
    std::vector<std::string> seen;
    for (const Member& row : values->members()) {
      seen.push_back(row.key);
      Labels here = labels;
      if (find_label(here, label.key)) {
        context_.problems.add(row.line, row.column,
                              fmt::format("{}: the label '{}' is nested within itself", by->path(), label.key));
        return;
      }
      here.emplace_back(label.key, row.key);
      known(label.key, row, values->path());
      read(row.value, values->path(row.key), here, source);
    }
    complete(label, seen, labels, values->path());
  }

  void known(const std::string& label, const Member& row, const std::string& path) {
    if (!context_.readings_known) return;
    const auto& values = context_.label_values[label];
    if (values.contains(row.key)) return;
    context_.problems.add(row.line, row.column, fmt::format("{}: no reading has {} = '{}'", path, label, row.key), "",
                          did_you_mean(row.key, {values.begin(), values.end()}));
  }

  void complete(const Member& label, const std::vector<std::string>& seen, const Labels& labels,
                const std::string& path) {
    if (!context_.readings_known) return;
    std::set<std::string> told;
    for (const Labels& reading : context_.readings) {
      if (!matches(reading, labels)) continue;
      const std::string* value = find_label(reading, label.key);
      if (value && std::find(seen.begin(), seen.end(), *value) != seen.end()) continue;
      if (!told.insert(value ? *value : "").second) continue;
      context_.problems.add(label.line, label.column,
                            value ? fmt::format("{}: no value for {} = '{}'", path, label.key, *value)
                                  : fmt::format("{}: a reading has no label '{}'", path, label.key),
                            "every reading needs one");
    }
  }

  /// Entries that no reading uses are left out, and said so.
  void keep(Entry entry, const Node& node, const std::string& path) {
    check_limits(entry, card_, node, path, context_.problems);
    const auto uses = [&](const Labels& reading) { return matches(reading, entry.labels); };
    if (context_.readings_known && !entry.labels.empty() &&
        std::none_of(context_.readings.begin(), context_.readings.end(), uses)) {
      context_.notes.push_back(fmt::format("{}: not used, because no reading has {}", path, text_of(entry.labels)));
      return;
    }
    out_.entries.push_back(std::move(entry));
  }

  const QuantityCard& card_;
  InputQuantity& out_;
  Context& context_;
};

std::string shown(double value, const QuantityCard& card) {
  return fmt::format("{:.6g} {}", units::from_si(value, std::string(card.unit), std::string(card.si_unit)), card.unit);
}

std::string limit_text(const Limits& limits, bool low, const QuantityCard& card) {
  const bool open = low ? limits.low_open : limits.high_open;
  return fmt::format("must be {} {}", low ? (open ? "above" : "at least") : (open ? "below" : "at most"),
                     shown(low ? limits.low : limits.high, card));
}

} // namespace

void check_limits(const Entry& entry, const QuantityCard& card, const Node& node, const std::string& path,
                  Problems& problems) {
  double estimate = entry.value, least = entry.value, most = entry.value;
  for (const Component& c : entry.components) {
    estimate += c.distribution.mean();
    least += c.distribution.support_low();
    most += c.distribution.support_high();
  }
  const Limits& limits = card.limits;
  if (!limits.contain(estimate)) {
    const bool low = limits.low_open ? estimate <= limits.low : estimate < limits.low;
    problems.add(node, fmt::format("{}: {} is impossible", path, shown(estimate, card)), limit_text(limits, low, card));
    return;
  }
  // Ends of a sum carry rounding; an open limit is never drawn. Unbounded distributions are the model's to refuse.
  const double rounding = 1e-12 * (std::abs(estimate) + std::abs(most - least));
  const bool low = std::isfinite(least) && least < limits.low - rounding;
  const bool high = std::isfinite(most) && most > limits.high + rounding;
  if (low || high) {
    problems.add(node, fmt::format("{}: the distribution reaches {}", path, shown(low ? least : most, card)),
                 limit_text(limits, low, card), "narrow the distribution");
  }
}

std::vector<Component> read_components(Table& table, const std::string& si_unit, bool value_given, double& value,
                                       Context& context) {
  std::vector<Component> out;
  const auto* items = table.array("components");
  if (!items) return out;
  std::set<std::string> names;
  bool replaced = false;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const auto row = as_table((*items)[i], fmt::format("{}.components[{}]", table.path(), i + 1), context.problems);
    if (!row) continue;
    Table component = *row;
    const std::string name = component.text("name").value_or(fmt::format("c{}", i + 1));
    if (name.empty() || !names.insert(name).second) {
      component.add(fmt::format("{}: the name '{}' {}", component.path(), name, name.empty() ? "is empty" : "is already used"),
                    "components need different names");
    }
    Form form{si_unit, false, 0.0, 0.0};
    const bool mean_counts = component.has("observations") && !value_given;
    if (mean_counts) form.value.reset();
    if (mean_counts && replaced) {
      component.add(component.path() + ": two components have observations, but there is no value", "either mean could be the value",
                    "state the value");
    }
    replaced |= mean_counts;
    auto uncertainty = read_uncertainty(component, form, context);
    component.refuse_unknown();
    if (!uncertainty) continue;
    if (mean_counts) value = uncertainty->value;
    uncertainty->component.name = name;
    if (!uncertainty->exact) out.push_back(std::move(uncertainty->component));
  }
  return out;
}

quantities::InputQuantity default_quantity(const QuantityCard& card, const std::string& name) {
  return {name, std::string(card.unit), std::string(card.si_unit), {{{}, card.default_value, {}, "default"}}};
}

quantities::InputQuantity read_quantity(const Node& node, const std::string& path, const QuantityCard& card,
                                        const std::string& name, Context& context) {
  InputQuantity out{name, std::string(card.unit), std::string(card.si_unit), {}};
  QuantityReader(card, out, context).read(node, path, {}, {});
  return out;
}

} // namespace gumshoe::scenario
