#pragma once
/// Data shared by all parts of one trace.
#include "tracing/fit/joint_fit.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

struct TraceContext {
  const propagation::Experiment& experiment; ///< experiment of the extended scenario
  const Simulator& simulator;
  const Observations& observations;
  const Fitter& fitter; ///< fits the training readings
  double alpha;         ///< probability of any finding if there is nothing to find
  double alpha_further; ///< of any further one, given what was found
  int draws;
  std::uint64_t seed;
  int threads;
  std::function<void(const std::string&)> progress;

  double alpha_given(bool found) const { return found ? alpha_further : alpha; }
};

/// The same, once something was found.
inline TraceContext further(TraceContext c) {
  c.alpha = c.alpha_further;
  return c;
}

} // namespace gumshoe::tracing
