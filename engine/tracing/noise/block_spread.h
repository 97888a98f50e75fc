#pragma once
/// Scatter of each block against that of the others, robust: a single bad reading makes no block differ.
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

struct BlockSpread {
  Matrix statistic; ///< [block][set]: n_b (ln of the ratio of medians)^2 of the absolute residuals, 0 where it is smaller
  Matrix typical;   ///< [block][set]: standard deviation by that median
  Matrix others;    ///< [block][set]: the same of all other blocks together
};

/// @param residuals  rows x sets, of equal standard deviation where nothing differs
/// @param block      by row
BlockSpread block_spread(const Matrix& residuals, const std::vector<std::size_t>& block, std::size_t blocks);

} // namespace gumshoe::tracing
