#pragma once
/// The uncertainty budget on a terminal. Private to `print`.
#include <ostream>
#include <string>
#include <vector>

#include "analysis/results.h"

namespace gumshoe::cli {

/// "largest contributions: rod_length 1.0 um (65 %), beam_pitch 0.7 um (32 %), ...; 9 more", by quantity. Where the
/// law of propagation does not account for the variance: the first-order `indices`, of components or of quantities;
/// without indices the contributions are said to be of first order only.
std::string largest_contributions(const analysis::Budget& budget, const analysis::Summary& summary,
                                  const analysis::Validation& validation,
                                  const std::vector<analysis::SobolIndex>& indices);

/// The whole table, with the rows that close it.
void print_budget(const analysis::Budget& budget, std::ostream& out);

} // namespace gumshoe::cli
