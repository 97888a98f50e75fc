#pragma once
/// The result file of `gumshoe choose` (layout: README.md in this folder).
#include <string>

#include "choice/results.h"
#include "scenario/scenario.h"
#include "store/draft.h"

namespace gumshoe::store {

/// Adds the whole file to the draft. Throws OutputError naming path and reason.
void write_choice(Draft& draft, const Claim& claim, const scenario::Scenario& scenario, const choice::Result& result);

} // namespace gumshoe::store
