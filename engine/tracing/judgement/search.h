#pragma once
/// The search: is anything left, which effect is it, is there another? One finding at a time.
#include "tracing/fit/trace_context.h"
#include "tracing/judgement/assess.h"

namespace gumshoe::tracing {

/// A finding, and what it is made of. Its sizes are reported later (findings/).
struct SearchFinding {
  Finding finding;
  std::vector<std::size_t> terms; ///< into the last fit's terms; empty: a variance component
  std::vector<Term> rivals;       ///< members of the class other than the first, each fitted in its place
  double threshold = 0;           ///< likelihood ratio (2 ln) that the term had to pass
  int component = -1;             ///< of Design::scatter: what was found, or a member of the class; -1: none
};

struct Search {
  JointFit base, found; ///< without and with the terms, fitted to the training readings
  std::vector<SearchFinding> findings;
  Assessment first, last;               ///< of the declared model; after all findings
  std::vector<RankedCandidate> ranking; ///< of the first round
  std::vector<DetectionLimit> limits;   ///< of the first round
  int tried = 0;                        ///< signatures and variance components of the first round
};

/// Fits the declared model, then takes in terms until nothing more is found.
Search search(const TraceContext& context);

} // namespace gumshoe::tracing
