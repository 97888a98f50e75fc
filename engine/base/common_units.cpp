/// The units that most scenarios use. tests/unit/units_test.cpp compares every row with the database.
#include <numbers>
#include <string_view>

#include "base/unit_definition.h"

namespace gumshoe::units {

namespace {

struct Row {
  std::string_view name, base;
  double factor = 1, offset = 0;
};

constexpr double pi = std::numbers::pi;

constexpr Row rows[] = {
    {"1", "1"},
    {"%", "1", 1 / 100.0},
    {"m", "m"},
    {"mm", "m", 1 / 1e3},
    {"um", "m", 1 / 1e6},
    {"nm", "m", 1 / 1e9},
    {"m2", "m2"},
    {"mm2", "m2", 1 / 1e6},
    {"m3", "m3"},
    {"m-1", "m-1"},
    {"1/mm", "m-1", 1e3},
    {"rad", "rad"},
    {"mrad", "rad", 1 / 1e3},
    {"urad", "rad", 1 / 1e6},
    {"deg", "rad", pi / 180},
    {"s", "s"},
    {"ms", "s", 1 / 1e3},
    {"us", "s", 1 / 1e6},
    {"min", "s", 60},
    {"h", "s", 3600},
    {"Hz", "s-1"},
    {"1/s", "s-1"},
    {"m/s", "m.s-1"},
    {"mm/s", "m.s-1", 1 / 1e3},
    {"m/min", "m.s-1", 1 / 60.0},
    {"mm/min", "m.s-1", 1 / 60e3},
    {"um/h", "m.s-1", 1 / 3600e6},
    {"m/s2", "m.s-2"},
    {"rad/s", "s-1.rad"},
    {"rpm", "s-1.rad", pi / 30},
    {"K", "K"},
    {"degC", "K", 1, 273.15},
    {"1/K", "K-1"},
    {"um/K", "m.K-1", 1 / 1e6},
    {"m/K", "m.K-1"},
    {"um/m", "1", 1 / 1e6},
    {"um/m/K", "K-1", 1 / 1e6},
    {"kg", "kg"},
    {"g", "kg", 1 / 1e3},
    {"kg/m3", "m-3.kg"},
    {"N", "m.kg.s-2"},
    {"kN", "m.kg.s-2", 1e3},
    {"Pa", "m-1.kg.s-2"},
    {"J", "m2.kg.s-2"},
    {"W", "m2.kg.s-3"},
    {"A", "A"},
    {"mA", "A", 1 / 1e3},
    {"V", "m2.kg.s-3.A-1"},
    {"mV", "m2.kg.s-3.A-1", 1 / 1e3},
    {"ohm", "m2.kg.s-3.A-2"},
    {"mol", "mol"},
};

} // namespace

std::vector<std::string> common_unit_names() {
  std::vector<std::string> names;
  for (const Row& row : rows) names.emplace_back(row.name);
  return names;
}

std::optional<Unit> common_unit(const std::string& name) {
  for (const Row& row : rows)
    if (row.name == name)
      return Unit{row.factor, row.offset, std::string(row.base), row.base.ends_with("rad") ? 1 : 0,
                  row.base == "1" && row.name != "1"};
  return std::nullopt;
}

} // namespace gumshoe::units
