#pragma once
/// A variance component, and what explains it.
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// The variance component or the larger noise that an assessment shows; none: neither.
/// @param fit  the fit that was assessed
std::optional<SearchFinding> scatter_shown(const TraceContext& context, const JointFit& fit,
                                           const Assessment& assessment);

struct InPlaceOfScatter {
  std::optional<std::size_t> shape;   ///< candidate: a plain shape is there, and no scatter
  JointFit with_shape;                ///< valid if there is a shape
  std::optional<std::size_t> as_well; ///< candidate: a plain shape describes the scatter as well, and may be chance
  SearchFinding effects;              ///< effects, with the component where it is a member; without terms: none
  std::vector<std::size_t> members;   ///< candidates of `effects`
  JointFit fit;                       ///< with the first effect
};

/// A slow drift looks like scatter from one clamping to the next: given the scatter it is not worth its name. Effects
/// that explain as much without the component, and predict held-out readings better, form a class with it. Quantities
/// declared, and effects, by label do not: of so many, some look like scatter by chance. Where the best of them
/// explains more than scatter would seldom let it, scatter is no member. One group that differs from all others, which
/// agree, explains more than scatter, and so does a temperature that was recorded, a drift, or what came and went in
/// time: plain shapes, found where scatter would seldom let them. Where there is a shape, the effects
/// are those that explain as much as it (criteria.equal_merit): they go before it.
InPlaceOfScatter in_place_of_scatter(const TraceContext& context, const Evidence& evidence,
                                     const SearchFinding& scatter);

/// Whether what a fit leaves is no larger than declared, as if no reading resembled another.
bool scatters_as_declared(const TraceContext& context, const JointFit& fit);

/// The best shape with which readings scatter as declared, and none resembles the one before; none: with each of the
/// best they scatter more. Noise that is larger than declared and correlated passes for a jump, and hides it from the
/// search.
std::optional<Trial> in_place_of_larger_noise(const TraceContext& context, const Evidence& evidence);

} // namespace gumshoe::tracing
