#pragma once
/// The scenario with the findings added, which `gumshoe trace` writes and `gumshoe run` and `gumshoe trace` read.
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// Text of the scenario in which every effect found is an ordinary input quantity with estimate, u, and a Pearson
/// correlation with the free unknowns; scatter and unknown effects are components of uncertainty. Free unknowns (block
/// offsets) also have values and are listed in `[trace] free`, so that a further trace fits them again. What the
/// readings say of declared quantities takes the place of what was declared, which stands in `[trace] priors`: a
/// further trace starts from there. Sources name the verdict, p, the interval that allows for the search, and the hash
/// of scenario and data. Paths of data files are made relative to `folder`. Where nothing was found, or the hold-out
/// blocks rejected it, the declared model as fitted; empty if it leaves nothing free.
std::string traced_scenario(const scenario::Scenario& scenario, const Trace& trace, const std::string& folder);

} // namespace gumshoe::tracing
