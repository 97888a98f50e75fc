#pragma once
/// Two rotary axes with location errors, as every model has them that measures between table and head: rows of its card,
/// by default of B and C in the table, and the axes made of such quantities. A described machine renames the rows
/// (location_machine.h).
#include "chain/two_rotary_axes.h"
#include "models/cards.h"

namespace gumshoe::models {

constexpr QuantityCard in_um(const Unitless& q) { return in_units(q, "um", "m"); }
constexpr QuantityCard in_mrad(const Unitless& q) { return in_units(q, "mrad", "rad"); }

// clang-format off: a row of a card stays together
#define GUMSHOE_LOCATION_ROWS                                                                                         \
    models::in_um({.name = "E_X0B", .symbol = "dx_BR", .meaning = "position of the B axis along X"}),                         \
    models::in_um({.name = "E_Y0C", .symbol = "dy_BR", .meaning = "position of the C axis along Y"}),                         \
    models::in_um({.name = "E_Z0B", .symbol = "dz_BR", .meaning = "position of the B axis along Z"}),                         \
    models::in_mrad({.name = "E_A0B", .limits = below_90, .symbol = "alpha_BR", .meaning = "orientation of the B axis about X"}),\
    models::in_mrad({.name = "E_B0B", .limits = below_90, .symbol = "beta_BR", .meaning = "zero position of the B axis"}),    \
    models::in_mrad({.name = "E_C0B", .limits = below_90, .symbol = "gamma_BR", .meaning = "orientation of the B axis about Z"}),\
    models::in_um({.name = "E_X0C_minus_E_X0B", .symbol = "dx_CB", .meaning = "offset of the C axis from the B axis along X"}),\
    models::in_mrad({.name = "E_A0C_minus_E_A0B", .limits = below_90, .symbol = "alpha_CB",                                   \
             .meaning = "orientation of the C axis to the B axis about X"})
inline constexpr VariableCard B_card = shown_in_deg({.name = "B", .meaning = "commanded angle of the first rotary axis"}),
                              C_card = shown_in_deg({.name = "C", .meaning = "commanded angle of the second rotary axis"});
inline constexpr AxisCard axis_cards[] = {
    {"B", true, true, 1, {}}, {"C", true, true, 2, {}},
    {"X", false, false, 0, {}}, {"Y", false, false, 1, {}}, {"Z", false, false, 2, {}},
};
// clang-format on

/// The axes of a reading: those of the card, or as a scenario describes them (Model::context).
inline const chain::TwoRotaryAxes& axes_of(const void* context) {
  return context ? *static_cast<const chain::TwoRotaryAxes*>(context) : chain::table_BC;
}
/// Where the errors put the axes. @param q quantities of GUMSHOE_LOCATION_ROWS
template <class T, class Quantities> chain::OfTwo<T> located(const chain::TwoRotaryAxes& axes, const Quantities& q) {
  // Eq (8) states the first axis' shifts in X, Y, Z; a made card lists them in the order across, along it, along the other.
  const Vector3<T> shift = chain::along(axes.across(), q.E_X0B) + chain::along(axes.first.direction, q.E_Y0C) +
                           chain::along(axes.second.direction, q.E_Z0B);
  return chain::located<T>(axes, {shift, {q.E_A0B, q.E_B0B, q.E_C0B}, q.E_X0C_minus_E_X0B, q.E_A0C_minus_E_A0B});
}

} // namespace gumshoe::models
