#pragma once
/// Rounds of `gumshoe trace --loop`: what one round found is in the scenario that the next one traces.
#include <string>
#include <vector>

#include "store/draft.h"
#include "tracing/trace.h"

namespace gumshoe::cli {

using tracing::Round;

struct Rounds {
  tracing::Trace first;     ///< of the scenario itself
  std::string text;         ///< the scenario with everything found; empty: nothing was added
  std::vector<Round> table; ///< the first is of `first`
};

/// Traces until a round adds nothing, at most `most` times. Why no scenario follows from a finding is among the first
/// round's statements.
/// @param place where the scenario with the findings will stand
Rounds trace_rounds(const scenario::Scenario& scenario, const tracing::Settings& settings, const store::Claim& place,
                    int most);

/// A line for each round: what it added, and the errors before and after.
std::string table(const std::vector<Round>& rounds);

} // namespace gumshoe::cli
