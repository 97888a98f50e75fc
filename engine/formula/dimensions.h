#pragma once
/// Do the formulas' dimensions fit together, and which do the results have?
#include "base/dimension.h"
#include "formula/resolve.h"

namespace gumshoe::formula {

/// What is known of a formula's value before any number is drawn.
struct Kind {
  Dimension dimension;
  bool literal = false; ///< made of bare numbers only: 1, 2 * 3; pi is none
  bool zero = false;    ///< the bare number 0, which is 0 of any dimension
  std::string unit;     ///< in which people state it; empty: the SI's
};

/// Kinds of the formulas in `order` (each after what it needs), by index. Problems stand at the operator or operand.
std::vector<Kind> kinds_of(const std::vector<Formula>& formulas, const std::vector<std::size_t>& order,
                           const Names& names, bool simulating, std::vector<Problem>& problems);

} // namespace gumshoe::formula
