#pragma once
/// Rows of the mill model's card by name, and readings made of plain vectors.
#include <vector>

#include "models/tool_length/tool_length.h"

namespace gumshoe::tests {

namespace mill = models::tool_length;
using Row = mill::Rows::QuantitiesRow;
using Commanded = mill::Rows::ConditionsRow;
using Stated = mill::Rows::MeasurandsRow;

inline constexpr std::size_t quantities = models::rows_of<mill::Quantities>,
                             measurands = models::rows_of<mill::Rows::Measurands>;

/// Rows of the joint evaluations' measurands; of each flute three more.
enum { joint_length_row, joint_effective_row };
enum { phase_row = 2, seen_flutes_row, residual_row, freedom_row, curve_rows };
enum { peak_rows = 3 };
enum { flute_length_row, wear_difference_row, seen_row, flute_rows };

template <class T> mill::Quantities<T> named(const std::vector<T>& q) {
  return models::named<mill::Quantities>(q.data());
}

} // namespace gumshoe::tests
