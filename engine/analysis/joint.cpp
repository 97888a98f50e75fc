#include "analysis/joint.h"
namespace gumshoe::analysis {
std::vector<JointRegion> joint_regions(const propagation::Experiment&, const ValuesOf&) { return {}; }
std::vector<CircularSummary> circular_summaries(const propagation::Experiment&, const ValuesOf&) { return {}; }
} // namespace gumshoe::analysis
