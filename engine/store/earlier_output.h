#pragma once
/// An output of a finished run, for a scenario that has it as an input quantity.
#include <string>

#include "scenario/earlier.h"

namespace gumshoe::store {

/// Output "laser_z" or "laser_z[rod 1]" of the run in the file; without a label where the measurand has one row only.
/// Throws InputError: no result, not finished, a part of a run, another command's file, no such output.
scenario::EarlierOutput read_output(const std::string& file, const std::string& output);

} // namespace gumshoe::store
