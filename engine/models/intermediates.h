#pragma once
/// Intermediate values of `explain` that are vectors.
#include <string>
#include <vector>

#include "base/si.h"
#include "math/pose.h"
#include "models/model.h"

namespace gumshoe::models {

/// Appends "what, X", "what, Y" and "what, Z". @param factor units per SI unit
inline void add(std::vector<Intermediate>& out, const std::string& what, const Vector3<double>& v,
                const char* unit = "mm", double factor = 1 / si::mm) {
  out.insert(out.end(), {{what + ", X", unit, v.x * factor},
                         {what + ", Y", unit, v.y * factor},
                         {what + ", Z", unit, v.z * factor}});
}

} // namespace gumshoe::models
