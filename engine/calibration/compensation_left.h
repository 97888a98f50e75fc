#pragma once
/// What a table of compensation leaves of the readings, once a control applies it as it is written.
#include <string>
#include <utility>
#include <vector>

#include "calibration/compensation.h"

namespace gumshoe::calibration {

/// The errors that a control corrects: at positions in ascending order, linear in between, the end values beyond. SI.
struct AppliedTable {
  using Curve = std::vector<std::pair<double, double>>; ///< position, and error: actual minus commanded
  Curve up, down;                                       ///< by the direction of the approach
};

/// Root mean squares, SI.
struct Left {
  std::string which;
  double before = 0;  ///< as they are
  double with = 0;    ///< with the table
  double without = 0; ///< if everything that the scenario explains were corrected exactly
};

/// One for each group of readings.
std::vector<Left> left_with(const Compensation& compensation, const AppliedTable& table);

} // namespace gumshoe::calibration
