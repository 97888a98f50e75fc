/// How far the readings determine sizes with which they jump.
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include "tracing/fit/jumping_sizes.h"

namespace gumshoe::tracing {
namespace {

/// Changes of the sizes that were tried, with the squares of the residuals that each leaves.
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
  /// Draws some in proportion to their likelihood; by place, ascending.
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

/// 2 ln L of all sizes together, a little more than 95 %.
double limit(Index sizes) { return criteria.decisive * static_cast<double>(sizes); }

/// Tries about the sizes found, each batch spread as those before it that were near enough.
Tried explored(const auto& sizes) {
  const Index d = sizes.count();
  const Vector scale = sizes.scale();
  Tried tried(sizes.freedom(), d, sizes.left(Vector::Zero(d))[0]);
  Matrix covariance = (criteria.jump_reach_again * scale).array().square().matrix().asDiagonal();
  for (int batch = 0; batch < criteria.jump_samples; ++batch) {
    const Matrix at = Matrix(covariance.llt().matrixL()) * around(d, 1000 + batch);
    tried.add(at, sizes.left(at));
    const Matrix near = tried.within(limit(d), criteria.tries_that_tell * index(d));
    covariance = near * near.transpose() / static_cast<double>(near.cols());
    covariance.diagonal() += (criteria.finest_jump_reach * scale).array().square().matrix();
  }
  return tried;
}

} // namespace

/// The likelihood is a step function of these sizes: their interval is the hull of the region where it is within the
/// 95 % limit, every basin included.
void Fitter::widen_across_jumps(JointFit& fit) const {
  if (!fit.valid || !any_jumps(fit)) return;
  const JumpingSizes sizes(*this, fit);
  const Index d = sizes.count();
  const Vector scale = sizes.scale();
  const Vector furthest = explored(sizes).within(limit(d), 1).cwiseAbs().rowwise().maxCoeff(),
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
  const Tried tried = explored(sizes);
  const std::vector<Index> drawn = tried.drawn(draws);
  std::vector<Index> different, place;
  for (const Index k : drawn) {
    if (different.empty() || different.back() != k) different.push_back(k);
    place.push_back(index(different.size()) - 1);
  }
  return sizes.predicted(tried.at(different))(Eigen::all, place);
}

} // namespace gumshoe::tracing
