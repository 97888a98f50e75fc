#pragma once
/// Results on standard output, in the units people are shown.
#include <string>

#include "analysis/results.h"

namespace gumshoe::cli {

/// A few lines: the statements, and what each study found. `out` is where the whole of it stands.
void print_text(const analysis::Results& results, const std::string& out);

/// One row or object per output, all digits: CSV or JSON.
void print_table(const analysis::Results& results, bool json);

} // namespace gumshoe::cli
