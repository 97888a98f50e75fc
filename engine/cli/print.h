#pragma once
/// Results on standard output, in the units people are shown: of `run` and `analyse`.
#include <string>

#include "analysis/results.h"
#include "base/error.h"

namespace gumshoe::cli {

/// A few lines: the statements, and what each study found. `out` is where the whole of it stands.
void print_text(const analysis::Results& results, const std::string& out);

/// One row or object per output, all digits: CSV or JSON.
void print_table(const analysis::Results& results, bool json);

/// As text, csv or json; `file`: where they were written. Too many failed samples, or an adaptive run that did not get
/// there: an error message and its code.
ExitCode print_results(const analysis::Results& results, const std::string& file, const std::string& format,
                       double max_failed_share);

} // namespace gumshoe::cli
