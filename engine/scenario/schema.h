#pragma once
/// The JSON Schema of a scenario, put together from what the readers say of their sections.
#include "scenario/scenario.h"
#include "scenario/shape.h"

namespace gumshoe::scenario {

/// The sections of a scenario, with their shapes.
const std::vector<Key>& sections();
/// Names of the sections that have a key of this name.
std::vector<std::string> sections_with(const std::string& key);
/// The keys of [model], those of models that a scenario describes included.
std::vector<Key> model_keys();

/// The whole schema (draft 7), as JSON without line breaks: `gumshoe schema`. Names and meanings of quantities,
/// conditions, indications and effects are those of the catalogue's cards.
std::string schema(const Catalogue& catalogue);

} // namespace gumshoe::scenario
