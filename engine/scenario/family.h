#pragma once
/// Parameters of the distribution families as they stand in a scenario.
#include <optional>

#include "quantities/distribution.h"
#include "scenario/uncertainty.h"

namespace gumshoe::scenario {

/// A distribution of deviations and the value they are from.
struct Located {
  quantities::Distribution distribution;
  double value = 0;
};

/// Reads the family's parameters; nullopt and problems if something is wrong.
std::optional<Located> read_family(Table& table, const quantities::FamilyCard& card, const Form& form,
                                   Context& context);

/// `u`, or `U` with `k`: the standard uncertainty, above 0; nullopt and a problem otherwise.
std::optional<double> read_standard_uncertainty(Table& table, const Form& form, Context& context);

/// A width in SI: absolute, or a share of the value ("0.1 %", "2 ppm"). A plain number written as a share itself, or
/// without a value, has absolute shares; so has an angle in um/m.
std::optional<double> read_width(Table& table, const std::string& key, const Form& form, Context& context);

} // namespace gumshoe::scenario
