#pragma once
/// Points on a scale, such as temperatures in degC: which results of theirs are points again.
#include <string>
#include <vector>

#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// One sentence per measurand that is stated in a unit with a zero of its own (degC, degF) but is no point on that
/// scale: shifting all inputs in such units by one degree does not shift it by one degree. So do the sum of two
/// temperatures, and their difference, which belongs in K. One that is stated in K has a sentence where such inputs are
/// added: a reading and its correction. So has one of another kind that is proportional to one such input, where the
/// model has derivatives: 2 degC are 275.15 K. The noise of an indication that is predicted is a difference. By the
/// derivatives at the estimates of the first reading.
std::vector<std::string> scale_point_notes(const propagation::Experiment& experiment,
                                           const propagation::Workers& workers = 1);

} // namespace gumshoe::analysis
