#pragma once
/// From what the search took in to what is reported: findings with sizes and intervals, the noise, words.
#include "tracing/search.h"

namespace gumshoe::tracing {

/// Findings, the outcome, and the joint estimate for the traced scenario.
void collect(const Circumstances& circumstances, const Search& search, Trace& out);
void describe_noise(const Circumstances& circumstances, const Search& search, Trace& out);
/// Size of a variance component, with the interval of its profile likelihood.
void describe_scatter(const Circumstances& circumstances, const Search& search, const Step& step, Finding& finding);
/// Unknowns and sizes with their joint covariance, and the scenario in which they are estimated quantities.
void estimate_for_scenario(const Circumstances& circumstances, const Search& search, Trace& out);
/// Where a term's columns start among the fit's fixed ones.
Index first_column(const JointFit& fit, std::size_t term);
/// Two sentences for a machinist.
void speak(Trace& out);

} // namespace gumshoe::tracing
