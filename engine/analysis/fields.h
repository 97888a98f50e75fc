#pragma once
/// The vocabulary in which a field of a result is described once: its name in the result file, where its value stands,
/// what it is measured in, what it means, and where else it is shown. The file's writer, the JSON and CSV printers, the
/// figures of `gumshoe gauge`, the report's CSV tables and the tables of engine/store/README.md all follow from it.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace gumshoe::analysis {

/// A value of a field, SI. A flag is stored as 0 or 1.
using Value = std::variant<double, std::uint64_t, int, bool, std::string>;

/// What a number is measured in: its `units` in the file, and how it converts to the unit shown to people.
enum class In {
  one,          ///< a ratio, a count, a flag or text
  point,        ///< a point on a scale, in the unit of its row
  difference,   ///< a difference, width or uncertainty, in the unit of its row
  output,       ///< a difference in the unit of the output that the table is about
  coefficient,  ///< in the output's unit over the row's
  as_stated,    ///< in the unit that the field names; never converted
  units,        ///< no number: the unit of the row, in the file with its display columns
  output_units, ///< no number and not in the file: the unit of the output that the table is about
  run,          ///< not of the row: an attribute of the whole file, repeated in CSV
};
struct Unit {
  In in;
  std::string_view stated = "1";
  bool note = false; ///< `stated` is no unit: it says which one the numbers have
  constexpr Unit(In kind) : in(kind) {}
  explicit constexpr Unit(std::string_view text) : in(In::as_stated), stated(text) {}
  static constexpr Unit noted(std::string_view text) {
    Unit unit(text);
    unit.note = true;
    return unit;
  }
};

/// Names under which a field is shown; empty: not there.
struct Shown {
  std::string_view json = {};  ///< key; a path such as "first/value" where objects are nested
  std::string_view csv = {};   ///< column of the report's CSV table
  std::string_view gauge = {}; ///< figure of `gumshoe gauge`
};
inline constexpr std::string_view same = "="; ///< the field's key; of a figure of gauge the whole name is given

template <class Row> struct Field {
  std::string_view key; ///< dataset or attribute
  Value (*get)(const Row&);
  Unit unit;
  std::string_view meaning;
  Shown shown = {};
  Value (*standard_error)(const Row&) = nullptr; ///< of the figure

  constexpr std::string_view name(std::string_view shown_as) const { return shown_as == same ? key : shown_as; }
};

/// Fields of one kind of row, in the order of the CSV columns.
template <class Row> struct Fields {
  std::string_view where;     ///< group of the file: "summary", "budget/<k>"
  std::string_view dimension; ///< of the datasets; empty: the fields are attributes of the group
  std::span<const Field<Row>> list;
  std::string_view csv = {}; ///< name of the CSV table; empty: none
};

/// Reads a member, or a member of a member: of<&Summary::shortest, &Interval::low>.
template <auto... members> inline constexpr auto of = [](const auto& row) -> Value {
  const auto& value = (row.*....*members);
  if constexpr (std::is_same_v<decltype(value), const char&>)
    return std::string(1, value);
  else
    return value;
};

/// Standard error that a 95 % confidence interval of a normal figure stands for.
template <auto low, auto high> inline constexpr auto half_width = [](const auto& row) -> Value {
  return (row.*high - row.*low) / (2 * 1.959963984540054);
};

/// The unit that a row's numbers are shown in, and the SI unit; "1" for rows without a unit.
struct RowUnit {
  std::string shown = "1", si = "1";
};
template <class Row> RowUnit unit_of(const Row& row) {
  if constexpr (requires { row.output.si_unit; })
    return {row.output.unit, row.output.si_unit};
  else if constexpr (requires { row.si_unit; })
    return {row.unit, row.si_unit};
  else
    return {};
}

/// The unit of a field's numbers, of that of its row and that of the output that the table is about.
inline RowUnit shown_in(const Unit& unit, const RowUnit& row, const RowUnit& output) {
  return unit.in == In::output ? output : unit.in == In::point || unit.in == In::difference ? row : RowUnit{};
}

} // namespace gumshoe::analysis
