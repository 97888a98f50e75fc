#include "calibration/priors.h"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "base/error.h"
#include "quantities/correlations.h"

namespace gumshoe::calibration {

Priors priors_of(const propagation::Experiment& e, const std::vector<Unknown>& unknowns) {
  std::vector<std::size_t> known;
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    if (unknowns[j].prior_u > 0) known.push_back(j);
  Priors out;
  if (known.empty()) return out;
  const auto m = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(m, m);
  quantities::Correlations correlations(e.plan());
  const auto draws = [&](Eigen::Index i) {
    return e.plan().columns[unknowns[known[static_cast<std::size_t>(i)]].column].variates;
  };
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j)
      for (const std::size_t a : draws(i))
        for (const std::size_t b : draws(j)) covariance(i, j) += correlations.covariance(a, b);
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  for (Eigen::Index i = 0; i < m; ++i)
    if (!(factor(i, i) * factor(i, i) > 1e-12 * covariance(i, i)))
      throw InputError(fmt::format("{}: its prior is determined by those of other estimated quantities",
                                   unknowns[known[static_cast<std::size_t>(i)]].name),
                       "their correlation is complete", "estimate one of them, or state coefficients nearer to 0");
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(unknowns.size()));
  Eigen::VectorXd means(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    rows(i, static_cast<Eigen::Index>(known[static_cast<std::size_t>(i)])) = 1;
    means[i] = unknowns[known[static_cast<std::size_t>(i)]].start;
  }
  factor.triangularView<Eigen::Lower>().solveInPlace(rows);
  factor.triangularView<Eigen::Lower>().solveInPlace(means);
  out.target.assign(means.data(), means.data() + m);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < rows.cols(); ++j) out.matrix.push_back(rows(i, j));
  return out;
}

} // namespace gumshoe::calibration
