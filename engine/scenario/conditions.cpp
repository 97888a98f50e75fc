#include "scenario/conditions.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/units.h"
#include "quantities/cells.h"

namespace gumshoe::scenario {
namespace {

double spread_value(const Spread& s, std::size_t i, std::size_t n) {
  return s.first + (s.last - s.first) * static_cast<double>(i) / static_cast<double>(n);
}

std::vector<Key> spread_keys() {
  return {{"spread", shape::list(shape::reference("measure"), R"("minItems": 2, "maxItems": 2)"),
           "first and last value; the last is excluded", true},
          {"readings", shape::whole(1, most_readings), "number of values", true}};
}

class ConditionsReader {
public:
  ConditionsReader(std::optional<Table> table, const ModelCard& model) : table_(std::move(table)), model_(model) {}

  Conditions read() {
    std::vector<double> common;
    for (std::size_t c = 0; c < model_.conditions.size(); ++c) {
      common.push_back(model_.conditions[c].default_value);
      if (table_) one(c, common.back());
    }
    if (table_) table_->refuse_unknown();
    out_.listed = length_ > 0;
    for (std::size_t r = 0; r < std::max<std::size_t>(1, length_); ++r) {
      Commanded reading{{}, common};
      for (const List& list : lists_) {
        reading.values[list.condition] = list.values[r];
        reading.labels.emplace_back(model_.conditions[list.condition].name,
                                    condition_text(list.values[r], model_.conditions[list.condition]));
      }
      out_.readings.push_back(std::move(reading));
    }
    return std::move(out_);
  }

private:
  struct List {
    std::size_t condition;
    std::vector<double> values;
  };

  void one(std::size_t c, double& value) {
    const std::string name(model_.conditions[c].name);
    const Dimension dimension{std::string(model_.conditions[c].si_unit)};
    if (!table_->has(name)) return;
    const Node& node = *table_->find(name);
    if (node.kind == Node::Kind::array)
      list(c, *table_->array(name), dimension, node);
    else if (node.kind == Node::Kind::table)
      spread(c, *table_->table(name), dimension, node);
    else if (const auto v = table_->measure(name, dimension))
      value = *v;
  }

  void list(std::size_t c, const std::vector<Node>& items, const Dimension& dimension, const Node& node) {
    List list{c, {}};
    const std::string path = table_->path(std::string(model_.conditions[c].name));
    for (const Node& item : items)
      if (const auto v = read_measure(item, path, dimension, table_->problems())) list.values.push_back(*v);
    if (items.empty()) table_->problems().add(node, path + ": empty");
    if (list.values.size() == items.size()) add(std::move(list), node);
  }

  void spread(std::size_t c, Table table, const Dimension& dimension, const Node& node) {
    table.declare(spread_keys());
    const Node* const between = table.require("spread", "spread = [\"0 deg\", \"360 deg\"]");
    const Node* const count = table.require("readings", "readings = 12");
    const auto* ends = table.array("spread");
    const auto n = table.integer("readings", 1, most_readings);
    table.refuse_unknown();
    if (!between || !count || !ends || !n) return;
    if (ends->size() != 2) {
      table.add(table.path("spread") + ": a first and a last value are needed", "",
                "spread = [\"0 deg\", \"360 deg\"]");
      return;
    }
    const auto first = read_measure((*ends)[0], table.path("spread"), dimension, table.problems());
    const auto last = read_measure((*ends)[1], table.path("spread"), dimension, table.problems());
    if (!first || !last) return;
    List list{c, {}};
    out_.spreads.push_back({c, *first, *last});
    for (std::size_t i = 0; i < static_cast<std::size_t>(*n); ++i)
      list.values.push_back(spread_value(out_.spreads.back(), i, static_cast<std::size_t>(*n)));
    add(std::move(list), node);
  }

  void add(List list, const Node& node) {
    if (list.values.empty()) return;
    if (length_ != 0 && length_ != list.values.size()) {
      table_->problems().add(node,
                             fmt::format("conditions: {} values of {} but {} of {}", list.values.size(),
                                         model_.conditions[list.condition].name, length_,
                                         model_.conditions[lists_.front().condition].name),
                             "lists need equal lengths, one value per reading");
      return;
    }
    length_ = list.values.size();
    lists_.push_back(std::move(list));
  }

  std::optional<Table> table_;
  const ModelCard& model_;
  Conditions out_;
  std::vector<List> lists_;
  std::size_t length_ = 0;
};

} // namespace

Shape condition_shape() {
  const Shape measure = shape::reference("measure");
  return shape::any_of({measure, shape::list(measure, R"("minItems": 1)"), shape::table(spread_keys())});
}

std::string condition_text(double value, const VariableCard& card) {
  const std::string unit(card.unit);
  const double number = units::from_si(value, unit, std::string(card.si_unit));
  return fmt::format("{:.9g}{}", number, units::suffix(unit));
}

Conditions read_conditions(std::optional<Table> table, const ModelCard& model) {
  return ConditionsReader(std::move(table), model).read();
}

void take_readings(Scenario& scenario, const ModelCard& model, std::size_t n) {
  quantities::Reading first = scenario.readings.front();
  first.indications.clear();
  first.scatter.clear();
  std::erase_if(first.labels, [&](const auto& label) {
    return std::ranges::any_of(scenario.spreads,
                               [&](const Spread& s) { return model.conditions[s.condition].name == label.first; });
  });
  scenario.readings.clear();
  for (std::size_t i = 0; i < n; ++i) {
    quantities::Reading reading = first;
    for (const Spread& s : scenario.spreads) {
      reading.conditions[s.condition] = spread_value(s, i, n);
      reading.labels.emplace_back(model.conditions[s.condition].name,
                                  condition_text(reading.conditions[s.condition], model.conditions[s.condition]));
    }
    if (scenario.spreads.empty() && n > 1) reading.labels.emplace_back("repeat", fmt::format("{}", i + 1));
    scenario.readings.push_back(std::move(reading));
  }
}

void narrow_to_reading(Scenario& alone, const Scenario& all, std::size_t reading) {
  alone.readings = {all.readings[reading]};
  if (!all.trace.order.empty()) alone.trace.order = {0};
  for (std::size_t c = 0; c < all.trace.columns.size(); ++c)
    if (const auto& values = all.trace.columns[c].values; !values.empty())
      alone.trace.columns[c].values = {values[reading]};
  for (std::size_t e = 0; e < all.stated_effects.size(); ++e)
    for (std::size_t p = 0; p < all.stated_effects[e].parts.size(); ++p)
      alone.stated_effects[e].parts[p].loading = {all.stated_effects[e].parts[p].loading[reading]};
  const std::string number = fmt::format("{}", reading + 1);
  for (std::size_t q = 0; q < all.quantities.size(); ++q) {
    const auto& entries = all.quantities[q].entries;
    const auto number_of = [](const quantities::Entry& e) {
      return quantities::label_value(e.labels, quantities::reading_label);
    };
    if (std::ranges::none_of(entries, number_of)) continue;
    alone.quantities[q].entries.clear();
    for (quantities::Entry e : entries) {
      if (const std::string* own = number_of(e); own && *own != number) continue;
      for (auto& [label, value] : e.labels)
        if (label == quantities::reading_label) value = "1";
      alone.quantities[q].entries.push_back(std::move(e));
    }
  }
}

void update_loadings(Scenario& s) {
  const bool recorded = !s.trace.columns.empty() && std::ranges::all_of(s.trace.columns, [&](const auto& column) {
    return column.values.size() == s.readings.size();
  });
  for (StatedEffect& effect : s.stated_effects)
    for (StatedPart& part : effect.parts) {
      if (!part.loading_at || (effect.of_columns && !recorded)) continue;
      part.loading.clear();
      for (std::size_t r = 0; r < s.readings.size(); ++r) {
        std::vector<double> columns;
        if (effect.of_columns)
          for (const TraceColumn& column : s.trace.columns) columns.push_back(column.values[r]);
        part.loading.push_back(part.loading_at(s.readings[r].conditions, columns));
      }
    }
}

} // namespace gumshoe::scenario
