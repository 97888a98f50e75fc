#pragma once
/// The answer of `gumshoe trace` on standard output, for a terminal.
#include <string>
#include <vector>

#include "tracing/trace.h"

namespace gumshoe::cli {

/// `title`: of the scenario; `written`: files that hold the rest; `traced`: the scenario with what was found, or empty.
void print_trace(const tracing::Trace& trace, const std::string& title, const std::vector<std::string>& written,
                 const std::string& traced);

} // namespace gumshoe::cli
