#include "scenario/schema_effects.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gumshoe::scenario {

std::string effects_schema(std::span<const EffectCard* const> effects) {
  std::vector<std::string> properties;
  for (const EffectCard* effect : effects) {
    std::vector<std::string> own;
    for (const QuantityCard& q : effect->quantities)
      own.push_back(fmt::format(R"("{}": {{"$ref": "#/definitions/quantity"}})", q.name));
    properties.push_back(
        fmt::format(R"("{}": {{"type": "object", "properties": {{{}}}, "additionalProperties": false}})", effect->name,
                    fmt::join(own, ", ")));
  }
  return fmt::format(R"({{"type": "object", "description": "effects left out stay at their null value", )"
                     R"("properties": {{{}}}, "additionalProperties": )"
                     R"({{"type": "object", "additionalProperties": {{"$ref": "#/definitions/quantity"}}}}}})",
                     fmt::join(properties, ", "));
}

} // namespace gumshoe::scenario
