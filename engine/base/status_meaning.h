#pragma once
/// Statuses in words.
#include "base/status.h"

namespace gumshoe {

/// "the shadow cannot cover the share of the beam at which the trigger fires"; "" of ok.
const char* status_meaning(Status status);

} // namespace gumshoe
