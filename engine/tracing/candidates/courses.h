#pragma once
/// Courses of unknown form in time: a step at an unknown instant (something gave way, was hit or was set to zero anew),
/// a while between two that cancel (something was changed, and changed back), or a bend from which on it goes
/// straight (something began to wear), of all readings or of one part; a
/// pulse of unknown place and length (something came and went), a shift from one level to another, of unknown place and
/// length (something came and stayed), and a drift that levels off with an unknown time constant.
#include "tracing/candidates/forms.h"

namespace gumshoe::tracing {

/// For each indication and each course of the measurement (time, or the order): the step between two successive
/// readings that explains most, the one at the beginning of a block that does, and the one of a single part
/// (candidates.h) that does; the bend and the while of all and those of a single part that do; and the pulse, the shift
/// and the saturating drift that do. The p-value of a step or a bend counts as often as there are instants, that of a while as
/// there are pairs of them; that of a pulse or a shift as that of a step: of white noise, the best of all pulses
/// exceeds a high limit nearly as often as the best of so many independent shapes (28 to 44 of 50 readings, 225 to 528
/// of 600). That of a drift counts criteria.drift_forms times.
/// @param rows  of the readings that are fitted, in the order of measurement
std::vector<Candidate> courses(const Observations& observations, const std::vector<Index>& rows, const Gain& gain);

/// The drift whose time constant over the range has this logarithm.
Candidate drift(const Observations& observations, const Covariate& along, std::size_t indication, double logarithm);

} // namespace gumshoe::tracing
