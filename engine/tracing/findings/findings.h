#pragma once
/// From what the search took in to what is reported: findings with sizes and intervals, the noise, words.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Findings and the outcome.
void collect(const Circumstances& circumstances, const Search& search, Trace& out);
void describe_noise(const Circumstances& circumstances, const Search& search, Trace& out);
/// Size of a variance component, with the interval of its profile likelihood.
void describe_scatter(const Circumstances& circumstances, const JointFit& fit, const Step& step, Finding& finding);
/// Two sentences for a machinist.
void speak(Trace& out);

} // namespace gumshoe::tracing
