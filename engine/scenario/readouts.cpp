#include "scenario/readouts.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenario/readouts_file.h"

namespace gumshoe::scenario {
namespace {

using quantities::Labels;

constexpr std::int64_t most_repeats = 1'000'000;

std::vector<Key> row_keys() {
  return {{"values", shape::list(shape::reference("measure"), R"("minItems": 1)"), "values of this reading"},
          {"repeats", shape::whole(1, most_repeats), "number of repeats in a virtual experiment; excludes values"}};
}

std::vector<double> read_list(const std::vector<Node>& items, const std::string& path, const VariableCard& card,
                              Problems& problems) {
  std::vector<double> values;
  for (const Node& item : items)
    if (const auto v = read_measure(item, path, {std::string(card.si_unit)}, problems)) values.push_back(*v);
  return values;
}

/// rows = [ { rod = "rod 1", setup = "1", feed = "4 mm/min", values = ["..."] }, { ..., repeats = 3 } ]
void read_row(Table& row, const VariableCard& card, const ModelCard& model, const std::vector<double>& conditions,
              IndicationReadouts& out) {
  Readouts group{{}, conditions, {}, 1};
  if (const auto* items = row.array("values")) {
    group.values = read_list(*items, row.path("values"), card, row.problems());
    group.repeats = static_cast<int>(group.values.size());
    if (items->empty()) row.add(row.path("values") + ": empty");
  }
  if (const auto repeats = row.integer("repeats", 1, most_repeats)) {
    if (row.has("values"))
      row.refuse("repeats is given together with values", "the number of values is counted", "leave it out");
    group.repeats = static_cast<int>(*repeats);
  }
  for (const Member& m : row.members()) {
    if (m.key == "values" || m.key == "repeats" || reserved(m, row.path(), row.problems())) continue;
    const std::size_t c = condition_index(model, m.key);
    if (c < model.conditions.size()) {
      const Dimension dimension{std::string(model.conditions[c].si_unit)};
      group.conditions[c] = row.measure(m.key, dimension).value_or(conditions[c]);
    } else if (const auto value = row.text(m.key)) {
      group.labels.emplace_back(m.key, *value);
    }
  }
  // The same labels in another order are the same reading.
  std::sort(group.labels.begin(), group.labels.end());
  const auto same = std::ranges::find_if(
      out.used, [&](const Readouts& g) { return g.labels == group.labels && g.conditions == group.conditions; });
  if (same == out.used.end()) {
    out.used.push_back(std::move(group));
  } else {
    same->values.insert(same->values.end(), group.values.begin(), group.values.end());
    if (row.has("repeats") && same->repeats + group.repeats > most_repeats)
      return row.refuse_key("repeats", fmt::format("the rows of this reading have more than {} in all", most_repeats));
    same->repeats += group.repeats;
  }
}

Labels joined(Labels labels, const Commanded& reading) {
  labels.insert(labels.end(), reading.labels.begin(), reading.labels.end());
  return labels;
}

void one_each(const Conditions& commanded, const Labels& labels, const std::vector<double>& values, std::size_t written,
              Table& table, IndicationReadouts& out) {
  const std::size_t n = commanded.readings.size();
  if (written != n)
    table.add(fmt::format("{}: {} readings but {} listed conditions", table.path("readings"), written, n),
              "one condition per reading is needed");
  for (std::size_t i = 0; i < std::min(n, values.size()); ++i)
    out.used.push_back({joined(labels, commanded.readings[i]), commanded.readings[i].values, {values[i]}, 1});
}

} // namespace

std::vector<Key> readout_keys() {
  const Shape measure = shape::reference("measure"), text_or_number = R"("type": ["string", "number"])";
  return {
      {"readings", shape::any_of({shape::list(measure, R"("minItems": 1)"), shape::text(), shape::table(readouts_file_keys())}),
       "repeats of one reading, or a column of a data file: that of [data], or one of its own"},
      {"rows", shape::list(shape::table(row_keys(), "", text_or_number), R"("minItems": 1)"),
       "labels and conditions of readings, with their values"},
      {"labels", shape::reference("labels"), "labels of the readings in `readings`"},
  };
}

IndicationReadouts read_readouts(Table& table, const VariableCard& card, const ModelCard& model,
                                 const Conditions& commanded, Context& context) {
  IndicationReadouts out;
  Problems& problems = context.problems;
  const std::vector<double>& conditions = commanded.readings.front().values;
  const Node* readings = table.find("readings");
  const auto* rows = table.array("rows");
  if (readings && table.has("rows"))
    table.refuse("readings is given together with rows", "both state what was read", "leave one out");
  const bool in_file = readings && (readings->kind == Node::Kind::table || readings->kind == Node::Kind::text);
  if (context.files.readings_replaced() && !in_file)
    problems.add(readings ? *readings : table.node(),
                 fmt::format("{}: there is no data file for --data to replace", table.path()),
                 "its readings are written in the scenario", "readings = { file = \"...\", column = \"...\" }");
  Labels labels;
  if (table.has("labels")) {
    if (in_file) {
      table.refuse_key("labels", "the labels of a data file are its columns", "", "move it into readings");
    } else if (auto own = table.table("labels")) {
      labels = read_own_labels(*own);
    }
  }
  if (commanded.listed && (rows || in_file))
    table.refuse("conditions are listed, one per reading", "here the file's columns or the rows state them",
                 "remove the list from [conditions]");
  if (in_file) return read_readouts_file(table, card, model, conditions, context);
  if (readings) {
    if (const auto* items = table.array("readings")) {
      const auto values = read_list(*items, table.path("readings"), card, problems);
      if (items->empty()) table.refuse_key("readings", "empty");
      if (commanded.listed)
        one_each(commanded, labels, values, items->size(), table, out);
      else
        out.used.push_back({labels, conditions, values, static_cast<int>(values.size())});
    }
  } else if (rows) {
    if (rows->empty()) table.refuse_key("rows", "empty");
    for (Table& row : table.tables("rows")) read_row(row, card, model, conditions, out);
  } else if (!table.has("rows")) {
    for (const Commanded& reading : commanded.readings)
      out.used.push_back({joined(labels, reading), reading.values, {}, 1});
  }
  out.all = out.used;
  return out;
}

} // namespace gumshoe::scenario
