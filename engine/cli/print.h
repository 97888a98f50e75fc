#pragma once
/// Results on standard output, in the units people are shown: of `run` and `analyse`.
#include <string>

#include "analysis/results.h"
#include "base/error.h"

namespace gumshoe::cli {

struct PrintOptions {
  std::string format = "text"; ///< text, csv or json
  bool budget = false;         ///< text: with every budget; csv: the budgets instead of the summary
  bool all = false;            ///< text: every output, however many there are
  double max_failed_share = 1;
};

/// The statements, the largest contributions, and what each study found. `file` holds everything.
void print_text(const analysis::Results& results, const std::string& file, const PrintOptions& options = {});

/// One object per output, all digits: everything that the text and the report show.
void print_json(const analysis::Results& results, const std::string& file);

/// One row per output, or per component of its budget, all digits.
void print_csv(const analysis::Results& results, bool budget = false);

/// As the options say. Too many failed samples, or an adaptive run that did not get there: an error message and its
/// code.
ExitCode print_results(const analysis::Results& results, const std::string& file, const PrintOptions& options);

} // namespace gumshoe::cli
