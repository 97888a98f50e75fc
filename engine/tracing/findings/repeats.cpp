/// What repeats after everything found, and blocks that differ from the others.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/judgement/what_repeats.h"
#include "tracing/noise/block_spread.h"

namespace gumshoe::tracing {

void describe_repeats(const TraceContext& c, const Search& s, Trace& out) {
  const JointFit& fit = out.vetoed ? s.base : s.found;
  const Assessment& assessment = out.vetoed ? s.first : s.last;
  const double alpha = c.alpha_given(!out.vetoed && !s.findings.empty()), reference = fit.design.reference[0];
  const Repeats repeats = repeats_of(c, fit);
  const Vector residual = fit.residual(c.fitter.rows());
  LackOfFit& lack = out.lack_of_fit;
  if (repeats.pure.known()) {
    lack.p_value = assessment.p_lack_of_fit;
    lack.size = reference * repeats.pure.repeats(residual);
    lack.found = lack.p_value <= alpha && lack.size > 0;
    if (lack.found) lack.depends_on = repeats.pure.depends_on(residual);
  }
  if (repeats.blocks == 0) return;
  const BlockSpread spread = block_spread(repeats.pure.about_cells(residual), repeats.block, repeats.blocks);
  for (std::size_t b = 0; b < assessment.p_block.size(); ++b)
    if (assessment.p_block[b] <= alpha)
      out.anomalous_blocks.push_back({c.observations.blocks.groups[b], assessment.p_block[b],
                                      reference * spread.typical(index(b), 0), reference * spread.others(index(b), 0)});
  std::ranges::stable_sort(out.anomalous_blocks, {}, &AnomalousBlock::p_value);
}

} // namespace gumshoe::tracing
