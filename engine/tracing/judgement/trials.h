#pragma once
/// The candidates that a round fits with the whole model, best first.
#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// Whether some size of the fit's last term is significant by its own standard uncertainty (criteria.decisive). The
/// likelihood ratio alone may say more than the size, where the fit with the term winsorises other readings. True where
/// readings jump with the sizes: their tangents tell no uncertainty.
bool is_significant(const JointFit& fit);

/// Effects and declared quantities that could win. The first passes by itself; the others may be members of its class.
/// Empty: none passes.
/// @param denied  gets those before the first that pass by their signatures, but explain little by the whole model: the
///                size that they would need is beyond a limit of the card, where it stays, or bends what it does
std::vector<Trial> physical_trials(const Evidence& evidence, std::vector<Trial>& denied);

/// Shapes that pass by themselves, in the order in which they are there (shape_order.h), a simpler one of the same with
/// another finding before them.
std::vector<Trial> shape_trials(const TraceContext& context, const Evidence& evidence, bool steps_last);

} // namespace gumshoe::tracing
