#pragma once
/// Scatter of each block against that of the others, robust: a single bad reading makes no block differ.
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

struct BlockSpread {
  Matrix statistic; ///< [block][set]: n_b (ln of the ratio of mean sizes)^2, 0 where that of the block is smaller
  Matrix typical;   ///< [block][set]: standard deviation of normal numbers of that mean size
  Matrix others;    ///< [block][set]: the same of all other blocks together
};

/// Sizes are absolute residuals, winsorised at criteria.winsor_limit robust standard deviations of all; `typical` and
/// `others` are not.
/// @param residuals  rows x sets, of equal standard deviation where nothing differs
/// @param block      by row
BlockSpread block_spread(const Matrix& residuals, const std::vector<std::size_t>& block, std::size_t blocks);

} // namespace gumshoe::tracing
