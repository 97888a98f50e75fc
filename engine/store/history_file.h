#pragma once
/// The history of `gumshoe trace --append`: what every campaign said, in numbers that add up (layout: README.md in this
/// folder).
#include <string>
#include <vector>

#include "store/draft.h"
#include "tracing/campaigns/evidence_over_time.h"

namespace gumshoe::store {

/// The campaigns of a file, in the order in which they were added; none if there is no file. Throws InputError where
/// the file is no history, or cannot be read.
std::vector<tracing::Campaign> read_history(const std::string& path);

/// Adds the whole file to the draft. Throws OutputError naming path and reason.
void write_history(Draft& draft, const Claim& claim, const std::vector<tracing::Campaign>& campaigns,
                   const tracing::EvidenceOverTime& evidence);

} // namespace gumshoe::store
