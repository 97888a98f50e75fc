/// The effects of the kernels, once per instruction set.
#include "effects/functions.h"

namespace gumshoe::effects {

template std::span<const Apply<double>> functions<double>();
template std::span<const Apply<Lanes>> functions<Lanes>();

} // namespace gumshoe::effects
