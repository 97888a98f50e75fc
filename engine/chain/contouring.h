#pragma once
/// Slides that follow a contour: what the stage contouring sees and adds to. The model follows its contour once with the
/// declared servo, which fills in the slides, and once more with what effects have made of it.
#include "chain/probing_event.h"

namespace gumshoe::chain {

/// One slide that follows.
template <class T> struct Following {
  // as the declared servo moves it, known to effects
  T since_reversal = T(1e9); ///< s; 1e9: it has not turned round
  // effects add to
  T gain_error = T(0.0); ///< of the loop gain, relative
};

template <class T> struct Contouring {
  Following<T> x, y, z;
  T delay = T(0.0);      ///< of the moment at which all bars are read, s
  T compliance = T(0.0); ///< of the bracket that holds the tool's ball: deflection by acceleration, s2
};

} // namespace gumshoe::chain
