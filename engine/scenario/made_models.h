#pragma once
/// Models that a scenario describes, as rows of a table: name, and the function that makes one.
#include <span>
#include <string>
#include <vector>

#include "models/model.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

/// What a model is made of. Each maker reads its own keys of [model] and its own sections.
struct MadeModelSource {
  Table& model;              ///< [model]
  Table& top;                ///< the whole scenario
  const std::string& folder; ///< of the scenario: files that it names are looked for there
  Context& context;
};

struct MadeModelRow {
  const char* name; ///< of [model] name = "..."
  const char* what; ///< describes the model, for people: "formulas"
  /// Returns the model; null, and problems in the context, if something is wrong.
  models::MadeModel (*make)(const MadeModelSource& source);
  bool starts; ///< its example is a first scenario to go on from
};

/// Every row of made_models.def.
std::span<const MadeModelRow> made_models();

/// Names of the catalogue's models `catalogue`, followed by those of made_models(): every value of [model] name.
std::vector<std::string> model_names(std::span<const ModelCard* const> catalogue);

} // namespace gumshoe::scenario
