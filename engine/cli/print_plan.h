#pragma once
/// A plan for people and for programs.
#include <string>

#include "tracing/planning/planning.h"

namespace gumshoe::cli {

/// The table of readings: columns as in the data file, a row each, what is to be read left empty.
std::string plan_table(const scenario::Scenario& scenario, const tracing::Planned& plan);

/// @param file    where the table was written
/// @param format  text, csv or json
void print_plan(const scenario::Scenario& scenario, const tracing::Planned& plan, const std::string& file,
                const std::string& format);

} // namespace gumshoe::cli
