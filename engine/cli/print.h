#pragma once
/// Results on standard output, of `run` and `analyse`.
#include <string>

#include "analysis/results.h"
#include "base/error.h"

namespace gumshoe::cli {

/// As text, csv or json; `file`: where they were written. Too many failed samples: an error message and its code.
ExitCode print_results(const analysis::Results& results, const std::string& file, const std::string& format,
                       double max_failed_share);

} // namespace gumshoe::cli
