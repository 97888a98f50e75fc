#pragma once
/// Procedures that measure a mill's length: joint evaluations, which use all readings of a tool together.
#include <string>

#include "models/tool_length/tool_length.h"

namespace gumshoe::models::tool_length {

// Rows of the joint evaluations' measurands; of each flute three more.
enum LengthRow { joint_length_row, joint_effective_row, lengths };
enum CurveRow { phase_row = lengths, seen_flutes_row, residual_row, freedom_row, curve_rows };
enum PeakRow { peaks_row = lengths, peak_rows };
enum FluteRow { flute_length_row, wear_difference_row, seen_row, flute_rows };

#define GUMSHOE_FLUTE(k)                                                                                               \
  {"flute_length_" #k, "mm", "m", 0, "of flute " #k "; of a hidden one the greatest that the readings allow"},         \
      {"wear_difference_" #k, "mm", "m", 0, "the longest flute less this one; of a hidden one at least"}, {            \
    "seen_" #k, "1", "1", 0, "1: the readings show this flute, 0: it is hidden"                                        \
  }
#define GUMSHOE_FLUTES                                                                                                 \
  GUMSHOE_FLUTE(1), GUMSHOE_FLUTE(2), GUMSHOE_FLUTE(3), GUMSHOE_FLUTE(4), GUMSHOE_FLUTE(5), GUMSHOE_FLUTE(6),          \
      GUMSHOE_FLUTE(7), GUMSHOE_FLUTE(8), GUMSHOE_FLUTE(9), GUMSHOE_FLUTE(10), GUMSHOE_FLUTE(11), GUMSHOE_FLUTE(12)
#define GUMSHOE_LENGTHS                                                                                                \
  {"tool_length", "mm", "m", 0, "to the unworn tool's centre: effective_length plus the least declared wear"}, {       \
    "effective_length", "mm", "m", 0, "of the longest flute that the readings show"                                    \
  }
inline constexpr VariableCard length_measurands[] = {GUMSHOE_LENGTHS};
inline constexpr VariableCard curve_measurands[] = {
    GUMSHOE_LENGTHS,
    {"phase", "deg", "rad", 0,
     "from the spindle's X to the longest flute, if start_height is right: a micrometre turns it by degrees"},
    {"seen_flutes", "1", "1", 0, "how many flutes the readings show"},
    {"residual_rms", "um", "m", 0, "root mean square of readouts less the fitted curve"},
    {"degrees_of_freedom", "1", "1", 0, "readings less seen flutes less one for the phase"},
    GUMSHOE_FLUTES};
inline constexpr VariableCard peak_measurands[] = {
    GUMSHOE_LENGTHS, {"peaks", "1", "1", 0, "local maxima of the connected readouts"}, GUMSHOE_FLUTES};
#undef GUMSHOE_FLUTES
#undef GUMSHOE_FLUTE
#undef GUMSHOE_LENGTHS
static_assert(std::size(curve_measurands) == curve_rows + flute_rows * chain::most_inserts);
static_assert(std::size(peak_measurands) == peak_rows + flute_rows * chain::most_inserts);

constexpr bool joint(int evaluation) { return evaluation >= single; }

/// Model::measurands_in_use and Model::check_readings.
std::size_t measurands_in_use(int evaluation, const double* quantities);
std::string check_readings(const BlockCall& call);

/// Block loops of the joint evaluations.
void simulate_together(const BlockCall& call);
void evaluate_together(const BlockCall& call);

} // namespace gumshoe::models::mill
