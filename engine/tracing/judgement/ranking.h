#pragma once
/// Candidates tried, best first, and detection limits.
#include <map>

#include "tracing/judgement/assess.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// @param fit       fit whose design was scanned; it names the quantity that absorbs a signature
/// @param outcomes  by candidate, for those pursued beyond their p-value
std::vector<RankedCandidate> ranking(const Scan& scan, const Assessment& assessment,
                                     const std::vector<Candidate>& candidates, const Design& fit,
                                     const std::map<std::size_t, std::string>& outcomes);

/// Size of each amplitude of each physical candidate that passes the threshold in nine cases of ten, SI.
std::vector<DetectionLimit> detection_limits(const Scan& scan, const Assessment& assessment,
                                             const std::vector<Candidate>& candidates);

} // namespace gumshoe::tracing
