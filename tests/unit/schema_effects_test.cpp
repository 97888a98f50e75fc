/// The schema's section of effects follows from the cards.
#include <catch2/catch.hpp>

#include <fstream>

#include <nlohmann/json.hpp>

#include "effects/effect.h"
#include "places.h"
#include "scenario/schema_effects.h"

using namespace gumshoe;

TEST_CASE("the shipped schema knows every effect and its quantities", "[schema][effects]") {
  std::ifstream file(std::string(GUMSHOE_SOURCE_DIR) + "/scenarios/scenario.schema.json");
  const auto shipped = nlohmann::json::parse(file).at("properties").at("effects");
  const auto generated = nlohmann::json::parse(scenario::effects_schema(effects::cards()));
  CHECK(generated == shipped);
}
