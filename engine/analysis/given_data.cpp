#include "analysis/given_data.h"
namespace gumshoe::analysis {
std::vector<GivenData> given_data_indices(const propagation::Experiment&, const ValuesOf&, std::uint64_t, int) { return {}; }
} // namespace gumshoe::analysis
