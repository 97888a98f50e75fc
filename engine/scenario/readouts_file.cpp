#include "scenario/readouts_file.h"

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

} // namespace

std::vector<Key> readouts_file_keys() {
  std::vector<Key> keys = data_column_keys();
  keys.push_back({"labels", shape::map(shape::text()), "label = column"});
  keys.push_back({"conditions", shape::map(shape::table(column_keys())), "conditions that are columns"});
  keys.push_back({"where", shape::reference("labels"), "only the rows with these labels"});
  return keys;
}

namespace {

/// readings = { file, column, unit, labels, conditions, where }
class FileReader {
public:
  FileReader(Table table, const VariableCard& card, const ModelCard& model, Context& context)
      : table_(std::move(table)), card_(card), model_(model), context_(context) {}

  IndicationReadouts read(const std::vector<double>& conditions) {
    IndicationReadouts out;
    const std::size_t problems = context_.problems.size();
    table_.declare(readouts_file_keys());
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
      if (quantities::holds_for(where_, labels)) add_row(out.used, labels, here, *value, i);
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
        if (column < 0 || reserved(m, labels->path(), context_.problems))
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
        context_.problems.add(m, fmt::format("{}: {} has no condition '{}'", conditions->path(), model_.name, m.key),
                              "", did_you_mean(m.key, names_of(model_.conditions)));
        complete_ = false;
        continue;
      }
      auto one = conditions->table(m.key);
      if (!one) continue;
      one->declare(column_keys());
      if (one->require("column")) {
        const int column = find_column(*one, "column", csv);
        const std::string unit = one->text("unit").value_or("1"), si(model_.conditions[index].si_unit);
        complete_ &= column >= 0;
        if (!units::convertible(unit, si)) {
          one->refuse_key("unit", fmt::format("'{}' is not {}", unit, units::kind_name(si)), "must convert to " + si);
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
    where_ = read_own_labels(*where);
    std::vector<std::string> names;
    for (const LabelColumn& l : labels_) names.push_back(l.label);
    for (const Member& m : where->members()) {
      if (!complete_ || std::ranges::find(names, m.key) != names.end()) continue;
      context_.problems.add(m, fmt::format("{}: '{}' is not a label of these readings", where->path(), m.key),
                            "where selects rows by their labels", did_you_mean(m.key, names));
    }
  }

  bool read_row(const Csv& csv, const std::vector<CsvCell>& row, Labels& labels, std::vector<double>& conditions) {
    bool good = true;
    for (const LabelColumn& l : labels_) {
      const CsvCell& cell = row[l.column];
      if (cell.text.empty()) {
        context_.problems.add(Problem{csv.at(cell), fmt::format("the label '{}' is empty", l.label), "", ""});
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
        if (const std::string* v = quantities::label_value(g.labels, label)) values.insert(*v);
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

} // namespace

bool reserved(const Member& label, const std::string& path, Problems& problems) {
  if (label.key != "reading") return false;
  problems.add(label, path + ": 'reading' cannot be a label", "as a scope it means 'every reading'");
  return true;
}

Labels read_own_labels(Table table) {
  Labels labels;
  for (const Member& m : table.members()) {
    const auto value = read_text(m.value, table.path(m.key), table.problems());
    if (value && !reserved(m, table.path(), table.problems())) labels.emplace_back(m.key, *value);
  }
  return labels;
}

std::size_t condition_index(const ModelCard& model, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(model.conditions, name, &VariableCard::name) -
                                  model.conditions.begin());
}

IndicationReadouts read_readouts_file(Table table, const VariableCard& card, const ModelCard& model,
                                      const std::vector<double>& conditions, Context& context) {
  return FileReader(std::move(table), card, model, context).read(conditions);
}

} // namespace gumshoe::scenario
