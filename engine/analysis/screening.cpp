#include "analysis/screening.h"
namespace gumshoe::analysis {
std::vector<Morris> morris_screening(const propagation::Experiment&, std::uint64_t, int) { return {}; }
std::vector<Dgsm> derivative_measures(const propagation::Experiment&, std::uint64_t, const std::vector<Summary>&, int) { return {}; }
std::vector<OneAtATimeTable> one_at_a_time(const propagation::Experiment&) { return {}; }
} // namespace gumshoe::analysis
