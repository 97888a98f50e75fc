#pragma once
/// Statistics of angles on the circle (Mardia and Jupp 2000): JCGM 102 asks for care where a measurand is an angle.
#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Angles in rad, NaN where failed. `mean_direction` and `low` lie in (-pi, pi], the arc runs from `low` upwards to
/// `high`. The shortest arc is exact: ranks as in JCGM 101 7.7.4, around the circle. The remark says when mean and
/// interval on the line mislead: samples on both sides of the cut at +-pi (or of a whole turn), or an arc of more than
/// half a turn.
CircularSummary circular_summary(const Column& angles, double coverage_probability, int threads = 1);

/// Puts what holds on the circle in place of the statement on the line, which misleads, and withholds U and k.
void correct_by_circle(Summary& summary, const CircularSummary& circle, double coverage_probability);

/// One for every output that is an angle.
std::vector<CircularSummary> circular_summaries(const propagation::Experiment& experiment, const ValuesOf& values,
                                                int threads);

} // namespace gumshoe::analysis
