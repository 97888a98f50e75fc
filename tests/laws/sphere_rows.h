#pragma once
/// Rows of the sphere model's card by name, and readings made of plain vectors.
#include <vector>

#include "models/sphere_calibration/sphere_calibration.h"

namespace gumshoe::tests {

namespace sphere = models::sphere_calibration;
using Row = sphere::Rows::QuantitiesRow;
using Commanded = sphere::Rows::ConditionsRow;
using Found = sphere::JointRows::MeasurandsRow;

inline constexpr std::size_t quantities = models::rows_of<sphere::Quantities>,
                             conditions = models::rows_of<sphere::Conditions>;

/// Row of an unknown of the identification among its measurands.
inline std::size_t row_of(std::size_t unknown) {
  std::size_t row = 0;
  while (sphere::joint_cards[row].name != sphere::quantity_cards[unknown].name) ++row;
  return row;
}

template <class T>
sphere::At<T> reading(int evaluation, const T* q, const std::vector<double>& condition,
                      const models::Freed<T>& freed = {}) {
  const std::vector<T> c(condition.begin(), condition.end());
  return {models::named<sphere::Quantities>(q), models::named<sphere::Conditions>(c.data()), freed, evaluation};
}
inline sphere::Links<double> links(const std::vector<double>& q) {
  return sphere::links(models::named<sphere::Quantities>(q.data()));
}

} // namespace gumshoe::tests
