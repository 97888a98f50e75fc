#include "cli/ranks.h"

namespace gumshoe::cli {

ExitCode help_first_rank(propagation::Ranks& ranks, int threads, const std::function<Offer()>& prepare) {
  const std::optional<std::string> wanted = ranks.awaited();
  if (!wanted) return ExitCode::done;
  try {
    const Offer own = prepare();
    if (own.run != *wanted)
      throw InputError("the ranks have different runs", "one has " + own.run + ", the first " + *wanted,
                       "give all machines the same files and options");
    ranks.serve(own.service, ranks.threads(threads));
  } catch (const std::exception& failure) {
    ranks.report(failure);
  }
  return ExitCode::done;
}

} // namespace gumshoe::cli
