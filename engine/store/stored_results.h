#pragma once
/// What a finished result says, read back from its file.
#include <string>
#include <vector>

#include "analysis/results.h"
#include "tracing/trace.h"

namespace gumshoe::store {

/// The figures of a run: title, coverage probability and, for every measurand, estimate, u, U, k, its degrees of
/// freedom, certificate and budget; nothing else is filled in. Check the file by read_identity() first.
analysis::Results read_results(const std::string& path);

/// What a trace says in brief.
/// A size that a trace found.
struct StoredSize {
  std::string finding, name, labels; ///< "axis_reversal", "backlash", ""
  std::string unit, si_unit;
  double value = 0, u = 0, low = 0, high = 0; ///< SI
};

struct StoredTrace {
  std::string title, verdict;
  bool vetoed = false; ///< the hold-out blocks rejected the findings
  tracing::Rms rms;    ///< residuals before and after, with the holdout's; other members are not filled in
  std::vector<std::string> findings; ///< by name
  std::vector<StoredSize> sizes;
};
StoredTrace read_trace(const std::string& path);

} // namespace gumshoe::store
