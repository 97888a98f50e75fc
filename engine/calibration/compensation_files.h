#pragma once
/// Tables of compensation as controls read them. Error: actual minus commanded; correction: commanded minus actual.
#include <string>
#include <string_view>
#include <vector>

#include "calibration/compensation_left.h"

namespace gumshoe::calibration {

struct CompensationFormat {
  std::string name;                      ///< of --format
  std::string meaning;                   ///< the sign of what is written, and what directions become
  std::string check;                     ///< one step that shows on the machine that the sign is right
  std::vector<std::string_view> options; ///< members of CompensationChoice that count: axis, step, reference, ...
  std::string check_negated = {};        ///< the same with --negate
};

/// Every format there is.
const std::vector<CompensationFormat>& compensation_formats();

struct CompensationChoice {
  std::string format = "csv";
  std::string axis = "X";    ///< letter, or name of the machine axis
  double resolution = 0;     ///< SI; 0: 0.1 um, 0.1 arcsec of an angle in its own unit
  double step = 0;           ///< SI; above 0: at step_positions
  double reference = 0;      ///< position at which the control's table is zero, SI
  bool at_reference = false; ///< `reference` was given; else the first position
  bool negate = false;
};

/// Positions of a table with steps of its own, from the first measured to the end of the travel, exactly, or where the
/// positions must be equidistant to the next step beyond it; empty without a step. Throws InputError for a step that is
/// longer than the travel, or gives too many points.
std::vector<double> step_positions(const Compensation& table, const CompensationChoice& choice);

/// A file, and what a control makes of it: of the numbers as they are written, which are rounded.
struct CompensationFile {
  std::string text;
  AppliedTable applied; ///< with the constant that the control's table loses by being zero at the reference
};

/// Throws InputError where the format cannot hold the table: positions that are not equidistant, too many rows, a
/// direction that was not measured, a reference outside the travel.
CompensationFile compensation_file(const Compensation& table, const CompensationChoice& choice);

} // namespace gumshoe::calibration
