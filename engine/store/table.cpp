#include "store/table.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "store/field_writer.h"

namespace gumshoe::store {

Display display(const std::string& unit, const std::string& si_unit) {
  try {
    return {unit, units::from_si(1, unit, si_unit, units::Kind::difference),
            units::from_si(0, unit, si_unit, units::Kind::point)};
  } catch (const InputError&) {
    return {si_unit, 1, 0};
  }
}

hdf5::Units common_units(const std::vector<std::string>& si_units) {
  if (si_units.empty()) return "1";
  const bool same = std::all_of(si_units.begin(), si_units.end(), [&](const auto& u) { return u == si_units[0]; });
  return same ? hdf5::Units(si_units[0]) : hdf5::Units("see units", true);
}

Table::Table(hid_t group, std::string dimension, std::size_t rows, const std::vector<std::string>& names)
    : group_(group), dimension_(std::move(dimension)), rows_(rows) {
  if (rows_ == 0) return;
  if (names.empty()) {
    scale_ = hdf5::create_dimension(group_, dimension_, rows_);
    return;
  }
  if (names.size() != rows_) throw OutputError("cannot write dimension '" + dimension_ + "'", "it has another length");
  hdf5::Handle scale = hdf5::create_dataset(group_, dimension_, hdf5::text_type(), {rows_}, "1", "names of the rows");
  hdf5::write_texts(scale, names);
  hdf5::make_scale(scale, dimension_);
  scale_ = {std::move(scale), dimension_};
}

template <class T>
void Table::numbers(const std::string& name, const std::vector<T>& values, const hdf5::Units& units,
                    const std::string& long_name) {
  if (rows_ == 0) return;
  if (values.size() != rows_) throw OutputError("cannot write column '" + name + "'", "it has another length");
  const hdf5::Handle dataset =
      hdf5::create_dataset(group_, name, hdf5::file_type<T>(), {rows_}, units.text.empty() ? "1" : units, long_name);
  hdf5::require(H5Dwrite(dataset, hdf5::memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                "write a column");
  hdf5::attach(dataset, {&scale_});
}
template void Table::numbers(const std::string&, const std::vector<double>&, const hdf5::Units&, const std::string&);
template void Table::numbers(const std::string&, const std::vector<std::uint64_t>&, const hdf5::Units&,
                             const std::string&);
template void Table::numbers(const std::string&, const std::vector<int>&, const hdf5::Units&, const std::string&);
template void Table::numbers(const std::string&, const std::vector<std::uint8_t>&, const hdf5::Units&,
                             const std::string&);

void Table::texts(const std::string& name, const std::vector<std::string>& values, const std::string& long_name) {
  if (rows_ == 0) return;
  if (values.size() != rows_) throw OutputError("cannot write column '" + name + "'", "it has another length");
  const hdf5::Handle dataset = hdf5::create_dataset(group_, name, hdf5::text_type(), {rows_}, "1", long_name);
  hdf5::write_texts(dataset, values);
  hdf5::attach(dataset, {&scale_});
}

void Table::values(const std::string& name, const std::vector<analysis::Value>& values, const hdf5::Units& units,
                   const std::string& long_name) {
  if (rows_ == 0 || values.empty()) return;
  const auto all = [&]<class T>(std::vector<T> column) {
    for (const analysis::Value& value : values) column.push_back(std::get<T>(value));
    return column;
  };
  std::visit(
      [&]<class T>(const T&) {
        if constexpr (std::is_same_v<T, std::string>)
          texts(name, all(std::vector<T>{}), long_name);
        else if constexpr (std::is_same_v<T, bool>) {
          const std::vector<bool> flags = all(std::vector<T>{});
          numbers(name, std::vector<int>(flags.begin(), flags.end()), units, long_name);
        } else
          numbers(name, all(std::vector<T>{}), units, long_name);
      },
      values.front());
}

hdf5::Units file_units(const analysis::Unit& unit, const hdf5::Units& row, const std::string& output) {
  switch (unit.in) {
  case analysis::In::point:
  case analysis::In::difference: return row;
  case analysis::In::output: return output;
  case analysis::In::coefficient:
    if (row.note) return {"output units / units", true};
    return units::quotient(output, row.text);
  default: return {unit.stated, unit.note};
  }
}

void Table::units(const std::vector<std::string>& si_units, const std::vector<std::string>& display_units,
                  const std::string& prefix) {
  std::vector<std::string> shown;
  std::vector<double> factors, offsets;
  for (std::size_t i = 0; i < si_units.size(); ++i) {
    const Display d = display(display_units[i], si_units[i]);
    shown.push_back(d.units);
    factors.push_back(d.factor);
    offsets.push_back(d.offset);
  }
  texts(prefix + "units", si_units, "SI unit of the row");
  texts(prefix + "display_units", shown, "unit shown to people");
  numbers(prefix + "display_factor", factors, "1", "display unit over SI unit: shown = SI * factor");
  numbers(prefix + "display_offset", offsets, "1",
          "added to a point on a scale, not to a difference or an uncertainty");
}

void Table::matrix(const std::string& name, const Table& columns, const std::vector<double>& values,
                   const hdf5::Units& units, const std::string& long_name) {
  if (rows_ == 0 || columns.rows_ == 0) return;
  if (values.size() != rows_ * columns.rows_)
    throw OutputError("cannot write matrix '" + name + "'", "it has another shape");
  const hdf5::Handle dataset =
      hdf5::create_dataset(group_, name, hdf5::file_type<double>(), {rows_, columns.rows_}, units, long_name);
  hdf5::require(H5Dwrite(dataset, hdf5::memory_type<double>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                "write a matrix");
  hdf5::attach(dataset, {&scale_, &columns.scale_});
}

void write_display(hid_t object, const std::string& unit, const std::string& si_unit) {
  const Display shown = display(unit, si_unit);
  hdf5::write_attribute(object, "display_units", shown.units);
  hdf5::write_attribute(object, "display_factor", shown.factor);
  hdf5::write_attribute(object, "display_offset", shown.offset);
}

void write_output(hid_t group, const propagation::Output& output) {
  hdf5::write_attribute(group, "output", output.name);
  hdf5::write_attribute(group, "units", output.si_unit);
  write_display(group, output.unit, output.si_unit);
}

} // namespace gumshoe::store
