#include "scenario/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenario/uncertainty.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using quantities::Entry;
using quantities::InputQuantity;
using quantities::Labels;

const std::vector<Key>& quantity_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all = {
        {"value", shape::reference("measure"), "estimate; may be left out if an uncertainty is given"},
        {"unit", shape::text(), "unit in which it is shown, if no number has one (for models that a scenario states)"},
        {"estimated", shape::flag(),
         "gumshoe estimate fits it to the readings; value is the start value, u or a distribution the prior", false,
         "false"},
        {"components", shape::list(shape::reference("component")), "deviations that add up"},
        {"by", shape::reference("by"), "values per label"},
        {"column", shape::text(),
         "column of [data] with what was set for each reading; u or a distribution is the deviation from it"},
    };
    const auto uncertainty = uncertainty_keys();
    all.insert(all.end(), uncertainty.begin(), uncertainty.end());
    return all;
  }();
  return keys;
}

const std::vector<Key>& component_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all = uncertainty_keys();
    all.insert(all.begin(), {"name", shape::text() + R"(, "minLength": 1)", "c1, c2, ... by default"});
    return all;
  }();
  return keys;
}

std::string shown(double value, const QuantityCard& card) {
  const double number = units::from_si(value, std::string(card.unit), std::string(card.si_unit));
  return fmt::format("{:.6g}{}", number, units::suffix(card.unit));
}

class QuantityReader {
public:
  QuantityReader(const QuantityCard& card, InputQuantity& out, Context& context)
      : card_(card), out_(out), context_(context) {}

  void read(const Node& node, const std::string& path, const Labels& labels, const std::string& source) {
    if (node.kind != Node::Kind::table) return exact(node, path, labels, source);
    Table table(node, path, context_.problems);
    table.declare(quantity_keys());
    const std::string own = table.rendered("source");
    unit(table);
    const std::string& told = own.empty() ? source : own;
    if (labels.empty()) out_.estimated = table.boolean("estimated").value_or(false);
    if (table.has("column")) // of a quantity as a whole it was expanded (set_points.h)
      return table.refuse_key("column", "an entry by label has no column",
                              "the column tells the set-points apart itself", "state it for the quantity as a whole");
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
    const std::string si_unit(card_.si_unit);
    table.refuse_key("unit", fmt::format("'{}' is not {}", *unit, units::kind_name(si_unit)),
                     "must convert to " + si_unit);
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
      for (const char* key : {"distribution", "u", "U", "observations", "half_width", "low", "high", "per", "from"}) {
        if (!table.has(key)) continue;
        context_.problems.add(*table.find(key),
                              fmt::format("{}: '{}' is given together with components", table.path(), key),
                              "each component states its own", "move it into a component");
      }
      e.components = read_components(table, std::string(card_.si_unit), given, e.value, context_);
    } else if (uncertain(table)) {
      const Form form{std::string(card_.si_unit),   true,
                      given ? value : std::nullopt, card_.default_value,
                      given ? value : std::nullopt, table.find("value")};
      if (auto uncertainty = read_uncertainty(table, form, context_)) {
        e.value = uncertainty->value;
        uncertainty->component.name = "c1";
        if (!uncertainty->exact) e.components.push_back(std::move(uncertainty->component));
      }
    } else if (!given && !out_.estimated) {
      table.refuse("neither a value nor an uncertainty is given", "", "value = \"...\"");
    }
    if (given && !value) return;
    for (const Component& c : e.components) {
      if (!out_.estimated || c.per.empty()) continue;
      table.refuse("estimated is given together with per", "a fit finds one value per label, not one draw per label",
                   fmt::format("give a value per label: by.{}", c.per.front()));
      return;
    }
    if (context_.problems.size() > problems) return;
    if (!given && !out_.estimated && !states_place(table)) assume(e.value);
    keep(std::move(e), given ? *table.find("value") : table.node(), table.path());
  }

  /// Whether the uncertainty says where the quantity lies; the limits of a component are those of a deviation.
  static bool states_place(const Table& table) {
    constexpr std::array places{"low", "high", "mean", "median", "mu", "values", "from", "shape", "observations"};
    const auto has_key = [](const Node& node, const auto& keys) {
      return std::ranges::any_of(node.members,
                                 [&](const Member& m) { return std::ranges::find(keys, m.key) != keys.end(); });
    };
    if (has_key(table.node(), places)) return true;
    const auto components = std::ranges::find(table.node().members, "components", &Member::key);
    return components != table.node().members.end() &&
           std::ranges::any_of(components->value.items, [&](const Node& component) {
             return has_key(component, std::array{"observations", "from", "values"});
           });
  }

  void assume(double value) {
    auto& all = context_.without_value;
    if (all.empty() || all.back().quantity != out_.name) all.push_back({out_.name, shown(value, card_)});
  }

  /// Anything but value and source states an uncertainty, or is a mistake that its reader finds.
  static bool uncertain(const Table& table) {
    constexpr std::array words{
        "distribution", "u",   "U",          "observations",      "k", "from", "same", "half_width", "low",
        "high",         "per", "evaluation", "degrees_of_freedom"};
    return std::ranges::any_of(table.node().members,
                               [&](const Member& m) { return std::ranges::find(words, m.key) != words.end(); });
  }

  void by(Table& table, const Labels& labels, const std::string& source) {
    auto by = table.table("by");
    if (!by) return;
    if (by->members().size() != 1) {
      by->refuse(fmt::format("there are {} labels", by->members().size()),
                 "a by-table has one label; tables can be nested", "nest them: by.rod.\"rod 1\".by.setup");
      return;
    }
    const Member& label = by->members().front();
    if (context_.readings_known && !context_.label_values.contains(label.key))
      return context_.problems.add(label, fmt::format("{}: no reading has the label '{}'", by->path(), label.key), "",
                                   did_you_mean(label.key, context_.label_names()));
    auto values = by->table(label.key);
    if (!values) return;
    std::set<std::string> seen;
    std::vector<const Member*> unknown;
    const Member* others = nullptr;
    for (const Member& row : values->members()) {
      seen.insert(row.key);
      if (quantities::label_value(labels, label.key))
        return context_.problems.add(row,
                                     fmt::format("{}: the label '{}' is nested within itself", by->path(), label.key));
      if (row.key == any_other) {
        others = &row;
        continue;
      }
      if (context_.readings_known && !context_.label_values[label.key].contains(row.key)) unknown.push_back(&row);
      read(row.value, values->path(row.key), with(labels, label.key, row.key), source);
    }
    if (others) read_others(*others, label.key, labels, values->path(any_other), source, seen);
    const std::size_t before = context_.problems.size();
    complete(label, seen, labels, values->path());
    if (context_.problems.size() > before)
      for (const Member* row : unknown) no_reading_has(label.key, *row, values->path());
  }

  static Labels with(Labels labels, const std::string& label, const std::string& value) {
    labels.emplace_back(label, value);
    return labels;
  }

  /// The row for every value that has none of its own, as if each had it. A row that none needs is checked all the same.
  void read_others(const Member& row, const std::string& label, const Labels& labels, const std::string& path,
                   const std::string& source, std::set<std::string>& seen) {
    std::vector<std::string> others;
    if (context_.readings_known)
      for (const Labels& reading : context_.readings)
        if (const std::string* value = quantities::label_value(reading, label);
            value && quantities::holds_for(labels, reading) && seen.insert(*value).second)
          others.push_back(*value);
    if (others.empty()) {
      InputQuantity unused = out_;
      std::vector<std::string> notes = context_.notes;
      QuantityReader(card_, unused, context_).read(row.value, path, with(labels, label, any_other), source);
      context_.notes = std::move(notes);
    }
    for (const std::string& value : others) read(row.value, path, with(labels, label, value), source);
  }

  /// A value that no reading has is a mistake where another is missing; else it is of readings that are not here.
  void no_reading_has(const std::string& label, const Member& row, const std::string& path) {
    const auto& values = context_.label_values[label];
    context_.problems.add(row, fmt::format("{}: no reading has {} = '{}'", path, label, row.key), "",
                          did_you_mean(row.key, {values.begin(), values.end()}));
  }

  void complete(const Member& label, const std::set<std::string>& seen, const Labels& labels, const std::string& path) {
    if (!context_.readings_known) return;
    std::set<std::string> told;
    for (const Labels& reading : context_.readings) {
      if (!quantities::holds_for(labels, reading)) continue;
      const std::string* value = quantities::label_value(reading, label.key);
      if (value && seen.contains(*value)) continue;
      if (!told.insert(value ? *value : "").second) continue;
      context_.problems.add(label,
                            value ? fmt::format("{}: no value for {} = '{}'", path, label.key, *value)
                                  : fmt::format("{}: a reading has no label '{}'", path, label.key),
                            "every reading needs one");
    }
  }

  /// Entries that no reading uses are left out, and said so.
  void keep(Entry entry, const Node& node, const std::string& path) {
    check_limits(entry, card_, node, path, context_.problems);
    const auto uses = [&](const Labels& reading) { return quantities::holds_for(entry.labels, reading); };
    if (context_.readings_known && !entry.labels.empty() &&
        std::none_of(context_.readings.begin(), context_.readings.end(), uses)) {
      context_.notes.push_back(fmt::format("{}: not used, because no reading has {}", path, text_of(entry.labels)));
      context_.unused.push_back({out_.name, out_.unit, out_.si_unit, {std::move(entry)}});
      return;
    }
    out_.entries.push_back(std::move(entry));
  }

  const QuantityCard& card_;
  InputQuantity& out_;
  Context& context_;
};

std::string limit_text(const Limits& limits, bool low, const QuantityCard& card) {
  const bool open = low ? limits.low_open : limits.high_open;
  return fmt::format("must be {} {}", low ? (open ? "above" : "at least") : (open ? "below" : "at most"),
                     shown(low ? limits.low : limits.high, card));
}

} // namespace

bool check_limits(double value, const QuantityCard& card, const Node& node, const std::string& path,
                  Problems& problems) {
  const Limits& limits = card.limits;
  if (limits.contain(value)) return true;
  const bool low = limits.low_open ? value <= limits.low : value < limits.low;
  problems.add(node, fmt::format("{}: {} is impossible", path, shown(value, card)), limit_text(limits, low, card),
               card.si_unit == "K" && limits.contain(value - units::to_si(0, "degC", "K"))
                   ? "state a difference of temperatures in K: 2 degC are 275.15 K"
                   : "");
  return false;
}

void check_limits(const Entry& entry, const QuantityCard& card, const Node& node, const std::string& path,
                  Problems& problems) {
  double estimate = entry.value, least = entry.value, most = entry.value;
  for (const Component& c : entry.components) {
    estimate += c.distribution.mean();
    least += c.distribution.support_low();
    most += c.distribution.support_high();
  }
  if (!check_limits(estimate, card, node, path, problems)) return;
  const Limits& limits = card.limits;
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
  std::set<std::string> names;
  bool replaced = false;
  std::size_t number = 0;
  const auto& keys = table.node().members; // an indication has none: its values are its readings
  const auto found = std::ranges::find(keys, "value", &Member::key);
  const Node* stated = found == keys.end() ? nullptr : &found->value;
  for (Table& component : table.tables("components")) {
    component.declare(component_keys());
    const std::string name = component.text("name").value_or(fmt::format("c{}", ++number));
    if (name.empty() || !names.insert(name).second)
      component.refuse(fmt::format("the name '{}' {}", name, name.empty() ? "is empty" : "is already used"),
                       "components need different names");
    Form form{si_unit, false, 0.0, 0.0, stated ? std::optional(value) : std::nullopt, stated};
    const bool mean_counts = component.has("observations") && !value_given;
    if (mean_counts) form.value.reset();
    if (mean_counts && replaced)
      component.refuse("two components have observations, but there is no value", "either mean could be the value",
                       "state the value");
    replaced |= mean_counts;
    auto uncertainty = read_uncertainty(component, form, context);
    component.refuse_unknown();
    if (!uncertainty) continue;
    if (mean_counts) value = uncertainty->value;
    // The estimate of an earlier result without uncertainty remains: a deviation, as with the other components.
    if (uncertainty->exact && component.has("from")) value += uncertainty->value - form.value.value_or(0);
    uncertainty->component.name = name;
    if (!uncertainty->exact) out.push_back(std::move(uncertainty->component));
  }
  return out;
}

Shape component_shape() { return shape::table(component_keys(), uncertainty_rules); }

Shape quantity_shape() {
  return shape::any_of({shape::reference("measure"), shape::table(quantity_keys(), uncertainty_rules)});
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
