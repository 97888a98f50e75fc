#pragma once
/// Reads an input quantity: a plain value, a value with one distribution, components, or `by` tables.
#include "base/card.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

/// The row of a by-table for every value of its label that has no row of its own.
inline constexpr const char* any_other = "*";

/// Shape of an input quantity, and of one component of its uncertainty.
Shape quantity_shape();
Shape component_shape();

/// The quantity at its default: what a scenario that does not name it means.
quantities::InputQuantity default_quantity(const QuantityCard& card, const std::string& name);

/// Reads the node called `path` in messages. Values outside the card's limits are refused.
quantities::InputQuantity read_quantity(const Node& node, const std::string& path, const QuantityCard& card,
                                        const std::string& name, Context& context);

/// A list of deviations under the key "components"; `value` is used where an observation's mean
/// replaces an absent one. Names default to c1, c2, ... and must differ.
std::vector<quantities::Component> read_components(Table& table, const std::string& si_unit, bool value_given,
                                                   double& value, Context& context);

/// Refuses a value outside the card's limits, and says which it is outside.
bool check_limits(double value, const QuantityCard& card, const Node& node, const std::string& path,
                  Problems& problems);

/// Refuses estimates outside the limits, and bounded distributions that reach beyond them.
void check_limits(const quantities::Entry& entry, const QuantityCard& card, const Node& node, const std::string& path,
                  Problems& problems);

} // namespace gumshoe::scenario
