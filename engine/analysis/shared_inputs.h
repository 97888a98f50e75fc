#pragma once
/// Inputs that several results have in common, found by their budgets.
#include <span>
#include <string>
#include <vector>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Budget of the output of that name; null if the result has none.
const Budget* budget_of(const Results& result, const std::string& output);

/// Component of that name, such as "rod_length[rod 1]: seat"; null if it is not in the budget, or there is none.
const Contribution* find_contribution(const Budget* budget, const std::string& component);

/// Contribution with its sign, c_i u_i; NaN if not differentiable.
double signed_contribution(const Contribution& contribution);

/// Whether two budgets seem to mean the same error: equal u and distribution. A reading's own scatter (Type A) is drawn
/// anew each time.
bool alike(const Contribution& a, const Contribution& b);

/// A quantity with which the result's scenario correlates this one; empty: none.
std::string correlated_with(const Results& result, const std::string& quantity);

/// Throws InputError unless each of the quantities that `--same` names stands in the budgets of at least two results,
/// and is correlated with no other one.
void require_shared(std::span<const std::string> same, std::span<const Results* const> results);

/// Throws InputError if the output depends on one of the quantities `--same` otherwise than in proportion, so that what
/// results share by it is not known from their budgets: the law of propagation does not account for the variance, and
/// no first-order index shows that its part of this quantity does.
/// @param where  "a.h5: y"
void require_proportional(std::span<const std::string> same, const Budget* budget, const Summary& summary,
                          const std::string& where);

/// Throws InputError unless all results have one coverage probability.
void require_one_coverage(std::span<const Results* const> results);

} // namespace gumshoe::analysis
