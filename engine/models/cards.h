#pragma once
/// Limits, and rows of cards in the units that most quantities have.
#include "base/card.h"
#include "base/si.h"

namespace gumshoe::models {

/// Limit of what has none, in m, rad, s or 1: no machine is that large.
inline constexpr double huge = 1e3;
inline constexpr Limits any{-huge, huge}, positive{0, huge, true}, not_negative{0, huge};
/// Angles that have a tangent.
inline constexpr Limits below_90{-90 * si::deg, 90 * si::deg, true, true};

/// A quantity without its units; QuantityCard says what the fields mean.
struct Unitless {
  std::string_view name;
  double default_value = 0;
  Limits limits = any;
  std::string_view symbol{}, meaning{};
};
constexpr QuantityCard in_units(const Unitless& q, std::string_view unit, std::string_view si_unit) {
  return {q.name, unit, si_unit, q.default_value, q.limits, q.symbol, q.meaning};
}
/// Rows shown in mm, deg, s or as plain numbers.
constexpr QuantityCard in_mm(const Unitless& q) { return in_units(q, "mm", "m"); }
constexpr QuantityCard in_deg(const Unitless& q) { return in_units(q, "deg", "rad"); }
constexpr QuantityCard in_s(const Unitless& q) { return in_units(q, "s", "s"); }
constexpr QuantityCard pure(const Unitless& q) { return in_units(q, "1", "1"); }

/// A condition, an indication or a measurand likewise.
struct Variable {
  std::string_view name;
  double default_value = 0;
  std::string_view meaning{};
};
constexpr VariableCard shown_in_mm(const Variable& v) { return {v.name, "mm", "m", v.default_value, v.meaning}; }
constexpr VariableCard shown_in_deg(const Variable& v) { return {v.name, "deg", "rad", v.default_value, v.meaning}; }
constexpr VariableCard shown_in_s(const Variable& v) { return {v.name, "s", "s", v.default_value, v.meaning}; }
constexpr VariableCard shown_pure(const Variable& v) { return {v.name, "1", "1", v.default_value, v.meaning}; }

/// A count or another figure that says how the evaluation went.
constexpr VariableCard shown_diagnostic(const Variable& v) {
  return {v.name, "1", "1", v.default_value, v.meaning, true};
}

} // namespace gumshoe::models
