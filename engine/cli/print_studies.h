#pragma once
/// What the studies of a run found, for standard output. Private to `print`.
#include <ostream>

#include <nlohmann/json.hpp>

#include "analysis/results.h"

namespace gumshoe::cli {

/// A line or two for each joint region, conformity test, target, set of indices and adaptive run.
void print_studies(const analysis::Results& results, std::ostream& out);

/// The studies of one output as keys of its object, in its unit; a key is there only if the study was made.
void add_studies(const analysis::Results& results, const propagation::Output& output, nlohmann::ordered_json& object);

} // namespace gumshoe::cli
