#pragma once
/// The table behind effects::functions, for the sources that instantiate it. Nothing else includes this: it reads every
/// effect.
#include "effects/act.h"
#include "effects/all.h" // made by CMake from catalogue.def

namespace gumshoe::effects {

template <class T> std::span<const Apply<T>> functions() {
#define GUMSHOE_EFFECT(folder, type) &type::apply<T>,
  static constexpr Apply<T> table[] = {
#include "effects/catalogue.def"
  };
#undef GUMSHOE_EFFECT
  return table;
}

} // namespace gumshoe::effects
