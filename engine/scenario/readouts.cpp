#include "scenario/readouts.h"

#include <algorithm>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

using quantities::Labels;

void add_row(std::vector<Readouts>& groups, const Labels& labels, const std::vector<double>& conditions, double value,
             std::size_t row) {
  for (Readouts& g : groups) {
    if (g.labels != labels || g.conditions != conditions) continue;
    g.values.push_back(value);
    g.rows.push_back(row);
    ++g.repeats;
    return;
  }
  groups.push_back({labels, conditions, {value}, 1, {row}});
}

bool reserved(const std::string& label, const Member& at, const std::string& path, Problems& problems) {
  if (label != "reading") return false;
  problems.add(at.line, at.column, path + ": 'reading' cannot be a label", "as a scope it means 'every reading'");
  return true;
}

Labels read_labels(Table table) {
  Labels labels;
  for (const Member& m : table.members()) {
    const auto value = read_text(m.value, table.path(m.key), table.problems());
    if (value && !reserved(m.key, m, table.path(), table.problems())) labels.emplace_back(m.key, *value);
  }
  return labels;
}

std::size_t condition_index(const ModelCard& model, const std::string& name) {
  const auto it =
      std::find_if(model.conditions.begin(), model.conditions.end(), [&](const auto& c) { return c.name == name; });
  return static_cast<std::size_t>(it - model.conditions.begin());
}

std::vector<std::string> condition_names(const ModelCard& model) {
  std::vector<std::string> names;
  for (const VariableCard& c : model.conditions) names.emplace_back(c.name);
  return names;
}

/// readings = { file, column, unit, labels, conditions, where }
class FileReader {
public:
  FileReader(Table table, const VariableCard& card, const ModelCard& model, Context& context)
      : table_(std::move(table)), card_(card), model_(model), context_(context) {}

  IndicationReadouts read(const std::vector<double>& conditions) {
    IndicationReadouts out;
    const std::size_t problems = context_.problems.size();
    const auto data = read_data_column(table_, std::string(card_.si_unit), context_.files, true);
    // Without the file its other columns cannot be judged.
    const Csv* csv = nullptr;
    if (const Node* file = table_.find("file"); file && file->kind == Node::Kind::text) {
      Problems silent(context_.problems.file());
      csv = context_.files.open_readings(*file, table_.path("file"), silent);
    }
    if (csv) {
      columns(*csv);
    } else {
      complete_ = false;
      for (const char* key : {"labels", "conditions", "where"}) table_.find(key);
    }
    where();
    table_.refuse_unknown();
    out.csv = csv;
    if (!data || !complete_) return out;
    out.column = csv->header[static_cast<std::size_t>(data->column)].text;
    for (std::size_t i = 0; i < csv->rows.size(); ++i) {
      const auto& row = csv->rows[i];
      Labels labels;
      std::vector<double> here = conditions;
      if (!read_row(*csv, row, labels, here)) continue;
      const auto value = read_cell(*csv, row[static_cast<std::size_t>(data->column)], data->unit,
                                   {std::string(card_.si_unit)}, context_.problems);
      if (!value) continue;
      add_row(out.all, labels, here, *value, i);
      if (matches(labels, where_)) add_row(out.used, labels, here, *value, i);
    }
    if (out.used.empty() && context_.problems.size() == problems) nothing(*csv, out);
    return out;
  }

private:
  struct LabelColumn {
    std::string label;
    std::size_t column;
  };
  struct ConditionColumn {
    std::size_t condition, column;
    std::string unit;
  };

  void columns(const Csv& csv) {
    if (auto labels = table_.table("labels")) {
      for (const Member& m : labels->members()) {
        const int column = find_column(*labels, m.key, csv);
        if (column < 0 || reserved(m.key, m, labels->path(), context_.problems))
          complete_ = false;
        else
          labels_.push_back({m.key, static_cast<std::size_t>(column)});
      }
    }
    auto conditions = table_.table("conditions");
    if (!conditions) return;
    for (const Member& m : conditions->members()) {
      const std::size_t index = condition_index(model_, m.key);
      if (index == model_.conditions.size()) {
        context_.problems.add(m.line, m.column,
                              fmt::format("{}: {} has no condition '{}'", conditions->path(), model_.name, m.key), "",
                              did_you_mean(m.key, condition_names(model_)));
        complete_ = false;
        continue;
      }
      auto one = conditions->table(m.key);
      if (!one) continue;
      if (one->require("column")) {
        const int column = find_column(*one, "column", csv);
        const std::string unit = one->text("unit").value_or("1"), si(model_.conditions[index].si_unit);
        complete_ &= column >= 0;
        if (!units::convertible(unit, si)) {
          one->add(fmt::format("{}: '{}' is not {}", one->path("unit"), unit, units::kind_name(si)),
                   "must convert to " + si);
          complete_ = false;
        }
        if (complete_) conditions_.push_back({index, static_cast<std::size_t>(column), unit});
      }
      one->refuse_unknown();
    }
  }

  void where() {
    auto where = table_.table("where");
    if (!where) return;
    where_ = read_labels(*where);
    std::vector<std::string> names;
    for (const LabelColumn& l : labels_) names.push_back(l.label);
    for (const Member& m : where->members()) {
      if (!complete_ || std::find(names.begin(), names.end(), m.key) != names.end()) continue;
      context_.problems.add(m.line, m.column,
                            fmt::format("{}: '{}' is not a label of these readings", where->path(), m.key),
                            "where selects rows by their labels", did_you_mean(m.key, names));
    }
  }

  bool read_row(const Csv& csv, const std::vector<CsvCell>& row, Labels& labels, std::vector<double>& conditions) {
    bool good = true;
    for (const LabelColumn& l : labels_) {
      const CsvCell& cell = row[l.column];
      if (cell.text.empty()) {
        context_.problems.add(
            InputError(std::vector<Problem>{{csv.at(cell), fmt::format("the label '{}' is empty", l.label), "", ""}}));
        good = false;
      }
      labels.emplace_back(l.label, cell.text);
    }
    for (const ConditionColumn& c : conditions_) {
      const auto value = read_cell(csv, row[c.column], c.unit, {std::string(model_.conditions[c.condition].si_unit)},
                                   context_.problems);
      if (value)
        conditions[c.condition] = *value;
      else
        good = false;
    }
    return good;
  }

  void nothing(const Csv& csv, const IndicationReadouts& out) {
    std::string remedy;
    for (const auto& [label, value] : where_) {
      std::set<std::string> values;
      for (const Readouts& g : out.all)
        if (const std::string* v = find_label(g.labels, label)) values.insert(*v);
      if (!values.contains(value)) remedy = did_you_mean(value, {values.begin(), values.end()});
    }
    const Node* at = table_.find("where");
    context_.problems.add(
        at ? *at : table_.node(),
        where_.empty() ? fmt::format("{}: '{}' has no rows", table_.path(), csv.file)
                       : fmt::format("{}: no row of '{}' has {}", table_.path("where"), csv.file, text_of(where_)),
        "", remedy);
  }

  Table table_;
  const VariableCard& card_;
  const ModelCard& model_;
  Context& context_;
  bool complete_ = true;
  std::vector<LabelColumn> labels_;
  std::vector<ConditionColumn> conditions_;
  Labels where_;
};

std::vector<double> read_list(const std::vector<Node>& items, const std::string& path, const VariableCard& card,
                              Problems& problems) {
  std::vector<double> values;
  for (const Node& item : items)
    if (const auto v = read_measure(item, path, {std::string(card.si_unit)}, problems)) values.push_back(*v);
  return values;
}

/// rows = [ { rod = "rod 1", setup = "1", feed = "4 mm/min", values = ["..."] }, { ..., repeats = 3 } ]
void read_rows(const std::vector<Node>& rows, const std::string& path, const VariableCard& card, const ModelCard& model,
               const std::vector<double>& conditions, Context& context, IndicationReadouts& out) {
  Problems& problems = context.problems;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto table = as_table(rows[i], fmt::format("{}[{}]", path, i + 1), problems);
    if (!table) continue;
    Readouts group{{}, conditions, {}, 1};
    if (const auto* items = table->array("values")) {
      group.values = read_list(*items, table->path("values"), card, problems);
      group.repeats = static_cast<int>(group.values.size());
      if (items->empty()) table->add(table->path("values") + ": empty");
    }
    if (const auto repeats = table->integer("repeats", 1, 1'000'000)) {
      if (table->has("values"))
        table->add(table->path() + ": repeats is given together with values", "the number of values is counted", "leave it out");
      group.repeats = static_cast<int>(*repeats);
    }
    for (const Member& m : table->members()) {
      if (m.key == "values" || m.key == "repeats" || reserved(m.key, m, table->path(), problems)) continue;
      const std::size_t c = condition_index(model, m.key);
      if (c < model.conditions.size()) {
        const Dimension dimension{std::string(model.conditions[c].si_unit)};
        group.conditions[c] = table->measure(m.key, dimension).value_or(conditions[c]);
      } else if (const auto value = table->text(m.key)) {
        group.labels.emplace_back(m.key, *value);
      }
    }
    // The same labels in another order are the same reading.
    std::sort(group.labels.begin(), group.labels.end());
    const auto same = std::find_if(out.used.begin(), out.used.end(), [&](const Readouts& g) {
      return g.labels == group.labels && g.conditions == group.conditions;
    });
    if (same == out.used.end()) {
      out.used.push_back(std::move(group));
    } else {
      same->values.insert(same->values.end(), group.values.begin(), group.values.end());
      same->repeats += group.repeats;
    }
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

IndicationReadouts read_readouts(Table& table, const VariableCard& card, const ModelCard& model,
                                 const Conditions& commanded, Context& context) {
  IndicationReadouts out;
  Problems& problems = context.problems;
  const std::vector<double>& conditions = commanded.readings.front().values;
  const Node* readings = table.find("readings");
  const auto* rows = table.array("rows");
  if (readings && table.has("rows")) {
    table.add(table.path() + ": readings is given together with rows", "both state what was read", "leave one out");
  }
  if (context.files.readings_replaced() && (!readings || readings->kind != Node::Kind::table))
    problems.add(readings ? *readings : table.node(),
                 fmt::format("{}: there is no data file for --data to replace", table.path()),
                 "its readings are written in the scenario", "readings = { file = \"...\", column = \"...\" }");
  Labels labels;
  if (table.has("labels")) {
    if (readings && readings->kind == Node::Kind::table) {
      problems.add(*table.find("labels"), table.path("labels") + ": the labels of a data file are its columns", "",
                   "move it into readings");
    } else if (auto own = table.table("labels")) {
      labels = read_labels(*own);
    }
  }
  if (commanded.listed && (rows || (readings && readings->kind == Node::Kind::table)))
    table.add(table.path() + ": conditions are listed, one per reading", "here the file's columns or the rows state them",
              "remove the list from [conditions]");
  if (readings && readings->kind == Node::Kind::table) {
    return FileReader(Table(*readings, table.path("readings"), problems), card, model, context).read(conditions);
  }
  if (readings) {
    if (const auto* items = table.array("readings")) {
      const auto values = read_list(*items, table.path("readings"), card, problems);
      if (items->empty()) problems.add(*readings, table.path("readings") + ": empty");
      if (commanded.listed)
        one_each(commanded, labels, values, items->size(), table, out);
      else
        out.used.push_back({labels, conditions, values, static_cast<int>(values.size())});
    }
  } else if (rows) {
    if (rows->empty()) problems.add(*table.find("rows"), table.path("rows") + ": empty");
    read_rows(*rows, table.path("rows"), card, model, conditions, context, out);
  } else if (!table.has("rows")) {
    for (const Commanded& reading : commanded.readings)
      out.used.push_back({joined(labels, reading), reading.values, {}, 1});
  }
  out.all = out.used;
  return out;
}

} // namespace gumshoe::scenario
