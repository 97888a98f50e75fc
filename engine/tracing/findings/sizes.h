#pragma once
/// Sizes of a finding as they are reported.
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// A length change in its own unit, "12.3 um".
std::string shown_size(double si, const std::string& unit, const std::string& si_unit);
/// A size and its standard uncertainty (SI) in its own unit, to two digits of the latter: "3.31 s, u = 0.01 s".
/// @param shown  in place of the unit, where it has a name of its own
std::string with_u(double si, double u, const std::string& unit, const std::string& si_unit, std::string shown = {});
/// Unit in which these figures are shown: their own; of lengths as suits the largest (units::error_unit).
std::string display_unit(const Rms& rms);
/// Unit of errors of an indication with these units, next to these figures: theirs, if they are of one kind.
std::string display_unit(const Rms& rms, const std::string& unit, const std::string& si_unit);
/// Two digits and that unit.
std::string shown_rms(double si, const Rms& rms);

/// Sizes of a term with u and the interval after selection. A shape has none.
/// @param limit  likelihood ratio (2 ln) that the term had to pass
std::vector<SizedQuantity> sizes(const TraceContext& context, const JointFit& fit, std::size_t term, double limit);
/// Size of an unknown effect against each condition on which it depends, at the measured levels, and by all of them
/// together where they were set again and again. Remarks are in the unit of `rms`.
void add_curves(const TraceContext& context, const JointFit& fit, std::size_t term, const Rms& rms, Finding& finding);
/// Remarks on sizes that are implausible or at a limit.
void remark_on_size(const Term& term, Finding& finding);

} // namespace gumshoe::tracing
