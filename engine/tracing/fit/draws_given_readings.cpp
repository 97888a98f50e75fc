/// What the readings say of declared draws.
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

DrawsGivenReadings Fitter::draws_given_readings(JointFit& fit) const {
  const auto tied = [&](std::size_t v) {
    return std::ranges::any_of(experiment_.plan().copulas, [&](const auto& group) {
      return std::ranges::find(group.variates, v) != group.variates.end();
    });
  };
  const std::vector<Index> use = independent(fit.design, rows_);
  const Index p = index(use.size()), all = fit.design.fixed.cols();
  DrawsGivenReadings out;
  std::vector<Index> solved, place; // by column: in the solution, and in the result
  for (Index i = 0; i < p; ++i) solved.push_back(i), place.push_back(use[index(i)]);
  for (std::size_t j = 0; j < fit.draw_of.size(); ++j) {
    const std::size_t v = fit.draw_of[j];
    if (!draws_[v].fitted || tied(v)) continue;
    solved.push_back(p + index(j));
    place.push_back(all + index(out.draws.size()));
    out.draws.push_back(v);
  }
  if (out.draws.empty()) return out;
  const Whitened plain(fit.design, rows_, use, {}), w(fit.design, rows_, use, fit.covariance_model);
  Matrix covariance;
  const Vector x = w.coefficients(plain.winsorised(plain.take(fit.residual)), &covariance);
  const auto m = index(out.draws.size());
  const Matrix own = covariance(std::vector<Index>(solved.begin() + p, solved.end()),
                                std::vector<Index>(solved.begin() + p, solved.end()));
  out.informed =
      Eigen::SelfAdjointEigenSolver<Matrix>(own, Eigen::EigenvaluesOnly).eigenvalues()[0] < criteria.informed_variance;
  out.mean = x(std::vector<Index>(solved.begin() + p, solved.end()));
  out.covariance = Matrix::Zero(all + m, all + m);
  out.covariance(place, place) = fit.variance * covariance(solved, solved);
  follow_draws(fit, place, out);
  for (Index i = 0; i < all; ++i)
    for (Index j = all; j < all + m; ++j) {
      const double squares = out.covariance(i, i) * out.covariance(j, j);
      if (squares > 0)
        out.largest_correlation =
            std::max(out.largest_correlation, std::fabs(out.covariance(i, j)) / std::sqrt(squares));
    }
  return out;
}

void Fitter::follow_draws(JointFit& fit, const std::vector<Index>& place, DrawsGivenReadings& out) const {
  const Settled settled = settled_columns(fit);
  if (settled.rows.empty()) return;
  Design own = fit.design;
  own.fixed = Matrix(fit.design.fixed(Eigen::all, settled.columns));
  const auto use = independent(own, settled.rows);
  const Whitened w(own, settled.rows, use, fit.covariance_model);
  // Change of the offsets per unit of each known draw: they compensate it.
  Matrix known(fit.design.fixed.rows(), index(place.size()));
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Index draw = place[i] - fit.design.fixed.cols();
    if (draw < 0)
      known.col(index(i)) = fit.design.fixed.col(place[i]);
    else
      known.col(index(i)) =
          fit.design.random.col(std::ranges::find(fit.draw_of, out.draws[index(draw)]) - fit.draw_of.begin());
  }
  Matrix own_covariance;
  w.coefficients(w.take(fit.residual), &own_covariance);
  const auto m = index(use.size());
  const Matrix s = w.coefficients(w.take(known)).topRows(m), s_draws = s.rightCols(index(out.draws.size()));
  const Matrix v = out.covariance(place, place), cross = -s * v;
  // The noise of their own readings, without the draws as declared; then all that is known, as it is known.
  const Matrix total =
      fit.variance * (own_covariance.topLeftCorner(m, m) - s_draws * s_draws.transpose()) + s * v * s.transpose();
  const auto set = [&](Index a, Index b, double x) {
    out.covariance(a, b) = out.covariance(b, a) = x;
    if (std::max(a, b) < fit.covariance.cols()) fit.covariance(a, b) = fit.covariance(b, a) = x;
  };
  for (Index i = 0; i < m; ++i) {
    const Index a = settled.columns[index(use[index(i)])];
    for (Index j = 0; j <= i; ++j) set(a, settled.columns[index(use[index(j)])], total(i, j));
    for (std::size_t j = 0; j < place.size(); ++j) set(a, place[j], cross(i, index(j)));
  }
}

} // namespace gumshoe::tracing
