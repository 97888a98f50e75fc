#pragma once
/// What was tried, best first, and what would have been detected.
#include <map>

#include "tracing/judgement/assess.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// @param fit       the design that the scan is of: names of what absorbs a signature
/// @param outcomes  by candidate, for those that came further than their own p-value
std::vector<RankedCandidate> ranking(const Scan& scan, const Assessment& assessment,
                                     const std::vector<Candidate>& candidates, const Design& fit,
                                     const std::map<std::size_t, std::string>& outcomes);

/// Size of each amplitude of each physical candidate that passes the threshold in nine cases of ten, SI.
std::vector<DetectionLimit> detection_limits(const Scan& scan, const Assessment& assessment,
                                             const std::vector<Candidate>& candidates);

} // namespace gumshoe::tracing
