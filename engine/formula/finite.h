#pragma once
/// Where a program has no finite value, and why.
#include "base/error.h"
#include "formula/compile.h"
#include "formula/interpreter.h"

namespace gumshoe::formula {

/// A formula has no finite value at the estimates.
class NotFinite : public InputError {
public:
  explicit NotFinite(const Problem& reason);
  /// The same of any other point: it does not name the estimates.
  const Problem& reason() const { return reason_; }

private:
  Problem reason_;
};

/// Throws NotFinite at the operator of the first step without a finite value; says what its operands are made of.
/// @param program of `compiled`
void require_finite(const Compiled& compiled, const Program& program, const Inputs<double>& at);

} // namespace gumshoe::formula
