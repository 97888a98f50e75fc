#include "tracing/judgement/beside.h"

#include <algorithm>
#include <array>
#include <limits>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

namespace {

/// Whether two shapes share the conditions of a third between them: one has the first, the other the second.
bool share_between_them(const Candidate& one, const Candidate& other, const Candidate& both) {
  return one.depends_on.size() == 1 && other.depends_on.size() == 1 && both.depends_on.size() == 2 &&
         std::ranges::is_permutation(std::array{one.depends_on[0], other.depends_on[0]}, both.depends_on);
}

/// Whether a candidate may be the other of two. A declared value would take the bend of any table, as would a second
/// shape of the same condition.
bool is_another(const Evidence& e, const Observations& o, std::size_t a, const Candidate& simpler,
                const Candidate& shape) {
  const Candidate& c = e.candidates()[a];
  if (c.physical()) return e.testable(a) && c.family != Family::declared && !c.in_part();
  if (share_between_them(simpler, c, shape)) return true;
  // Commanded conditions form one plan: a table by positions is not a chance sum of curves.
  const auto recorded = [&](const std::string& name) {
    const auto known = std::ranges::find(o.covariates, name, &Covariate::name);
    return known != o.covariates.end() && !known->commanded &&
           std::ranges::find(simpler.depends_on, name) == simpler.depends_on.end();
  };
  // Two unknown causes with as many sizes as one are not simpler: three machines that differ, not one and a drift.
  return c.family == Family::shape && c.columns.cols() == 1 && simpler.columns.cols() + 1 < shape.columns.cols() &&
         std::ranges::all_of(c.depends_on, recorded);
}

bool depends_within(const Candidate& a, const Candidate& b) {
  return std::ranges::all_of(a.depends_on, [&](const std::string& name) {
    return std::ranges::find(b.depends_on, name) != b.depends_on.end();
  });
}

/// What one shape of no more sizes than the two explains, where the effect depends on nothing that the simpler shape
/// does not: every curve in these conditions holds some of the effect.
double by_one_shape(const Evidence& e, const Candidate& effect, const Candidate& simpler) {
  double best = 0;
  if (!depends_within(effect, simpler)) return best;
  for (std::size_t a = 0; a < e.candidates().size(); ++a)
    if (const Candidate& c = e.candidates()[a]; !c.physical() && depends_within(c, simpler) &&
                                                c.columns.cols() <= effect.columns.cols() + simpler.columns.cols())
      best = std::max(best, e.score(a));
  return best;
}

} // namespace

std::optional<std::size_t> simpler_beside_another(const Evidence& e, const Observations& o, std::size_t shape) {
  std::vector<Scored> simpler;
  for (std::size_t a = 0; a < e.candidates().size(); ++a) {
    const Candidate& c = e.candidates()[a];
    simpler.push_back({c.name, e.score(a),
                       !c.physical() && c.columns.cols() < e.candidates()[shape].columns.cols() &&
                           e.assessment().p[a] <= e.assessment().threshold});
  }
  const std::size_t of_shape = e.scan().fit(shape, e.residuals()).covariance_model;
  // The simplest, then the best.
  std::pair<Index, double> best{std::numeric_limits<Index>::max(), 0};
  std::optional<std::size_t> out;
  for (const std::size_t s : best_of(simpler, criteria.most_shapes)) {
    // The noise as it is with the simpler shape, or with the whole one: without a signature a large effect passes for
    // correlation; with the simpler shape alone the other one does.
    const Fit alone = e.scan().fit(s, e.residuals());
    std::vector<std::size_t> with{s};
    for (std::size_t a = 0; a < e.candidates().size(); ++a)
      if (is_another(e, o, a, e.candidates()[s], e.candidates()[shape])) with.push_back(a);
    const Matrix pairs = e.scan()
                             .pair_criteria(with, 1, e.residuals(), alone.covariance_model)
                             .cwiseMin(e.scan().pair_criteria(with, 1, e.residuals(), of_shape));
    for (std::size_t i = 1; i < with.size(); ++i) {
      const std::size_t a = with[i];
      const double added = std::max(0.0, e.assessment().data.criterion[0] - pairs(0, index(i)) - alone.ratio);
      const double both = simpler[s].score + added - 2 * e.assessment().null[a].mean;
      const std::pair order{e.candidates()[s].columns.cols(), -both};
      if (both >= by_one_shape(e, e.candidates()[a], e.candidates()[s]) &&
          counts_beside(both, {e.score(a), simpler[s].score}, added, {e.limit(a), e.limit(s)}, e.score(shape)) &&
          order < best) {
        best = order;
        out = s;
      }
    }
  }
  return out;
}

} // namespace gumshoe::tracing
