#pragma once
/// The report generator, reports/report.py.
#include <string>
#include <vector>

#include "base/error.h"

namespace gumshoe::cli {

/// Its place. Throws InputError if there is none: before long work whose report is wanted.
std::string generator_script();

/// Runs it with these words and waits. GUMSHOE_REPORTS in the environment names another folder. `bad_input` if it
/// complained; throws InputError if it could not be started.
ExitCode generate(const std::vector<std::string>& words);

} // namespace gumshoe::cli
