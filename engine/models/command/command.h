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
  std::string folder;             ///< working directory; empty: the current one
  std::size_t batch = 10000;      ///< largest number of points per call
  double time_limit = 60;         ///< s, per call
  CardTexts card;
  Location where; ///< place of the command in the scenario
};

/// Nothing runs yet: `Model::check` runs it once.
MadeModel make_command(const CommandSpec& spec);
} // namespace gumshoe::models
