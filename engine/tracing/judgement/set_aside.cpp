#include "tracing/judgement/set_aside.h"

#include <algorithm>

#include <fmt/format.h>

#include "tracing/criteria.h"
#include "tracing/judgement/pruning.h"

namespace gumshoe::tracing {
namespace {

/// Rows of the readings of a fit of which some indication is winsorised.
std::vector<Index> winsorised_rows(const JointFit& fit, const std::vector<Index>& rows) {
  const Whitened plain(fit.design, rows, independent(fit.design, rows), {});
  Matrix weight;
  plain.winsorised(plain.take(fit.residual), nullptr, &weight);
  const auto k = index(fit.design.indications);
  std::vector<Index> out;
  for (Index i = 0; i < weight.rows(); ++i)
    if ((weight.middleRows(i / k * k, k).array() < 1).any()) out.push_back(rows[index(i)]);
  return out;
}

} // namespace

std::vector<Index> outlying_rows(const TraceContext& c, const JointFit& fit) {
  const std::size_t rows = c.fitter.rows().size(), k = c.observations.indications,
                    most = std::max<std::size_t>(1, rows / k / criteria.readings_for_outlier) * k;
  std::vector<Index> out = winsorised_rows(fit, c.fitter.rows());
  for (std::vector<Index> more = out; !more.empty() && out.size() <= most;) {
    const Fitter others = c.fitter.without_rows(out);
    const JointFit left = others.fit(fit.terms, 0);
    if (!left.valid) return {};
    more = winsorised_rows(left, others.rows());
    out.insert(out.end(), more.begin(), more.end());
    std::ranges::sort(out);
  }
  return out.size() <= most ? out : std::vector<Index>{};
}

Search with_all_readings(const TraceContext& c, const Search& all, Search without, std::size_t set_aside) {
  fit_all_anew(c, all.base, without);
  without.dropped.push_back(fmt::format(
      "{} outlying {} set aside in the search: with {}, single readings would seem to scatter more than declared",
      set_aside, set_aside == 1 ? "reading was" : "readings were", set_aside == 1 ? "it" : "them"));
  for (Stage& stage : without.stages) stage.dropped.push_back(without.dropped.back());
  return without;
}

} // namespace gumshoe::tracing
