#pragma once
/// The trigger of a turning tool whose feed axis follows its command with a first-order lag, from rest.
#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::models::tool_length {

/// As TriggerSolver::solve, for the height start_height - drop (turned - behind(turned, lag)); `lag` in rad of spindle
/// angle, 0 or more.
///
/// The descent is convex in the angle, so a chord lies below the true height and a tangent above it, and triggers on
/// straight feeds bound the true one from both sides. Each pair of bounds gives the next; no time steps.
InsertTrigger lagging_trigger(TriggerSolver& solver, std::span<const Flute<double>> flutes, const Beam<double>& beam,
                              const InsertMotion& motion, double lag);

} // namespace gumshoe::models::tool_length
