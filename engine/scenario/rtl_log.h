#pragma once
/// Renishaw's .rtl: positions and deviations of a laser, by run and target.
#include <string>

namespace gumshoe::scenario {

/// The log as a table with a row for each reading, "run;direction;target [mm];deviation [um]"; empty if the text is no
/// such log. The file says no units: mm and um are those of linear measurements, angular ones have none here. It says
/// no directions either: of an even number of runs the odd ones are taken to go up and the even ones down, and these
/// are written from their last target to their first.
///
/// Source: public readers of the format; no description by its maker was found.
std::string rows_of_rtl(const std::string& text);

} // namespace gumshoe::scenario
