#pragma once
/// What every part of one trace works on.
#include "tracing/fit/joint_fit.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

struct TraceContext {
  const propagation::Experiment& experiment; ///< of the extended scenario
  const Simulator& simulator;
  const Observations& observations;
  const Fitter& fitter; ///< of the training readings
  double alpha;         ///< probability of any finding where there is nothing
  int draws;
  std::uint64_t seed;
  int threads;
  std::function<void(const std::string&)> progress;
};

} // namespace gumshoe::tracing
