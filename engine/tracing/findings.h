#pragma once
/// From what the search took in to what is reported: findings with sizes and intervals, the noise, words.
#include "tracing/search.h"

namespace gumshoe::tracing {

/// Findings, the outcome, and the joint estimate for the traced scenario.
void collect(const Circumstances& circumstances, const Search& search, Trace& out);
void describe_noise(const Circumstances& circumstances, const Search& search, Trace& out);
/// Size of a variance component, with the interval of its profile likelihood.
void describe_scatter(const Circumstances& circumstances, const JointFit& fit, const Step& step, Finding& finding);
/// What goes into the traced scenario: unknowns and sizes with their joint covariance, the scenario in which they are
/// estimated quantities, and variance components. Nothing if nothing was found.
void compose(const Circumstances& circumstances, const Search& search, Trace& out);
/// Variance components: of scatter, and of what is not in the catalogue. `left` by term: what no free unknown absorbs
/// of it, rows in the order of measurement.
void add_components(const Circumstances& circumstances, const Search& search, const std::vector<Vector>& left,
                    Trace& out);
/// Two sentences for a machinist.
void speak(Trace& out);

} // namespace gumshoe::tracing
