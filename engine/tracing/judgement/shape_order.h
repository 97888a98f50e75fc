#pragma once
/// Which of several shapes without a cause is there, and which others these data cannot tell from it.
#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// Puts first what says more than the shape of the highest score, which stands first. A form of one size, such as a
/// drift that levels off, or a wave goes before a free curve in the same condition that does not exclude it: it goes on
/// beyond the readings. One that depends on less goes before a product or a table: a step of one operator before a
/// slope of his along the positions, and any value for each operator before a table by machine and operator; a straight
/// line in time before blocks that differ; a lower power before a higher one, and a bend before a cubic. Then, where
/// noise is declared, a shape of one size that leaves noise as it was declared goes before one that leaves more, for
/// which correlated noise would have to make up: a jump before a cubic in time. A step in time goes before a pulse that
/// is not over in what is fitted, and before a gradual change, that do not exclude it. At last a step and a block, or a
/// pass, that differs, where they are the same in what is fitted.
/// @param tried       best first, at least one
/// @param steps_last  a step lasts; false: that was refuted, and the block differs
void order_shapes(const TraceContext& context, const Evidence& evidence, std::vector<Trial>& tried, bool steps_last);

/// A step in time, or in the order of measurement, which goes on beyond the readings.
bool is_lasting_step(const Candidate& candidate, const Observations& observations);

/// The step that lasts in place of a shape which the fitted readings cannot tell from it: of a block or a pass that
/// differs where the step begins with it, a pulse that is not over, or a gradual change that does not exclude it. A
/// change is expected to last; held-out readings tell.
std::optional<Trial> lasting_in_place_of(const TraceContext& context, const Evidence& evidence, std::size_t shape);

/// Whether another form of a shape explains the same: the model's unknowns take what they differ by, as a free reversal
/// takes that of errors that are zero at either end.
bool is_one_of_several_forms(const Evidence& evidence, std::size_t shape);

/// Shapes of one size that depend on something else and describe the readings as well as `a` does: a drift with the
/// order, or with a temperature that rose meanwhile. A step in time at the edge of the block that differs says the
/// same, and is no rival.
std::vector<RivalShape> rivals_of(const TraceContext& context, const Evidence& evidence, std::size_t a,
                                  const std::vector<Trial>& tried);

} // namespace gumshoe::tracing
