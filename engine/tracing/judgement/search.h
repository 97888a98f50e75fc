#pragma once
/// The search for effects that the model lacks, one finding at a time.
#include <optional>

#include "tracing/fit/trace_context.h"
#include "tracing/judgement/assess.h"

namespace gumshoe::tracing {

/// A finding and its terms. Its sizes are added later (findings/).
struct SearchFinding {
  Finding finding;
  std::vector<std::size_t> terms; ///< into the last fit's terms; empty: a variance component
  std::vector<Term> rivals;       ///< members of the class other than the first, each fitted in its place
  double threshold = 0;           ///< likelihood ratio (2 ln) that the term had to exceed
  /// Index into Design::scatter of the component that was found, or that the finding may stand for; -1: none.
  int component = -1;
};

/// What stood after a round that took in a term.
struct Stage {
  JointFit fit;
  std::vector<SearchFinding> findings;
  std::vector<std::string> dropped;
};

struct Search {
  JointFit base, found; ///< without and with the terms, fitted to the training readings
  std::vector<SearchFinding> findings;
  std::vector<Stage> stages;            ///< one for each round that took in a term
  Assessment first, last;               ///< assessment of the declared model, and after all findings
  std::vector<RankedCandidate> ranking; ///< of the first round
  std::vector<DetectionLimit> limits;   ///< of the first round
  std::vector<std::string> jumping;     ///< candidates of the last round with whose sizes readings jump
  /// Effects of the last round that explain what is left, but only with sizes beyond their limits.
  std::vector<std::string> impossible;
  bool capped = false;                  ///< ended at criteria.most_findings while more would be found
  std::vector<std::string> dropped;     ///< sentences on findings that another one made superfluous
  int tried = 0;                        ///< signatures and variance components of the first round
};

/// What remains of a search whose findings were dropped: the declared model, as fitted.
Search without_findings(const TraceContext& context, Search search);

/// Fits the declared model, then adds terms until nothing more is found.
Search search(const TraceContext& context);
/// The same where the hold-out blocks rejected what was named: what the readings show, without a name. Nothing if they
/// show no shape by themselves, or if a name was not all that was found.
std::optional<Search> described(const TraceContext& context, const Search& rejected);
/// Drops all that was found in the last round, and tests anew whether what is left scatters.
/// Names of the dropped findings. At least two rounds must have taken in terms.
std::vector<std::string> step_back(const TraceContext& context, Search& search);

} // namespace gumshoe::tracing
