/// Sizes with which readings jump: the best of all together by the exact model, and how far the readings know them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/fit/starts.h"

namespace gumshoe::tracing {

namespace {

bool starts(const Term& t) { return !t.candidate.start.empty() && std::ranges::equal(t.candidate.start, t.size); }

/// Normal numbers about zero, every other column three times as far.
Matrix around(Index rows, int batch) {
  Matrix out = normals(index(rows), index(criteria.jump_tries), static_cast<std::uint64_t>(batch), 11);
  for (Index k = 1; k < out.cols(); k += 2) out.col(k) *= 3;
  return out;
}

/// Changes of the sizes found that were tried, and how much worse than the best they explain the readings.
class Tried {
public:
  Tried(double freedom, Index sizes, double left_here) : freedom_(freedom), at_(Matrix::Zero(sizes, 1)), left_(1) {
    left_[0] = left_here;
  }

  void add(const Matrix& at, const Vector& left) {
    const Index old = at_.cols();
    at_.conservativeResize(Eigen::NoChange, old + at.cols());
    at_.rightCols(at.cols()) = at;
    left_.conservativeResize(old + at.cols());
    left_.tail(at.cols()) = left;
  }
  /// Those whose likelihood ratio (2 ln) to the best is not above a limit, or the best, so many at least; by column.
  Matrix within(double limit, std::size_t least) const {
    std::vector<Index> order(index(left_.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::stable_sort(order, std::ranges::less{}, [&](Index k) { return left_[k]; });
    const double bound = left_[order[0]] * std::exp(limit / freedom_);
    const auto end = std::ranges::find_if(order, [&](Index k) { return !(left_[k] <= bound); });
    order.resize(std::min(order.size(), std::max(least, static_cast<std::size_t>(end - order.begin()))));
    return at_(Eigen::all, order);
  }
  /// So many of them, each as often as it is likely; by place, ascending.
  std::vector<Index> drawn(Index draws) const {
    const Vector likely = (left_ / left_.minCoeff()).array().pow(-freedom_ / 2);
    std::vector<Index> out;
    double passed = 0;
    for (Index k = 0; k < left_.size(); ++k) {
      passed += likely[k] / likely.sum() * static_cast<double>(draws);
      while (static_cast<double>(out.size()) + 0.5 < passed) out.push_back(k);
    }
    return out;
  }
  Matrix at(const std::vector<Index>& places) const { return at_(Eigen::all, places); }

private:
  double freedom_;
  Matrix at_;
  Vector left_;
};

} // namespace

double found_size(const Term& term) {
  const auto& start = term.candidate.start;
  return std::max(Eigen::Map<const Vector>(start.data(), index(start.size())).norm(), term.size.norm());
}

/// Sizes of a fit with which readings jump, and the likelihood over them by the exact model, all else fitted.
class Fitter::JumpingSizes {
public:
  /// @param earlier  whether those that an earlier trace found are among them
  JumpingSizes(const Fitter& fitter, const JointFit& fit, bool earlier = true)
      : fitter_(fitter), fit_(fit), rest_(fit.design) {
    std::vector<Index> others;
    const auto add = [&](Size size, double found) {
      own_.push_back(size.column);
      sizes_.push_back(std::move(size));
      scale_.push_back(0.5 * found);
    };
    for (std::size_t u = 0; earlier && u < fitter.unknowns_.size(); ++u)
      if (const double jump = fitter.unknowns_[u].jump; jump > 0) add(fitter.size_of(fit, u), jump);
    for (std::size_t t = 0; t < fit.terms.size(); ++t) {
      const Term& term = fit.terms[t];
      if (term.candidate.start.empty()) continue;
      jumping_.push_back({&term, index(own_.size())});
      for (Index j = 0; j < term.size.size(); ++j) add(fitter.size_of(fit, t, j), found_size(term));
    }
    for (Index j = 0; j < fit.design.fixed.cols(); ++j)
      if (std::ranges::find(own_, j) == own_.end()) others.push_back(j);
    rest_.fixed = Matrix(fit.design.fixed(Eigen::all, others));
    const auto use = independent(rest_, fitter.rows_);
    plain_.emplace(rest_, fitter.rows_, use, CovarianceModel{});
    model_.emplace(rest_, fitter.rows_, use, fit.covariance_model);
    for (const Index j : use) columns_.push_back(others[index(j)]);
  }

  Index count() const { return index(own_.size()); }
  const std::vector<Index>& own() const { return own_; }
  std::size_t terms() const { return jumping_.size(); }
  /// Changes that give one term each of the sizes from which it was started, and leave the others changed by `change`.
  Matrix restarts(std::size_t term, const Vector& change) const {
    const auto& [of, first] = jumping_[term];
    const Matrix& tried = of->candidate.tried;
    Matrix out = change.replicate(1, tried.cols());
    if (tried.cols() > 0) out.middleRows(first, of->size.size()) = tried.colwise() - of->size;
    return out;
  }
  /// Half of the sizes from which they are sought.
  Vector scale() const { return Eigen::Map<const Vector>(scale_.data(), count()); }
  double freedom() const { return static_cast<double>(model_->degrees_of_freedom()); }

  /// Squares that are left under changes of the sizes (columns); infinite where there is no value.
  Vector left(const Matrix& changes) const {
    std::vector<bool> valid;
    const Matrix clean = residuals(changes, valid);
    Vector out = model_->squares(clean);
    for (Index k = 0; k < out.size(); ++k)
      if (!valid[index(k)]) out[k] = std::numeric_limits<double>::infinity();
    return out;
  }

  /// What is left under changes of the sizes, such that its squares are those of left(); invalid where there is no
  /// value.
  Matrix reduced(const Matrix& changes, std::vector<bool>& valid) const {
    return model_->reduce(residuals(changes, valid));
  }

  /// Tries about these sizes, each batch spread as those before it that were near enough.
  Tried explored() const {
    const Vector widest = scale();
    Tried tried(freedom(), count(), left(Vector::Zero(count()))[0]);
    Matrix covariance = (criteria.jump_reach_again * widest).array().square().matrix().asDiagonal();
    for (int batch = 0; batch < criteria.jump_samples; ++batch) {
      const Matrix at = Matrix(covariance.llt().matrixL()) * around(count(), 1000 + batch);
      tried.add(at, left(at));
      const Matrix near = tried.within(limit(), criteria.tries_that_tell * index(count()));
      covariance = near * near.transpose() / static_cast<double>(near.cols());
      covariance.diagonal() += (criteria.finest_jump_reach * widest).array().square().matrix();
    }
    return tried;
  }
  /// 2 ln L of all sizes together, a little more than 95 %.
  double limit() const { return criteria.decisive * static_cast<double>(count()); }

  /// Standard uncertainties by the straight line through the readings over these changes.
  Vector by_line(const Matrix& changes) const {
    std::vector<bool> valid;
    const Matrix moved = (-residuals(changes, valid)).colwise() + residuals(Matrix::Zero(count(), 1), valid).col(0);
    const Matrix products = changes * changes.transpose();
    const Matrix line = model_->reduce(moved * changes.transpose() * products.inverse());
    return (fit_.variance * Matrix(line.transpose() * line).inverse().diagonal()).cwiseSqrt();
  }

  /// Change of all fixed columns that goes with a change of the sizes.
  Vector with_others(const Vector& change) const {
    std::vector<bool> valid;
    const Vector x = model_->coefficients(residuals(change, valid));
    Vector out = Vector::Zero(fit_.design.fixed.cols());
    for (std::size_t j = 0; j < columns_.size(); ++j) out[columns_[j]] = x[index(j)];
    for (std::size_t i = 0; i < own_.size(); ++i) out[own_[i]] = change[index(i)];
    return out;
  }

  /// Changes of all readings, as they are predicted with these changes of the sizes; not a number where there is no
  /// value.
  Matrix predicted(const Matrix& changes) const {
    Matrix with_none(count(), changes.cols() + 1);
    with_none << changes, Vector::Zero(count());
    std::vector<bool> valid;
    Matrix left = residuals_of_all(with_none, valid);
    const Matrix x = model_->coefficients(plain_->winsorised(plain_->take(left)));
    const auto p = index(columns_.size());
    left -= fit_.design.fixed(Eigen::all, columns_) * x.topRows(p) + rest_.random * x.bottomRows(x.rows() - p);
    Matrix out = (-left.leftCols(changes.cols())).colwise() + left.col(changes.cols());
    for (Index k = 0; k < out.cols(); ++k)
      if (!valid[index(k)]) out.col(k).setConstant(nan);
    return out;
  }

private:
  Matrix residuals(const Matrix& changes, std::vector<bool>& valid) const {
    return plain_->winsorised(plain_->take(residuals_of_all(changes, valid)));
  }

  Matrix residuals_of_all(const Matrix& changes, std::vector<bool>& valid) const {
    std::vector<Variation> variations;
    std::vector<bool> within;
    for (Index k = 0; k < changes.cols(); ++k) {
      Variation v;
      within.push_back(true);
      for (std::size_t i = 0; i < own_.size(); ++i) {
        const double by = changes(index(i), k), to = sizes_[i].at + by;
        within.back() = within.back() && to >= sizes_[i].low && to <= sizes_[i].high;
        v.changes.push_back({sizes_[i].quantity, by, false});
      }
      if (!within.back()) v.changes.clear();
      variations.push_back(std::move(v));
    }
    variations.push_back({});
    Matrix f;
    fitter_.simulator_.vary(fit_.at, variations, f, valid);
    for (std::size_t k = 0; k < within.size(); ++k) valid[k] = valid[k] && within[k];
    const Matrix moved = f.leftCols(changes.cols()).colwise() - f.col(changes.cols()).eval();
    Matrix all = (-in_sequence(fitter_.observations_, moved)).colwise() + fit_.residual;
    for (Index k = 0; k < all.cols(); ++k)
      if (!valid[index(k)]) all.col(k) = fit_.residual;
    return all;
  }

  const Fitter& fitter_;
  const JointFit& fit_;
  Design rest_; ///< without the columns of these sizes
  std::optional<Whitened> plain_, model_;
  std::vector<Index> own_, columns_;
  std::vector<Size> sizes_;
  std::vector<double> scale_;
  std::vector<std::pair<const Term*, Index>> jumping_; ///< terms, and the place of their first size
};

bool Fitter::any_jumps(const JointFit& fit) const {
  return std::ranges::any_of(unknowns_, [](const FreeUnknown& u) { return u.jump > 0; }) ||
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
  const auto best_with = [&](const Matrix& more) {
    const Matrix reduced = jumping.reduced(more, valid);
    starts.add(more, reduced, valid);
    return starts.best();
  };
  auto best = best_with(sizes);
  for (int closer = 0; closer < criteria.closer_starts && best && best->ratio > criteria.decisive; ++closer) {
    best = best_with(starts.between_best(step, closer));
    step *= criteria.closer_start;
  }
  return best;
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

/// The likelihood is a step function of these sizes: their interval is the hull of the region where it is within the
/// 95 % limit, every basin included.
void Fitter::widen_across_jumps(JointFit& fit) const {
  if (!fit.valid || !any_jumps(fit)) return;
  const JumpingSizes sizes(*this, fit);
  const Index d = sizes.count();
  const Vector scale = sizes.scale();
  const Vector furthest = sizes.explored().within(sizes.limit(), 1).cwiseAbs().rowwise().maxCoeff(),
               line = sizes.by_line(criteria.jump_reach_again * scale.asDiagonal() * around(d, 0));
  for (Index i = 0; i < d; ++i) {
    const Index own = sizes.own()[index(i)];
    const double hull = std::max(furthest[i], criteria.finest_jump_reach * scale[i]) / std::sqrt(criteria.decisive);
    // A pattern of jumps pins a size only as far as all else in the model is exact: the line does not rely on that.
    const double u = std::isfinite(line[i]) ? std::max(hull, line[i]) : hull,
                 times = u / std::sqrt(fit.covariance(own, own));
    fit.covariance.row(own) *= times;
    fit.covariance.col(own) *= times;
  }
}

Matrix Fitter::across_jumps(const JointFit& fit, Index draws) const {
  if (!fit.valid || !any_jumps(fit)) return Matrix::Zero(fit.residual.size(), draws);
  const JumpingSizes sizes(*this, fit);
  const Tried tried = sizes.explored();
  const std::vector<Index> drawn = tried.drawn(draws);
  std::vector<Index> different, place;
  for (const Index k : drawn) {
    if (different.empty() || different.back() != k) different.push_back(k);
    place.push_back(index(different.size()) - 1);
  }
  return sizes.predicted(tried.at(different))(Eigen::all, place);
}

} // namespace gumshoe::tracing
