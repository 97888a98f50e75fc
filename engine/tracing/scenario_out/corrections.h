#pragma once
/// A shape that no effect explains, as stated effects of the traced scenario.
#include <optional>

#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// Unit in which a size that adds to an indication is written: a difference has no zero of its own (K, not degC).
std::string unit_of_size(const VariableCard& indication);

/// Share of the range by which the table of a correction is continued beyond its ends: a temperature or a position may
/// lie a little beyond those that were measured. 0 of a course in time, because no curve says how it goes on, of an
/// angle, which comes round, and of numbers without a unit.
double margin_of(const Correction& correction);

/// Loading of a correction that came and went within the readings at both ends of its table, and so beyond them.
std::optional<double> before_and_after(const Correction& correction);

struct WrittenShape {
  std::vector<Correction> effects; ///< one alone if it depends on nothing but a label
  const Grouping* label = nullptr; ///< one label or two: the size of each then takes a value for each of its groups
  /// By effect: what its sizes are made of, groups of the label (or one row) x sizes of the term. A row of NaN: readings
  /// of the fit tell nothing of this group.
  std::vector<Matrix> shares;
};

/// The shape as a function of conditions and columns, or of a label, over all readings. Where what it is named after
/// does not fix it (a hysteresis), other conditions and columns are added until they do. Empty if they never do, or if
/// it depends on the order of the rows, which is no part of a scenario.
/// @param names the stated effects are called NAME, or NAME_1, NAME_2 ...
std::optional<WrittenShape> written_shape(const TraceContext& context, const Term& term, const std::string& name);

} // namespace gumshoe::tracing
