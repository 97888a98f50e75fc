#pragma once
/// Conformity assessment: JCGM 106.
#include "analysis/joint.h"

namespace gumshoe::analysis {

/// One for each of the scenario's tests and each output it names.
std::vector<ConformityResult> conformity(const propagation::Experiment& experiment, const ValuesOf& values,
                                         const std::vector<Summary>& summaries);

} // namespace gumshoe::analysis
