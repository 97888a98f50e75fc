#include "models/linear_axis/procedures.h"

#include <fmt/format.h>

#include "base/si.h"

namespace gumshoe::models::linear_axis {

std::string problem_of(const Readings<double>& all, std::size_t fewest) {
  for (const auto& at : all.at)
    if (at.c.direction == 0) return "ISO 230-2 compares targets reached from both sides, but a direction is 0";
  for (const Target& target : targets_of(all))
    for (const auto& [name, readings] : {std::pair{"upwards", &target.up}, {"downwards", &target.down}}) {
      const std::string where = fmt::format("the target at {:g} mm", target.position / si::mm);
      if (readings->empty())
        return fmt::format(
            "{} was not reached {}, but ISO 230-2 compares both directions (readings are of one target if "
            "their positions are equal)",
            where, name);
      if (readings->size() < fewest)
        return fmt::format(
            "{} has one run {}, from which ISO 230-2 evaluates no accuracy A and no repeatability R (use "
            "the evaluation iso_230_2_once; if there are more runs, they need a label or a time, since "
            "readings of equal labels and conditions count as one)",
            where, name);
    }
  return "";
}

} // namespace gumshoe::models::linear_axis
