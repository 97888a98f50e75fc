#pragma once
/// Rows of cards of models on a described machine: the errors and the commands of its axes.
#include "base/symbol.h"
#include "chain/axis.h"

namespace gumshoe::models {

/// An error of an axis as a quantity. @param kind chain::ErrorKind, of a link chain::LinkError
Symbol error_row(const chain::Axis& axis, int kind, double default_value);

/// The command of an axis as a condition.
Symbol command_row(const chain::Axis& axis);

} // namespace gumshoe::models
