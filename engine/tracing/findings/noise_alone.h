#pragma once
/// Draws of the fitted noise: what readings would scatter were the model true with its parameters fitted.
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// All rows x sets, SI. Declared draws that the fitted data show are part of the fit and stay out; those that only
/// hold-out blocks show belong to what their readings scatter.
Matrix noise_of_readings(const TraceContext& context, const JointFit& fit);
/// The same of readings of blocks that are predicted: where each is left out in turn, with the draws that are its own.
/// @param noise  noise_of_readings
Matrix noise_of_predicted(const TraceContext& context, const JointFit& fit, const Matrix& noise);
/// The same of readings that were not fitted: the scale of the noise is known to its degrees of freedom only, and where
/// readings jump with sizes that were found, they may jump elsewhere.
Matrix not_fitted(const TraceContext& context, const JointFit& fit, Matrix noise);

} // namespace gumshoe::tracing
