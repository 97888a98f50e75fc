#include "choice/places.h"

#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe::choice {

namespace {
constexpr std::size_t most_candidates = 50'000;
} // namespace

int Places::parts(std::size_t v) const {
  const auto& variable = choose_.variables[v];
  return variable.range ? (variable.steps - 1) << choose_.refinements : static_cast<int>(variable.values.size()) - 1;
}

double Places::value(std::size_t v, int place) const {
  const auto& variable = choose_.variables[v];
  return variable.range ? variable.at(place, parts(v)) : variable.values[static_cast<std::size_t>(place)];
}

std::vector<Place> Places::coarse() const {
  std::size_t count = 1;
  for (const auto& v : choose_.variables) {
    count *= v.values.size();
    if (count > most_candidates)
      throw InputError(fmt::format("choose.variables: more than {} combinations", most_candidates), "",
                       "use fewer steps or shorter lists");
  }
  std::vector<Place> out{{}};
  for (std::size_t v = 0; v < choose_.variables.size(); ++v) {
    const auto& variable = choose_.variables[v];
    const int n = variable.range ? variable.steps : static_cast<int>(variable.values.size());
    const int step = variable.range ? 1 << choose_.refinements : 1;
    std::vector<Place> longer;
    for (const Place& place : out)
      for (int i = 0; i < n; ++i) {
        longer.push_back(place);
        longer.back().push_back(i * step);
      }
    out = std::move(longer);
  }
  return out;
}

std::vector<Place> Places::around(const Place& centre, int step) const {
  std::vector<Place> out{{}};
  for (std::size_t v = 0; v < centre.size(); ++v) {
    std::vector<Place> longer;
    for (const Place& place : out)
      for (const int move : {0, -step, step}) {
        const int to = centre[v] + move;
        if (move != 0 && (!choose_.variables[v].range || to < 0 || to > parts(v))) continue;
        longer.push_back(place);
        longer.back().push_back(to);
      }
    out = std::move(longer);
  }
  return out;
}

} // namespace gumshoe::choice
