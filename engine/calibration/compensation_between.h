#pragma once
/// Errors between the positions of the readings: a control interpolates there, the model knows more.
#include <vector>

#include "calibration/compensation.h"

namespace gumshoe::calibration {

/// Errors of what `table` holds at other positions within its travel, by direction as its rows. Labels are those of a
/// neighbouring reading, as are conditions without a unit; others are linear between the neighbours on both sides.
/// Empty where the model has no value, as beyond the levels of a correction that is known at levels alone.
std::vector<CompensationRow> errors_at(const propagation::Experiment& experiment, const CompensationRequest& request,
                                       const Compensation& table, const std::vector<double>& positions);

/// Root mean squares between the positions of a table, SI.
struct StraightLines {
  double errors = 0; ///< about the mean of each direction
  double missed = 0; ///< errors less the straight line between the table's positions
  /// Lines miss half of what the errors vary by there, and more than chance in the sizes would give.
  bool poor = false;
};

/// Tried at eight places of each interval, of 200 intervals at most. `positions` ascend.
StraightLines straight_lines(const propagation::Experiment& experiment, const CompensationRequest& request,
                             const Compensation& table, const std::vector<double>& positions);

/// The largest step, of the mean distance of the rows over 2 to 64, whose lines miss no more than a tenth of the
/// errors; 0 if none does.
double sufficient_step(const propagation::Experiment& experiment, const CompensationRequest& request,
                       const Compensation& table);

} // namespace gumshoe::calibration
