#include "analysis/fields_json.h"

#include <cmath>

#include "base/units.h"

namespace gumshoe::analysis {

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

double converted(double si, Unit unit, const RowUnit& row, const RowUnit& output) {
  const auto kind = unit.in == In::point ? units::Kind::point : units::Kind::difference;
  const auto factor = [](const RowUnit& u) { return units::from_si(1, u.shown, u.si, units::Kind::difference); };
  if (unit.in == In::coefficient) return si * factor(output) / factor(row);
  const RowUnit in = shown_in(unit, row, output);
  return units::from_si(si, in.shown, in.si, kind);
}

std::string coefficient_unit(const RowUnit& row, const RowUnit& output) {
  return row.shown == output.shown ? "1" : units::quotient(output.shown, row.shown);
}

Json shown(const Value& value, Unit unit, const RowUnit& row,
           const RowUnit& output) {
  if (const double* x = std::get_if<double>(&value)) return number(converted(*x, unit, row, output));
  return std::visit([](const auto& other) { return Json(other); }, value);
}

void put(Json& object, std::string_view path, Json value) {
  object[Json::json_pointer("/" + std::string(path))] = std::move(value);
}

} // namespace gumshoe::analysis
