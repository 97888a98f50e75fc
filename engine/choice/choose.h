#pragma once
/// Which settings measure within a target expanded uncertainty in the least time?
#include "choice/search.h"

namespace gumshoe::choice {

/// Answers [choose] of a scenario, which must have one.
///
/// Candidates are compared with common random numbers (search.h). The fastest that meets the target is run again with
/// fresh random numbers and `confirm_samples`; if it then meets the target with less than `confirm_probability`, the
/// next fastest of less U is, and so on. If none meets the target the one of least U is taken, and said so.
/// Throws InputError: no candidate can be, or none has a value.
Result choose(const scenario::Scenario& scenario, const Settings& settings);

/// "feed 100 mm/min, readings 6, single": values in the units people are shown.
std::string in_words(const std::vector<scenario::Setting>& settings, const std::vector<std::string>& evaluations);
/// "9.7 s", "2 min 5 s".
std::string duration(double seconds);

} // namespace gumshoe::choice
