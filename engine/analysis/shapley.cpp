#include "analysis/shapley.h"
namespace gumshoe::analysis {
std::vector<Shapley> shapley_effects(const propagation::Experiment&, std::uint64_t, int) { return {}; }
} // namespace gumshoe::analysis
