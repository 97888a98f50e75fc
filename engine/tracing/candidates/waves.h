#pragma once
/// Waves of unknown period: the cycle of an air conditioning along time, the lead of a screw along a slide.
#include "tracing/candidates/forms.h"

namespace gumshoe::tracing {

/// For each indication and each commanded condition with many levels, and time or the order: the wave that explains
/// most, with between two cycles over the range and `most_cycles`. Its p-value counts 4 W times, W being the number of
/// cycles up to which it was sought: the bound of Baluev, Mon. Not. R. Astron. Soc. 385 (2008) 1279, for a
/// periodogram's maximum of 16, about where one decides. Where uneven levels let it be sought further, a longer wave
/// counts as if it had not been, because a shorter one must explain clearly more.
/// @param known    waves that are terms already; one that the range does not resolve from these is no candidate
/// @param in_time  the gain in time, where conditions are commanded: with any value at each of their levels among the
///                 columns, as a programme that is repeated is a wave in time, too. Empty: none is sought
std::vector<Candidate> waves(const Observations& observations, const std::vector<const Candidate*>& known,
                             const Gain& gain, const Gain& in_time);

/// Levels, of which those within a tenth of their mean distance are one, such as a target that was met again with
/// jitter. Returns the first level of each.
std::vector<double> places(const Covariate& covariate);

/// Step of a grid, from the first level on, on which all levels (ascending) lie within this share of the step; 0: there
/// is none.
double even_step(const std::vector<double>& levels, double tolerance);

/// Cycles over the range up to which levels tell waves apart: half of their steps, where these are even (the sampling
/// theorem), else criteria.uneven_reach times half of their number.
double most_cycles(const std::vector<double>& levels);

/// The wave of so many cycles over the range.
Candidate wave(const Observations& observations, const Covariate& along, std::size_t indication, double cycles);

} // namespace gumshoe::tracing
