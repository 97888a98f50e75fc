#pragma once
/// The scenario with its estimated quantities as known ones: what `gumshoe estimate` writes and `gumshoe run` reads.
#include "calibration/estimate.h"

namespace gumshoe::calibration {

/// Start of the source of every value that an estimate wrote.
inline constexpr const char* estimate_source = "gumshoe estimate of ";

/// The scenario's text anew: every estimated quantity has its value, u and source, and a correlation of kind pearson
/// ties them; the source names the hash of scenario and data. Paths of data files are made relative to `folder`, where
/// the text will stand. Throws InputError if the data leave a quantity undetermined or nothing says how uncertain it
/// is.
std::string estimated_scenario(const propagation::Experiment& experiment, const Estimate& estimate,
                               const std::string& folder);

} // namespace gumshoe::calibration
