#pragma once
/// Which input draws (variates) the outputs of a reading depend on, and through which quantities.
#include <map>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

struct Reach {
  std::size_t variate;
  /// In whose columns it is added, with slope one: places in Experiment::point. More than one where the readings of a
  /// joint evaluation share it.
  std::vector<std::size_t> quantities;
};

/// The variates that reach the outputs of a reading, in the order of the first columns that they are part of.
inline std::vector<Reach> variates_reaching(const propagation::Experiment& e, std::size_t reading) {
  std::vector<Reach> found;
  std::map<std::size_t, std::size_t> at; // place in `found` by variate
  const auto& columns = e.columns_at(reading);
  for (std::size_t q = 0; q < columns.size(); ++q)
    for (const std::size_t v : e.plan().columns[columns[q]].variates) {
      const std::size_t place = at.try_emplace(v, found.size()).first->second;
      if (place == found.size()) found.push_back({v, {}});
      found[place].quantities.push_back(q);
    }
  return found;
}

} // namespace gumshoe::analysis
