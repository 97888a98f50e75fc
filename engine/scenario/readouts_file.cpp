#include "scenario/readouts_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenario/data_column.h"

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
  keys.push_back(where_key());
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
    decimal_ = read_decimal(table_);
    if (csv) {
      columns(*csv);
    } else {
      complete_ = false;
      for (const char* key : {"labels", "conditions", "where"}) table_.find(key);
    }
    const RowFilter filter = csv && complete_ ? RowFilter(table_, *csv, labels_) : RowFilter{};
    table_.find("where");
    table_.refuse_unknown();
    out.csv = csv;
    if (!data || !complete_) return out;
    out.decimal = decimal_;
    out.fixed = filter.fixed();
    out.column = csv->header[static_cast<std::size_t>(data->column)].text;
    for (std::size_t i = 0; i < csv->rows.size(); ++i) {
      const auto& row = csv->rows[i];
      Labels labels;
      std::vector<double> here = conditions;
      if (!filter.keeps_columns(row) || !read_row(*csv, row, labels, here)) continue;
      const auto value = read_cell(*csv, row[static_cast<std::size_t>(data->column)], data->unit, decimal_,
                                   {std::string(card_.si_unit)}, context_.problems);
      if (!value) continue;
      add_row(out.all, labels, here, *value, i);
      if (filter.keeps_labels(row)) add_row(out.used, labels, here, *value, i);
    }
    if (out.used.empty() && context_.problems.size() == problems) nothing(*csv, filter);
    return out;
  }

private:
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

  bool read_row(const Csv& csv, const std::vector<CsvCell>& row, Labels& labels, std::vector<double>& conditions) {
    bool good = true;
    for (const auto& [label, column] : labels_) {
      const CsvCell& cell = row[column];
      if (cell.text.empty()) {
        context_.problems.add(Problem{csv.at(cell), fmt::format("the label '{}' is empty", label), "", ""});
        good = false;
      }
      labels.emplace_back(label, cell.text);
    }
    for (const ConditionColumn& c : conditions_) {
      const auto value = read_cell(csv, row[c.column], c.unit, decimal_, {std::string(model_.conditions[c.condition].si_unit)},
                                   context_.problems);
      if (value)
        conditions[c.condition] = *value;
      else
        good = false;
    }
    return good;
  }

  void nothing(const Csv& csv, const RowFilter& filter) {
    const Node* at = table_.find("where");
    context_.problems.add(at ? *at : table_.node(),
                          at ? fmt::format("{}: no row of '{}' has {}", table_.path("where"), csv.file, filter.text())
                             : fmt::format("{}: '{}' has no rows", table_.path(), csv.file));
  }

  Table table_;
  const VariableCard& card_;
  const ModelCard& model_;
  Context& context_;
  bool complete_ = true;
  char decimal_ = '.';
  RowFilter::Columns labels_; ///< label, column
  std::vector<ConditionColumn> conditions_;
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
