#pragma once
/// Which variates reach a reading, and through which quantity.
#include <vector>

#include "quantities/sample_plan.h"

namespace gumshoe::analysis {

struct Reach {
  std::size_t variate;
  std::size_t quantity; ///< in whose column it is added, with slope one
};

inline std::vector<Reach> variates_reaching(const quantities::SamplePlan& plan, std::size_t reading) {
  std::vector<Reach> found;
  for (std::size_t q = 0; q < plan.gather[reading].size(); ++q)
    for (const std::size_t v : plan.columns[plan.gather[reading][q]].variates) found.push_back({v, q});
  return found;
}

} // namespace gumshoe::analysis
