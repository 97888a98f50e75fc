#include "analysis/conformity.h"
namespace gumshoe::analysis {
std::vector<ConformityResult> conformity(const propagation::Experiment&, const ValuesOf&, const std::vector<Summary>&) { return {}; }
} // namespace gumshoe::analysis
