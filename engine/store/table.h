#pragma once
/// A group whose datasets are the columns of one table: 1-D, one named dimension, `units` and
/// `long_name` on each. Private to this folder.
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/fields.h"
#include "propagation/run.h"
#include "store/hdf5.h"

namespace gumshoe::store {

/// What turns SI numbers into the unit people are shown: SI * factor (+ offset if a point on a scale,
/// such as a temperature, and no difference or uncertainty).
struct Display {
  std::string units;
  double factor = 1, offset = 0;
};
/// Falls back to the SI unit if `unit` does not convert: no finished run is lost over its display.
Display display(const std::string& unit, const std::string& si_unit);

/// The one unit of all rows, or the note "see units" where rows differ.
hdf5::Units common_units(const std::vector<std::string>& si_units);

/// One member of every row, as a column.
template <class Row, class Member> auto column(const std::vector<Row>& rows, Member member) {
  std::vector<std::decay_t<std::invoke_result_t<Member, const Row&>>> values;
  values.reserve(rows.size());
  for (const Row& row : rows) values.push_back(std::invoke(member, row));
  return values;
}

class Table {
public:
  /// A new dimension of `rows` rows in `group`, which must outlive this. A table without rows writes nothing. `names`:
  /// the dimension's coordinate, by which rows are selected; empty: a dimension without values.
  Table(hid_t group, std::string dimension, std::size_t rows, const std::vector<std::string>& names = {});

  /// T: double, std::uint64_t, int or std::uint8_t.
  template <class T>
  void numbers(const std::string& name, const std::vector<T>& values, const hdf5::Units& units,
               const std::string& long_name);
  void texts(const std::string& name, const std::vector<std::string>& values, const std::string& long_name);
  /// A column of whichever of these types its values are; all are of one type.
  void values(const std::string& name, const std::vector<analysis::Value>& values, const hdf5::Units& units,
              const std::string& long_name);
  /// The columns `units`, `display_units`, `display_factor` and `display_offset`, their names after `prefix`.
  void units(const std::vector<std::string>& si_units, const std::vector<std::string>& display_units,
             const std::string& prefix = "");
  /// A dataset of this table's rows and the rows of another table of the same group, row-major.
  void matrix(const std::string& name, const Table& columns, const std::vector<double>& values,
              const hdf5::Units& units, const std::string& long_name);

  const hdf5::Scale& scale() const { return scale_; }

private:
  hid_t group_;
  std::string dimension_;
  hsize_t rows_;
  hdf5::Scale scale_;
};

/// The attributes `display_units`, `display_factor` and `display_offset`.
void write_display(hid_t object, const std::string& unit, const std::string& si_unit);

/// The attributes `output`, `units`, `display_units`, `display_factor` and `display_offset` of a group that tells of
/// one output.
void write_output(hid_t group, const propagation::Output& output);

/// A group `name` of sub-groups 000, 001, ..., one per item; none if there are no items.
template <class Item, class Write>
void write_numbered(hid_t file, const std::string& name, const std::vector<Item>& items, Write write) {
  if (items.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, name);
  for (std::size_t k = 0; k < items.size(); ++k) {
    const hdf5::Handle one = hdf5::create_group(group, fmt::format("{:03d}", k));
    write(one, items[k]);
  }
}

} // namespace gumshoe::store
