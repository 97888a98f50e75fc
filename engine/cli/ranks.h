#pragma once
/// What the commands that ranks of MPI share have in common.
#include <functional>

#include "base/error.h"
#include "propagation/ranks.h"

namespace gumshoe::cli {

/// What a rank other than the first can do.
struct Offer {
  std::string run; ///< which run it has; all ranks must have the same
  propagation::Service service;
};

/// Works for the first rank, and says nothing. Errors of `prepare` go to the first rank.
ExitCode help_first_rank(propagation::Ranks& ranks, int threads, const std::function<Offer()>& prepare);

} // namespace gumshoe::cli
