#include "analysis/outputs.h"

#include <algorithm>

namespace gumshoe::analysis {

std::vector<std::size_t> outputs_named(const propagation::Experiment& e, const std::string& measurand,
                                       const quantities::Labels& labels) {
  std::vector<std::size_t> found;
  for (std::size_t o = 0; o < e.outputs().size(); ++o) {
    const auto& has = e.outputs()[o].labels;
    if (e.outputs()[o].measurand == measurand &&
        std::ranges::all_of(labels, [&](const auto& wanted) { return std::ranges::find(has, wanted) != has.end(); }))
      found.push_back(o);
  }
  return found;
}

} // namespace gumshoe::analysis
