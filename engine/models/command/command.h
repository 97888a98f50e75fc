#pragma once
/// A program as a model: points as CSV on its stdin, results as CSV on its stdout.
#include <string>
#include <vector>

#include "base/error.h"
#include "models/made_card.h"
#include "models/model.h"

namespace gumshoe::models {

struct CommandSpec {
  std::vector<std::string> words; ///< program and arguments
  std::string folder;             ///< it runs there; empty: where we are
  std::size_t batch = 10000;      ///< points per call, at most
  double time_limit = 60;         ///< s, per call
  CardTexts card;
  Location where; ///< of the command in the scenario
};

/// Nothing runs yet: `Model::check` runs it once.
MadeModel make_command(const CommandSpec& spec);
} // namespace gumshoe::models
