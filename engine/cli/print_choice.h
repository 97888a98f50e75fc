#pragma once
/// The answer of `gumshoe choose` on standard output.
#include <string>

#include "choice/results.h"

namespace gumshoe::cli {

/// text: the recommendation, what limits it, how flat it is, what it is compared with. csv: one row per candidate.
/// json: everything. In the units people are shown; `file` is where the whole of it stands.
void print_choice(const choice::Result& result, const std::string& file, const std::string& format);

} // namespace gumshoe::cli
