#pragma once
/// One search in rounds: each adds the candidate that explains the readings best, until none is significant.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

struct Sought {
  bool names = true;            ///< effects and declared quantities are candidates, and not shapes alone
  bool shapes_for_noise = true; ///< a shape may be there in place of larger noise
  bool steps_last = true;       ///< where the data cannot tell whether a step lasts or one block differs, it lasts
};

/// What the ranking says of a candidate that was taken.
inline constexpr const char *alone = "named", *in_class = "in the class";

/// Fits the declared model, then adds terms. Findings have no sizes yet (findings/).
Search search_in_rounds(const TraceContext& context, Sought sought = {});

} // namespace gumshoe::tracing
