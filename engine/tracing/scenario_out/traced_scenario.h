#pragma once
/// The scenario with what was found in it: what `gumshoe trace` writes, `gumshoe run` reads, and `gumshoe trace` too.
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// The scenario's text anew, in which every effect found is an ordinary input quantity with estimate, u, and a Pearson
/// correlation with the free unknowns; scatter and what is not in the catalogue are components of uncertainty.
/// Free unknowns (block offsets) have values, too, and stand in `[trace] free`, so that a further trace fits them anew.
/// Sources name the verdict, p, the interval that allows for the search, and the hash of scenario and data. Paths of
/// data files are made relative to `folder`. Empty: nothing was found, or the hold-out blocks rejected it.
std::string traced_scenario(const scenario::Scenario& scenario, const Trace& trace, const std::string& folder);

} // namespace gumshoe::tracing
