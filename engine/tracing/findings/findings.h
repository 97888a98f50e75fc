#pragma once
/// Converts the results of the search into reported findings.
#include "tracing/findings/fitted_scatter.h"

namespace gumshoe::tracing {

/// Findings with their sizes, and the outcome. A veto of the hold-out blocks (out.vetoed) leaves only scatter.
void collect(const TraceContext& context, const Search& search, Trace& out);
/// Fills out.lack_of_fit, but for what comparison.h gives, and out.anomalous_blocks.
void describe_repeats(const TraceContext& context, const Search& search, Trace& out);
/// Says where groups of readings have a slope or a first wave of their own.
void describe_alignments(const TraceContext& context, const Search& search, Trace& out);
void describe_noise(const TraceContext& context, const Search& search, Trace& out);

/// Standard deviation of a variance component, in units of Design::reference.
struct ScatterSize {
  double best = 0, low = 0, high = 0; ///< the most likely, and where 2 ln L falls by criteria.decisive
  int indication = -1;                ///< the only one that it moves; -1: each by itself
};
ScatterSize size_of_scatter(const TraceContext& context, const JointFit& fit, int component);
/// What single readings scatter beyond what is declared, where this was found; none of other findings.
std::vector<MoreNoise> larger_noise(const JointFit& fit, const Finding& found);
/// A component as noise of the indications that it moves.
std::vector<MoreNoise> noise_of(const Component& component, const JointFit& fit);

/// Size of a variance component given the others, with the interval of its profile likelihood; with none, size of the
/// noise.
void describe_scatter(const TraceContext& context, const JointFit& fit, const FittedScatter& scatter, int component,
                      const Rms& rms, Finding& finding);
/// Writes the two sentences for a machinist: what was found, how large, how sure, what to do.
void summarise(Trace& out);

} // namespace gumshoe::tracing
