#pragma once
/// A named variable with its unit, as a scenario or a plugin declares it at run time.
#include <string>

#include "base/card.h"

namespace gumshoe {

struct Symbol {
  std::string name;
  std::string unit;    ///< shown to people
  std::string si_unit; ///< used inside
  std::string meaning;
  double default_value = 0; ///< SI
  Limits limits{-1e150, 1e150}; ///< of larger numbers there is no square in double precision
};

} // namespace gumshoe
