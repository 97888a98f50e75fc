#pragma once
/// JSON as the fields of a row say (analysis/fields.h): in the units people are shown, null for what is no finite number.
#include <nlohmann/json.hpp>

#include "analysis/fields.h"
#include "propagation/run.h"

namespace gumshoe::analysis {

using Json = nlohmann::ordered_json;

Json number(double x);

/// A number in its shown unit; a coefficient in the output's over the row's.
double converted(double si, Unit unit, const RowUnit& row, const RowUnit& output = {});
/// Unit of a coefficient: "mV/V"; "1" where both units are the same.
std::string coefficient_unit(const RowUnit& row, const RowUnit& output);
Json shown(const Value& value, Unit unit, const RowUnit& row,
           const RowUnit& output = {});

/// Puts a value where `path` says: "first/value" into the object `first`.
void put(Json& object, std::string_view path, Json value);

/// Adds the fields that JSON shows. `output`: the output that the table is about, if it is about one.
template <class Row>
void add_json(Json& object, const Fields<Row>& fields, const Row& row,
                const propagation::Output& output = {}) {
  const RowUnit unit = unit_of(row);
  for (const auto& field : fields.list)
    if (!field.shown.json.empty())
      put(object, field.name(field.shown.json),
          field.get ? shown(field.get(row), field.unit, unit, {output.unit, output.si_unit})
                    : Json(field.unit.in == In::output_units ? output.unit : unit.shown));
}

template <class Row>
Json json(const Fields<Row>& fields, const Row& row, const propagation::Output& output = {}) {
  Json object = Json::object();
  add_json(object, fields, row, output);
  return object;
}

} // namespace gumshoe::analysis
