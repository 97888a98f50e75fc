#include "analysis/studies.h"

#include <algorithm>

#include "analysis/differences.h"
#include "analysis/pick_freeze.h"
#include "analysis/screening.h"
#include "analysis/shapley.h"

namespace gumshoe::analysis {

std::vector<propagation::Work> studies_of(const propagation::Experiment& e) {
  const auto& wanted = e.scenario().analysis.sensitivity;
  const bool independent = e.plan().copulas.empty(); // refused elsewhere
  std::vector<propagation::Work> all;
  const auto add = [&](std::vector<propagation::Work> works) { std::ranges::move(works, std::back_inserter(all)); };
  if (stencils_at_estimates(e))
    for (std::size_t reading = 0; reading < e.outputs().size() / e.measurands().size(); ++reading)
      all.push_back(stencil_work(e, reading));
  if (wanted.sobol > 0 && independent) all.push_back(pick_freeze_work(e, wanted.sobol, wanted.second_order));
  if (wanted.shapley > 0) add(shapley_work(e, wanted.shapley));
  if (wanted.morris > 0 && independent) all.push_back(morris_work(e, wanted.morris));
  if (wanted.dgsm > 0) all.push_back(dgsm_work(e, wanted.dgsm));
  add(one_at_a_time_work(e));
  return all;
}

} // namespace gumshoe::analysis
