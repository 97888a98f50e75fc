#pragma once
/// Where candidates lie: on the finest grid that the refinements end in.
#include <vector>

#include "scenario/choose_options.h"

namespace gumshoe::choice {

/// By variable: position in its list, or of a range in parts of the finest grid.
using Place = std::vector<int>;

class Places {
public:
  explicit Places(const scenario::Choose& choose) : choose_(choose) {}
  double value(std::size_t variable, int place) const;
  int parts(std::size_t variable) const; ///< of the finest grid of a range; of a list its size less 1
  /// Every combination of lists and coarse grids. Throws InputError if there are more than 50,000.
  std::vector<Place> coarse() const;
  /// The centre and its neighbours, `step` parts away in any of the ranges.
  std::vector<Place> around(const Place& centre, int step) const;

private:
  const scenario::Choose& choose_;
};

} // namespace gumshoe::choice
