#pragma once
/// Made-up outcomes of `gumshoe trace`, one of each kind: what its files and its report are tested with. The residuals
/// are computed from the effect that is said to be found.
#include <string>
#include <vector>

#include "store/trace_file.h"

namespace gumshoe::made {

struct Traced {
  scenario::Scenario scenario;
  tracing::Trace trace;
  store::TracedBudgets budgets;
};

/// named, class, scatter, not_in_catalogue, two_findings, vetoed, nothing_found, insufficient_data
std::vector<std::string> trace_names();
/// Throws std::out_of_range for another name.
Traced trace(const std::string& name);
/// Writes it to `path`.
void write_trace(const std::string& name, const std::string& path);

} // namespace gumshoe::made
