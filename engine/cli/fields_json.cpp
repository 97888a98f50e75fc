#include "cli/fields_json.h"

#include <cmath>

#include "base/units.h"

namespace gumshoe::cli {

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

double converted(double si, analysis::Unit unit, const analysis::RowUnit& row, const analysis::RowUnit& output) {
  const auto kind = unit.in == analysis::In::point ? units::Kind::point : units::Kind::difference;
  const analysis::RowUnit in = analysis::shown_in(unit, row, output);
  return units::from_si(si, in.shown, in.si, kind);
}

Json shown(const analysis::Value& value, analysis::Unit unit, const analysis::RowUnit& row,
           const analysis::RowUnit& output) {
  if (const double* x = std::get_if<double>(&value)) return number(converted(*x, unit, row, output));
  return std::visit([](const auto& other) { return Json(other); }, value);
}

void put(Json& object, std::string_view path, Json value) {
  object[Json::json_pointer("/" + std::string(path))] = std::move(value);
}

} // namespace gumshoe::cli
