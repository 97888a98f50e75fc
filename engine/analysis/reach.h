#pragma once
/// Which input draws (variates) the outputs of a reading depend on, and through which quantity.
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

struct Reach {
  std::size_t variate;
  std::size_t quantity; ///< in whose column it is added, with slope one: place in Experiment::point
};

/// Every pair of a variate and the column that it is part of at a reading, in the order of the columns. A variate stands
/// twice if it is part of two columns.
inline std::vector<Reach> variates_reaching(const propagation::Experiment& e, std::size_t reading) {
  std::vector<Reach> found;
  const auto& columns = e.columns_at(reading);
  for (std::size_t q = 0; q < columns.size(); ++q)
    for (const std::size_t v : e.plan().columns[columns[q]].variates) found.push_back({v, q});
  return found;
}

} // namespace gumshoe::analysis
