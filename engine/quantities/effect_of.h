#pragma once
/// How a quantity's name says whose it is: "runout.size" is the size of the effect `runout`.
#include <string>

namespace gumshoe::quantities {

/// Empty for a quantity of the model itself.
inline std::string effect_of(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

} // namespace gumshoe::quantities
