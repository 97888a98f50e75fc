/// Sizes with which readings jump: the best of all together by the exact model.
#include <algorithm>

#include "tracing/fit/jumping_sizes.h"
#include "tracing/fit/starts.h"

namespace gumshoe::tracing {
namespace {

bool starts(const Term& t) { return !t.candidate.start.empty() && std::ranges::equal(t.candidate.start, t.size); }

} // namespace

Term at_start(const Candidate& a) {
  Term out{a, Eigen::Map<const Vector>(a.start.data(), index(a.start.size()))};
  out.candidate.columns = Matrix::Zero(a.columns.rows(), out.size.size());
  return out;
}

double found_size(const Term& term) {
  const auto& start = term.candidate.start;
  return std::max(Eigen::Map<const Vector>(start.data(), index(start.size())).norm(), term.size.norm());
}

bool Fitter::any_jumps(const JointFit& fit) const {
  return !jumping_unknowns().empty() ||
         std::ranges::any_of(fit.terms, [](const Term& t) { return !t.candidate.start.empty(); });
}

double jump_reach(const std::vector<Term>& terms, const JointFit* before) {
  if (std::ranges::any_of(terms, starts)) return criteria.jump_reach;
  return before && before->terms.size() == terms.size() ? 0 : criteria.jump_reach_again;
}

std::optional<Start> Fitter::best_start(const JointFit& fit, const Candidate& candidate, const Matrix& sizes,
                                        double step) const {
  JointFit with = fit;
  for (Term& t : with.terms) t.candidate.start.clear(); // as they are
  Term own{candidate, Vector::Zero(sizes.rows())};
  own.candidate.start.assign(index(sizes.rows()), 0);
  with.terms.push_back(std::move(own));
  if (!linearise(with)) return std::nullopt;
  const JumpingSizes jumping(*this, with, false);
  std::vector<bool> valid;
  Starts starts(jumping.reduced(Matrix::Zero(sizes.rows(), 1), valid).col(0), sizes.rows(), jumping.freedom());
  const auto add = [&](const Matrix& more) {
    const Matrix reduced = jumping.reduced(more, valid);
    starts.add(more, reduced, valid);
  };
  add(sizes);
  for (int closer = 0; closer < criteria.closer_starts && starts.ratio() > criteria.decisive; ++closer) {
    add(starts.between_best(step, closer));
    step *= criteria.closer_start;
  }
  return starts.best();
}

/// Tries sizes at random about the best so far, from far to near.
bool Fitter::cross_jumps(JointFit& fit, double noise, double reach) const {
  if (!fit.valid || !any_jumps(fit)) return false;
  const JumpingSizes sizes(*this, fit);
  Vector best = Vector::Zero(sizes.count());
  const double here = sizes.left(best)[0];
  double least = here;
  const auto improve = [&](const Matrix& tried) {
    if (tried.cols() == 0) return false;
    Index at = 0;
    const Vector left = sizes.left(tried);
    if (!(left.minCoeff(&at) < least * (1 - 1e-6))) return false;
    least = left[at];
    best = tried.col(at);
    return true;
  };
  // The terms depend on each other: with a new one, each is searched again.
  if (reach >= criteria.jump_reach && sizes.terms() > 1)
    for (std::size_t t = 0; t < sizes.terms(); ++t) improve(sizes.restarts(t, best));
  for (int batch = 0; reach > criteria.least_jump_reach && batch < criteria.most_jump_batches; ++batch) {
    const Matrix tried = (reach * sizes.scale().asDiagonal() * around(sizes.count(), batch)).colwise() + best;
    if (!improve(tried)) reach *= criteria.jump_closer;
  }
  if (!(least < here * (1 - 1e-6))) return false;
  JointFit next = fit;
  apply(next, sizes.with_others(best), 1);
  if (!linearise(next)) return false;
  converge(next, noise);
  fit = std::move(next);
  return true;
}

void Fitter::refine(JointFit& fit) const {
  constexpr double worth_another = 0.1; // 2 ln L: of sixty readings, a thousandth of the error
  for (int lesser = 0; lesser < criteria.most_optima; ++lesser) {
    const double before = fit.criterion;
    if (!cross_jumps(fit, 0, criteria.jump_reach_again) || !(before - fit.criterion > worth_another)) return;
  }
}

} // namespace gumshoe::tracing
