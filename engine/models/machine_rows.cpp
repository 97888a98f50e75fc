#include "models/machine_rows.h"

#include <fmt/format.h>

#include "chain/machine.h"
#include "models/cards.h"

namespace gumshoe::models {

namespace {

constexpr char letters[] = "XYZ";

std::string meaning_of_line(const chain::Axis& axis, int kind) {
  const int along = kind % 3;
  const bool own = along == axis.direction, linear = kind % chain::E_X0 < chain::E_A, location = kind >= chain::E_X0;
  const char letter = letters[along];
  if (location && own) return fmt::format("zero position of {}", axis.name);
  if (location && linear) return fmt::format("location of {}: offset along {}", axis.name, letter);
  if (location) return fmt::format("orientation of {} about {}", axis.name, letter);
  if (own && linear != axis.rotary) return fmt::format("positioning of {}", axis.name);
  if (axis.rotary)
    return fmt::format("error motion of {}: {} {} {}", axis.name, linear ? (own ? "axial," : "radial,") : "tilt",
                       linear ? "along" : "about", letter);
  return fmt::format("error motion of {}: {} {} {}", axis.name,
                     linear ? "straightness"
                     : own  ? "roll"
                            : "tilt",
                     linear ? "along" : "about", letter);
}

std::string meaning_of_link(const chain::Axis& axis, int kind) {
  static constexpr const char* parameters[] = {"length a", "twist alpha", "offset d", "joint angle theta", "tilt beta"};
  return fmt::format("error of the {} of link {}: actual minus design", parameters[kind], axis.name);
}

} // namespace

Symbol error_row(const chain::Axis& axis, int kind, double default_value) {
  const bool angle = chain::is_angle(axis, kind);
  const bool tilt = !axis.link && kind >= chain::E_A0 && kind - chain::E_A0 != axis.direction;
  return {chain::error_name(axis, kind),
          angle ? "deg" : "mm",
          angle ? "rad" : "m",
          axis.link ? meaning_of_link(axis, kind) : meaning_of_line(axis, kind),
          default_value,
          tilt ? below_90 : any};
}

Symbol command_row(const chain::Axis& axis) {
  return {axis.name, axis.rotary ? "deg" : "mm", axis.rotary ? "rad" : "m", "commanded", 0};
}

} // namespace gumshoe::models
