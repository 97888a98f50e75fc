/// Compiled once per instruction set.
#include "tracing/noise/elimination_kernels.h"

#include <cmath>

#include "math/lanes.h"

namespace gumshoe::tracing {
namespace {

/// The values of one row, or of one slot, of all columns treated together.
template <std::size_t lanes> struct Values {
  static constexpr std::size_t parts = lanes / Lanes::size;
  Lanes part[parts];
  explicit Values(const double* x) {
    for (std::size_t p = 0; p < parts; ++p) part[p] = Lanes::load_unaligned(x + p * Lanes::size);
  }
  void store(double* x) const {
    for (std::size_t p = 0; p < parts; ++p) part[p].store_unaligned(x + p * Lanes::size);
  }
};

/// (z, y) -> (c z + s y, c y - s z)
template <std::size_t lanes> void rotate(double cosine, double sine, double* state, Values<lanes>& y) {
  const Lanes c(cosine), s(sine);
  for (std::size_t p = 0; p < Values<lanes>::parts; ++p) {
    double* at = state + p * Lanes::size;
    const Lanes z = Lanes::load_unaligned(at);
    (c * z + s * y.part[p]).store_unaligned(at);
    y.part[p] = c * y.part[p] - s * z;
  }
}

/// Row `y` given the row before it, which it then replaces.
template <std::size_t lanes> void decorrelate(double correlation, bool first, double* before, Values<lanes>& y) {
  const Values<lanes> own = y;
  const Lanes rho(correlation), factor(1 / std::sqrt(1 - correlation * correlation));
  if (!first) {
    const Values<lanes> last(before);
    for (std::size_t p = 0; p < Values<lanes>::parts; ++p) y.part[p] = factor * (y.part[p] - rho * last.part[p]);
  }
  own.store(before);
}

template <std::size_t lanes> void clear(double* state) {
  for (std::size_t i = 0; i < lanes; ++i) state[i] = 0;
}

template <std::size_t lanes> void reduce_of(const EliminationPlan& plan, double* t, double* state, double* kept) {
  std::uint32_t open = 0, turn = 0, close = 0;
  for (std::size_t row = 0; row < plan.rows; ++row, t += lanes) {
    for (; open < plan.opened_end[row]; ++open) clear<lanes>(state + lanes * plan.opened[open]);
    Values<lanes> y(t);
    if (plan.correlation != 0)
      decorrelate<lanes>(plan.correlation, row < plan.lag, state + lanes * (plan.slots + row % plan.lag), y);
    for (; turn < plan.rotation_end[row]; ++turn)
      rotate<lanes>(plan.cosine[turn], plan.sine[turn], state + lanes * plan.slot[turn], y);
    y.store(t);
    for (; close < plan.closed_end[row]; ++close)
      for (std::size_t i = 0; kept && i < lanes; ++i) kept[lanes * close + i] = state[lanes * plan.closed[close] + i];
  }
}

/// Row `y` as the transpose of what makes rows uncorrelated has it; `after` is the row a lag after it, which it
/// replaces.
template <std::size_t lanes>
void correlate(double correlation, bool first, bool last, double* after, Values<lanes>& y) {
  const Values<lanes> own = y;
  const Lanes rho(correlation), factor(1 / std::sqrt(1 - correlation * correlation));
  const Values<lanes> next(after);
  for (std::size_t p = 0; p < Values<lanes>::parts; ++p) {
    if (!first) y.part[p] = factor * y.part[p];
    if (!last) y.part[p] = y.part[p] - rho * (factor * next.part[p]);
  }
  own.store(after);
}

template <std::size_t lanes> void restore_of(const EliminationPlan& plan, double* t, double* state) {
  for (std::size_t row = plan.rows; row-- > 0;) {
    const std::size_t before = row > 0 ? row - 1 : 0;
    for (std::uint32_t i = row > 0 ? plan.closed_end[before] : 0; i < plan.closed_end[row]; ++i)
      clear<lanes>(state + lanes * plan.closed[i]);
    Values<lanes> y(t + lanes * row);
    for (std::uint32_t i = plan.rotation_end[row]; i-- > (row > 0 ? plan.rotation_end[before] : 0);)
      rotate<lanes>(plan.cosine[i], -plan.sine[i], state + lanes * plan.slot[i], y);
    if (plan.correlation != 0)
      correlate<lanes>(plan.correlation, row < plan.lag, row + plan.lag >= plan.rows,
                       state + lanes * (plan.slots + row % plan.lag), y);
    y.store(t + lanes * row);
  }
}

void reduce(const EliminationPlan& plan, std::size_t lanes, double* t, double* state, double* kept) {
  (lanes == elimination_lanes ? reduce_of<elimination_lanes> : reduce_of<few_elimination_lanes>)(plan, t, state, kept);
}

void restore(const EliminationPlan& plan, std::size_t lanes, double* t, double* state) {
  (lanes == elimination_lanes ? restore_of<elimination_lanes> : restore_of<few_elimination_lanes>)(plan, t, state);
}

} // namespace
} // namespace gumshoe::tracing

extern "C" const gumshoe::tracing::EliminationKernels GUMSHOE_KERNEL(gumshoe_elimination_);
const gumshoe::tracing::EliminationKernels GUMSHOE_KERNEL(gumshoe_elimination_) = {gumshoe::tracing::reduce,
                                                                                   gumshoe::tracing::restore};
