#include "scenario/readouts_file.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "scenario/file_pattern.h"
#include "scenario/number_column.h"
#include "scenario/row_filter.h"
#include "scenario/stretches.h"

namespace gumshoe::scenario {
namespace {

using quantities::Labels;

/// Keys that [data] and the readings of an indication have in common.
std::vector<Key> shared_keys() {
  std::vector<Key> keys = data_file_keys();
  keys.push_back({"labels", shape::map(shape::text()), "label = column"});
  keys.push_back({"conditions", shape::map(number_column_shape()), "conditions that are columns"});
  keys.push_back(where_key());
  keys.push_back({"repeats", shape::words({"mean", "apart"}),
                  "rows of equal labels and conditions: \"mean\" takes them as one reading, \"apart\" as readings of "
                  "their own, with the label row",
                  false, "\"mean\""});
  return keys;
}

/// The label that tells rows apart: the number of the row of the table, from 1.
constexpr const char* row_label = "row";

/// Readouts of the file, gathered by their labels and conditions in the order in which these occur first.
class Groups {
public:
  void add(const Labels& labels, const std::vector<double>& conditions, double value, std::size_t row) {
    const auto [at, fresh] = known_.try_emplace({labels, conditions}, groups_.size());
    if (fresh) groups_.push_back({labels, conditions, {}, 0});
    Readouts& group = groups_[at->second];
    group.values.push_back(value);
    group.rows.push_back(row);
    ++group.repeats;
  }
  std::vector<Readouts> take() { return std::move(groups_); }

private:
  std::vector<Readouts> groups_;
  std::map<std::pair<Labels, std::vector<double>>, std::size_t> known_;
};

/// readings = { column, unit } with what else they say of the file, and [data] where they name no file of their own.
class FileReader {
public:
  FileReader(Table& indication, const VariableCard& card, const ModelCard& model, Context& context)
      : node_(column_table(*indication.find("readings"))), own_(node_, indication.path("readings"), context.problems),
        card_(card), model_(model), context_(context), problems_before_(context.problems.size()) {
    if (context.data && context.data->kind == Node::Kind::table && !own_.has("file"))
      shared_.emplace(*context.data, "data", context.problems);
  }

  IndicationReadouts read(const std::vector<double>& conditions) {
    IndicationReadouts out;
    own_.declare(readouts_file_keys());
    out.file = read_data_file(shared_ ? *shared_ : own_, context_.files, true);
    if (out.file && shared_) out.file->units = read_units(*shared_, *out.file->csv);
    if (out.file) {
      file_ = &*out.file;
      labels();
      for (Table* table : tables()) filter_.add(*table, *file_->csv, labels_);
      keep_apart();
      out.fixed = filter_.fixed();
      rows(conditions, out);
    }
    for (const char* key : {"column", "unit", "labels", "conditions", "where", "repeats"}) own_.find(key);
    own_.refuse_unknown();
    if (out.used.empty() && out.file && good()) nothing();
    return out;
  }

private:
  bool good() const { return context_.problems.size() == problems_before_; }

  /// [data] comes first: what an indication says itself replaces it.
  std::vector<Table*> tables() {
    if (!shared_) return {&own_};
    return {&*shared_, &own_};
  }

  void labels() {
    for (Table* from : tables())
      if (auto labels = from->table("labels"))
        for (const Member& m : labels->members()) {
          const int column = find_column(*labels, m.key, *file_->csv);
          if (column < 0 || reserved(m, labels->path(), context_.problems)) continue;
          std::erase_if(labels_, [&](const auto& known) { return known.first == m.key; });
          labels_.push_back({m.key, static_cast<std::size_t>(column)});
        }
  }

  void keep_apart() {
    for (Table* from : tables())
      if (const auto choice = from->choice("repeats", {"mean", "apart"})) apart_ = *choice == 1;
    if (apart_ && std::ranges::find(labels_, row_label, &RowFilter::Columns::value_type::first) != labels_.end())
      own_.refuse(fmt::format("the label '{}' is already used", row_label),
                  "repeats that are kept apart have this label", "choose another name for the label");
  }

  std::map<std::size_t, NumberColumn> conditions() {
    std::map<std::size_t, NumberColumn> out;
    for (Table* from : tables()) {
      auto conditions = from->table("conditions");
      if (!conditions) continue;
      for (const Member& m : conditions->members()) {
        const std::size_t index = condition_index(model_, m.key);
        if (index == model_.conditions.size()) {
          context_.problems.add(m, fmt::format("{}: {} has no condition '{}'", conditions->path(), model_.name, m.key),
                                "", did_you_mean(m.key, names_of(model_.conditions)));
          continue;
        }
        if (auto column =
                NumberColumn::read(*conditions, m.key, *file_, {std::string(model_.conditions[index].si_unit)}))
          out.insert_or_assign(index, std::move(*column));
      }
    }
    return out;
  }

  /// `readings` itself is the column of a number.
  std::optional<NumberColumn> readings() {
    Node parent, column;
    for (const Member& m : node_.members)
      if (m.key == "column" || m.key == "unit") column.members.push_back(m);
    column.line = own_.node().line;
    column.column = own_.node().column;
    parent.members = {{"readings", column.line, column.column, column}};
    const std::string path = own_.path();
    Table table(parent, path.substr(0, path.rfind('.')), context_.problems);
    return NumberColumn::read(table, "readings", *file_, {std::string(card_.si_unit)});
  }

  void rows(std::vector<double> here, IndicationReadouts& out) {
    const auto column = readings();
    const auto columns = conditions();
    if (!column || !good()) return;
    out.column = column->name();
    const Csv& csv = *file_->csv;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < csv.rows.size(); ++i)
      if (filter_.keeps_columns(csv.rows[i])) rows.push_back(i);
    const auto values = column->values(rows, context_.problems);
    std::map<std::size_t, std::vector<std::optional<double>>> at;
    for (const auto& [condition, from] : columns) at[condition] = from.values(rows, context_.problems);
    const std::vector<std::string> blocks = stretches_of(rows, at);
    Groups used, all;
    std::size_t next = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto& row = csv.rows[rows[k]];
      const bool counts = filter_.keeps_labels(row);
      const auto nameless = [&](const auto& label) { return row[label.second].text.empty(); };
      if (!counts && std::ranges::any_of(labels_, nameless)) continue;
      Labels labels = labels_of(row);
      if (counts && next < blocks.size()) labels.emplace_back(stretch_label, blocks[next++]);
      bool good = values[k].has_value();
      for (const auto& [condition, value] : at) {
        good &= value[k].has_value();
        here[condition] = value[k].value_or(0);
      }
      if (!good) continue;
      if (apart_) labels.emplace_back(row_label, std::to_string(rows[k] + 1));
      all.add(labels, here, *values[k], rows[k]);
      if (counts) used.add(labels, here, *values[k], rows[k]);
    }
    out.used = used.take();
    out.all = all.take();
    state_repeats_of_files(out.used);
  }

  /// Notes which readings are means over files of one pattern, because no label tells the files apart.
  void state_repeats_of_files(const std::vector<Readouts>& readings) const {
    const Csv& csv = *file_->csv;
    const auto of_several = std::ranges::count_if(readings, [&](const Readouts& r) {
      const auto part = [&](std::size_t row) { return csv.rows[row][0].part; };
      return std::ranges::any_of(r.rows, [&](std::size_t row) { return part(row) != part(r.rows[0]); });
    });
    if (of_several == 0) return;
    const std::filesystem::path pattern(csv.file);
    const auto names = FilePattern(csv.file).names();
    const std::string name = names.empty() ? "run" : names[0];
    context_.note(fmt::format("{} reading{} of {} {} over several files: {}labels = {{ {} = \"{}\" }} tells them apart",
                              of_several, of_several == 1 ? "" : "s", pattern.filename().string(),
                              of_several == 1 ? "is a mean" : "are means",
                              names.empty() ? fmt::format("{{{}}} in place of *, and ", name) : "", name, name));
  }

  Labels labels_of(const std::vector<CsvCell>& row) {
    Labels out;
    for (const auto& [label, column] : labels_) {
      if (row[column].text.empty())
        context_.problems.add(Problem{file_->csv->at(row[column]), fmt::format("the label '{}' is empty", label),
                                      fmt::format("column '{}'", file_->csv->header[column].text), ""});
      out.emplace_back(label, row[column].text);
    }
    return out;
  }

  /// By row used, in their order; empty without blocks that are stretches.
  std::vector<std::string> stretches_of(const std::vector<std::size_t>& rows,
                                        const std::map<std::size_t, std::vector<std::optional<double>>>& at) {
    if (!has_stretches(context_.trace) || !good()) return {};
    if (std::ranges::find(labels_, stretch_label, &RowFilter::Columns::value_type::first) != labels_.end()) {
      own_.refuse(fmt::format("the label '{}' is already used", stretch_label),
                  "blocks that are stretches have this name", "choose another name for the label");
      return {};
    }
    std::vector<std::size_t> used;
    std::map<std::string, StretchAxis> axes;
    for (const auto& [condition, values] : at)
      axes[std::string(model_.conditions[condition].name)].si_unit = model_.conditions[condition].si_unit;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!filter_.keeps_labels(file_->csv->rows[rows[k]])) continue;
      used.push_back(rows[k]);
      for (const auto& [condition, values] : at)
        axes[std::string(model_.conditions[condition].name)].values.push_back(values[k].value_or(0));
    }
    return stretches(*context_.trace, {*file_, used, axes}, context_.problems);
  }

  void nothing() {
    Table* of = nullptr;
    for (Table* table : tables())
      if (table->has("where")) of = table;
    if (of)
      context_.problems.add(*of->find("where"), fmt::format("{}: no row of '{}' has {}", of->path("where"),
                                                            file_->csv->file, filter_.text()));
    else
      own_.refuse(fmt::format("'{}' has no rows", file_->csv->file));
  }

  const Node node_;
  Table own_;
  std::optional<Table> shared_;
  const VariableCard& card_;
  const ModelCard& model_;
  Context& context_;
  const std::size_t problems_before_;
  const DataFile* file_ = nullptr;
  RowFilter::Columns labels_; ///< label, column
  bool apart_ = false;        ///< each row is a reading
  RowFilter filter_;
};

} // namespace

std::vector<Key> readouts_file_keys() {
  std::vector<Key> keys = shared_keys();
  keys.insert(keys.begin() + 1, {{"column", shape::text(), "column name in the first row of the file", true},
                                 {"unit", shape::text(),
                                  "unit of the numbers in the column; default: that of [data], or a plain number"}});
  return keys;
}

std::vector<Key> data_keys() {
  std::vector<Key> keys = shared_keys();
  keys.front().required = true;
  keys.insert(keys.begin() + 3, units_key());
  return keys;
}

void check_data(Table& top, Context& context) {
  auto data = top.table("data");
  if (!data) return;
  data->declare(data_keys());
  if (const auto file = read_data_file(*data, context.files, true)) read_units(*data, *file->csv);
  for (const Key& key : data_keys()) data->find(key.name);
  data->refuse_unknown();
}

void refuse_unread_data(Table& top, Context& context) {
  const Node* const data = top.find("data");
  if (!data) return;
  const Node* const indications = top.find("indications");
  const auto refers = [](const Member& indication) {
    const auto& members = indication.value.members;
    const auto readings = std::ranges::find(members, "readings", &Member::key);
    if (readings == members.end()) return false;
    const Node& node = readings->value;
    return node.kind == Node::Kind::text ||
           (node.kind == Node::Kind::table &&
            std::ranges::find(node.members, "file", &Member::key) == node.members.end());
  };
  if (!indications || std::ranges::none_of(indications->members, refers))
    context.problems.add(*data, "data: no indication reads a column of it", "",
                         "readings = { column = \"...\", unit = \"mm\" }");
}

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

IndicationReadouts read_readouts_file(Table& indication, const VariableCard& card, const ModelCard& model,
                                      const std::vector<double>& conditions, Context& context) {
  return FileReader(indication, card, model, context).read(conditions);
}

} // namespace gumshoe::scenario
