#pragma once
/// The result file of `gumshoe choose` (layout: README.md in this folder).
#include <string>

#include "choice/results.h"
#include "scenario/scenario.h"

namespace gumshoe::store {

/// Writes the whole file in one go; an older result of ours is replaced. Throws OutputError naming path and reason.
void write_choice(const std::string& path, const scenario::Scenario& scenario, const choice::Result& result);

} // namespace gumshoe::store
