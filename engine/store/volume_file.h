#pragma once
/// The result file of `gumshoe volume` (layout: README.md in this folder).
#include "analysis/volume.h"
#include "store/draft.h"

namespace gumshoe::store {

/// Adds the whole file to the draft. Throws OutputError naming path and reason.
void write_volume(Draft& draft, const Claim& claim, const scenario::Scenario& scenario, const analysis::VolumeMap& map);

} // namespace gumshoe::store
