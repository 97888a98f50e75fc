#pragma once
/// Where a program has no finite value, and why.
#include "formula/compile.h"
#include "formula/interpreter.h"

namespace gumshoe::formula {

/// Throws InputError at the operator of the first step without a finite value; says what its operands are made of.
/// @param program of `compiled`
void require_finite(const Compiled& compiled, const Program& program, const Inputs<double>& at);

} // namespace gumshoe::formula
