#pragma once
/// Which variates reach a reading, and through which quantity.
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

struct Reach {
  std::size_t variate;
  std::size_t quantity; ///< in whose column it is added, with slope one: place in Experiment::point
};

inline std::vector<Reach> variates_reaching(const propagation::Experiment& e, std::size_t reading) {
  std::vector<Reach> found;
  const auto& columns = e.columns_at(reading);
  for (std::size_t q = 0; q < columns.size(); ++q)
    for (const std::size_t v : e.plan().columns[columns[q]].variates) found.push_back({v, q});
  return found;
}

} // namespace gumshoe::analysis
