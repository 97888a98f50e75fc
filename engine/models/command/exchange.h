#pragma once
/// The tables that are sent to a command and returned by it.
#include <cstdint>
#include <string>
#include <vector>

#include "base/card.h"
#include "models/shown_columns.h"

namespace gumshoe::models {

/// CSV of points [first, first + n) of a reading, 17 significant digits: `name (unit)` of quantities, conditions and
/// indications in card order.
std::string points_table(const ModelCard& card, const ShownReading& reading, std::size_t first, std::size_t n);

/// Reads a command's CSV of n rows into the measurands [measurand][n], SI: columns `name (unit)` or `name` in any
/// order, others ignored. A cell that is empty or no finite number makes its sample a failed one. Throws InputError
/// with what, why and no place: no header, a missing column, a unit of another kind, another number of rows or cells.
void read_results(const ModelCard& card, const std::string& text, std::size_t n, double* const* measurands,
                  std::uint8_t* status);

} // namespace gumshoe::models
