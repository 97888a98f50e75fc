/// What the readings say of declared draws.
#include <algorithm>

#include <Eigen/Eigenvalues>

#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

DrawsGivenReadings Fitter::draws_given_readings(const JointFit& fit) const {
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
  return out;
}

} // namespace gumshoe::tracing
