#pragma once
/// Writes rows and structs as their fields say (analysis/fields.h). Private to this folder.
#include "analysis/fields.h"
#include "store/table.h"

namespace gumshoe::store {

/// The units of a dataset; `row` and `output`: SI units of its rows and of the output that the table is about.
hdf5::Units file_units(const analysis::Unit& unit, const hdf5::Units& row, const std::string& output);

/// One dataset per field, and those of the rows' unit. `rows`: a range of Row. `output`: the output that the table is
/// about, if it is about one.
template <class Row, class Rows>
void write_fields(Table& table, const analysis::Fields<Row>& fields, const Rows& rows,
                  const propagation::Output& output = {}) {
  std::vector<std::string> si, shown;
  for (const Row& row : rows) {
    auto unit = analysis::unit_of(row);
    si.push_back(std::move(unit.si)), shown.push_back(std::move(unit.shown));
  }
  const hdf5::Units common = common_units(si);
  for (const auto& field : fields.list) {
    if (field.unit.in == analysis::In::units) table.units(si, shown);
    if (!field.get) continue;
    std::vector<analysis::Value> values;
    for (const Row& row : rows) values.push_back(field.get(row));
    table.values(std::string(field.key), values, file_units(field.unit, common, output.si_unit),
                 std::string(field.meaning));
  }
}

/// Names of the rows: the field that names them, unless the dimension itself has its name.
template <class Row> std::vector<std::string> row_names(const analysis::Fields<Row>& fields, const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const std::string_view key : {"name", "input", "quantity", "output"})
    for (const auto& field : fields.list) {
      if (field.key != key || key == fields.dimension || !names.empty()) continue;
      for (const Row& row : rows) names.push_back(std::get<std::string>(field.get(row)));
    }
  return names;
}

/// The table as a group of its own, also without rows.
template <class Row>
void write_table(hid_t parent, const analysis::Fields<Row>& fields, const std::vector<Row>& rows) {
  const hdf5::Handle group = hdf5::create_group(parent, std::string(fields.where));
  Table table(group, std::string(fields.dimension), rows.size(), row_names(fields, rows));
  write_fields(table, fields, rows);
}

/// A group's attributes.
template <class Struct>
void write_attributes(hid_t group, const analysis::Fields<Struct>& fields, const Struct& object) {
  for (const auto& field : fields.list)
    if (field.get)
      std::visit([&](const auto& value) { hdf5::write_attribute(group, std::string(field.key), value); },
                 field.get(object));
}

/// A study of one output: its attributes and a table of its rows.
template <class Study, class Row>
void write_study(hid_t group, const Study& study, const analysis::Fields<Study>& attributes,
                 const analysis::Fields<Row>& fields, const std::vector<Row>& rows) {
  write_output(group, study.output);
  write_attributes(group, attributes, study);
  Table table(group, std::string(fields.dimension), rows.size(), row_names(fields, rows));
  write_fields(table, fields, rows, study.output);
}

} // namespace gumshoe::store
