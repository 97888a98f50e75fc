/// Quantities as a scenario writes them, "0.6 um", and their units.
#include "base/dimension.h"
#include "base/error.h"
#include "base/units.h"
#include "fuzz/harness.h"

namespace gumshoe::fuzz {

void unit(std::string_view input) {
  const units::Measure measure = units::parse(input);
  const std::string si = units::si_unit_of(measure.unit);
  units::base_units_of(measure.unit);
  units::kind_name(si);
  Dimension::of(measure.unit).words();
  for (const auto kind : {units::Kind::point, units::Kind::difference})
    units::from_si(units::to_si(measure.number, measure.unit, si, kind), measure.unit, si, kind);
}

} // namespace gumshoe::fuzz
