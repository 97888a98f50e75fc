#include "analysis/joint.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "analysis/combine.h"
#include "analysis/ordered_sum.h"
#include "analysis/reach.h"
#include "analysis/summary.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Factor {
  double k, se;
};

/// The p-quantile of distances, ranked as in JCGM 101 7.7.2, and half the distance between the ranks one binomial
/// standard deviation to either side.
Factor factor(std::vector<double> distance, double p) {
  const std::size_t m = distance.size(), q = std::max<std::size_t>(1, covered_ranks(m, p));
  const double step = std::max(1.0, std::sqrt(static_cast<double>(m) * p * (1 - p)));
  const auto at = [&](double rank) {
    const auto r = static_cast<long>(std::clamp(rank, 0.0, static_cast<double>(m - 1)));
    std::nth_element(distance.begin(), distance.begin() + r, distance.end());
    return distance[static_cast<std::size_t>(r)];
  };
  const double rank = static_cast<double>(q - 1);
  return {at(rank), 0.5 * (at(rank + step) - at(rank - step))};
}

/// Deviations from the means, scaled by u; a measurand that does not vary beyond its rounding is zero.
struct Scaled {
  std::vector<std::vector<double>> z;
  std::vector<double> mean, u, rounding; ///< rounding: of a value, over u
};

Scaled scale(const std::vector<std::vector<double>>& values) {
  Scaled s;
  for (const auto& y : values) {
    const double n = static_cast<double>(y.size());
    const double mean = y[0] + ordered_sum(y.size(), [&](std::size_t i) { return y[i] - y[0]; }) / n;
    const double square = ordered_sum(y.size(), [&](std::size_t i) { return (y[i] - mean) * (y[i] - mean); });
    double u = std::sqrt(square / (n - 1));
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::fabs(mean);
    if (u <= rounding) u = 0;
    std::vector<double> z(y.size(), 0.0);
    if (u > 0)
      for (std::size_t i = 0; i < y.size(); ++i) z[i] = (y[i] - mean) / u;
    s.z.push_back(std::move(z));
    s.mean.push_back(mean);
    s.u.push_back(u);
    s.rounding.push_back(u > 0 ? rounding / u : 0);
  }
  return s;
}

std::vector<double> row_major(const Matrix& m) { return {m.data(), m.data() + m.size()}; }

/// C V C' (6.2.1.3): the budgets of one reading have the same rows.
std::vector<double> law_of_propagation(const std::vector<const Budget*>& budgets, const propagation::Experiment& e,
                                       std::size_t reading) {
  const auto d = static_cast<Eigen::Index>(budgets.size());
  const auto rows = variates_reaching(e, reading);
  for (const Budget* b : budgets)
    if (!b->applicable || b->contributions.size() != rows.size()) return {};
  const auto signed_contribution = [&](Eigen::Index a, std::size_t i) {
    const Contribution& c = budgets[static_cast<std::size_t>(a)]->contributions[i];
    return c.standard_uncertainty > 0 && c.differentiable ? c.sensitivity * c.standard_uncertainty : 0;
  };
  std::map<std::size_t, Eigen::VectorXd> of; // by variate: one may be part of several columns
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::VectorXd y(d);
    for (Eigen::Index a = 0; a < d; ++a) y[a] = signed_contribution(a, i);
    const auto [at, added] = of.try_emplace(rows[i].variate, y);
    if (!added) at->second += y;
  }
  Matrix v = Matrix::Zero(d, d);
  for (const auto& [variate, y] : of) v += y * y.transpose();
  Correlations correlations(e.plan());
  for (const auto& group : e.plan().copulas)
    for (const std::size_t i : group.variates)
      for (const std::size_t k : group.variates)
        if (i != k && of.contains(i) && of.contains(k))
          v += correlations.between(i, k) * of.at(i) * of.at(k).transpose();
  return row_major(v);
}

struct Group {
  std::size_t reading;
  std::vector<std::size_t> outputs;
};

std::vector<Group> groups(const propagation::Experiment& e) {
  std::vector<Group> found;
  const auto measurands = e.measurands();
  const std::size_t readings = e.outputs().size() / measurands.size();
  const auto index = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::ranges::find_if(measurands, [&](const VariableCard& m) { return m.name == name; }) - measurands.begin());
  };
  for (std::size_t r = 0; r < readings; ++r) {
    const std::size_t first = r * measurands.size();
    for (const auto& names : e.scenario().analysis.joint) {
      found.push_back({r, {}});
      for (const auto& name : names) found.back().outputs.push_back(first + index(name));
    }
    if (!e.scenario().analysis.joint.empty()) continue;
    Group all{r, {}};
    for (std::size_t m = 0; m < measurands.size(); ++m)
      if (!measurands[m].diagnostic) all.outputs.push_back(first + m);
    if (all.outputs.size() >= 2 && all.outputs.size() <= 8) found.push_back(std::move(all));
  }
  return found;
}

} // namespace

JointRegion joint_region(const std::vector<std::vector<double>>& all, double p) {
  JointRegion region;
  region.coverage_probability = p;
  const std::size_t d = all.size();
  std::vector<std::vector<double>> values(d);
  for (std::size_t i = 0; i < all[0].size(); ++i)
    if (std::ranges::none_of(all, [&](const auto& y) { return std::isnan(y[i]); }))
      for (std::size_t a = 0; a < d; ++a) values[a].push_back(all[a][i]);
  const std::size_t n = values[0].size();
  region.k_p = region.k_p_se = region.k_q = region.k_q_se = nan;
  if (n < 2 * d + 2) {
    region.estimate.assign(d, nan);
    region.covariance.assign(d * d, nan);
    region.correlation = region.covariance;
    region.remark = "too few valid samples";
    return region;
  }
  const Scaled s = scale(values);
  region.estimate = s.mean;
  const auto size = static_cast<Eigen::Index>(d);
  Matrix r(size, size), covariance(size, size);
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t b = 0; b < d; ++b) {
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      const auto& x = s.z[a];
      const auto& y = s.z[b];
      r(i, j) = a == b  ? 1
                : a > b ? r(j, i)
                        : ordered_sum(n, [&](std::size_t k) { return x[k] * y[k]; }) / (static_cast<double>(n) - 1);
      covariance(i, j) = r(i, j) * s.u[a] * s.u[b];
    }

  std::vector<double> distance(n, 0.0);
  for (const auto& z : s.z)
    for (std::size_t k = 0; k < n; ++k) distance[k] = std::max(distance[k], std::fabs(z[k]));
  const auto [k_q, k_q_se] = factor(distance, p);
  region.k_q = k_q;
  region.k_q_se = k_q_se;

  std::string constant;
  for (std::size_t a = 0; a < d; ++a)
    if (s.u[a] == 0) {
      constant += (constant.empty() ? "" : ", ") + std::to_string(a + 1);
      for (Eigen::Index j = 0; j < size; ++j)
        r(static_cast<Eigen::Index>(a), j) = r(j, static_cast<Eigen::Index>(a)) = nan;
    }
  // A dependent measurand shows as an eigenvalue at the level of the samples' rounding, squared.
  double noise = 1e-12;
  for (const double x : s.rounding) noise += x * x;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  if (constant.empty()) eigen.compute(Eigen::MatrixXd(r));
  region.covariance = row_major(covariance);
  region.correlation = row_major(r);
  if (!constant.empty()) {
    region.remark = "no ellipsoid: measurand " + constant + " of the group does not vary";
  } else if (!(eigen.eigenvalues()[0] > noise)) {
    region.remark = fmt::format("no ellipsoid: the measurands are linearly dependent, the smallest eigenvalue of their "
                                "correlation matrix is {:.1g}",
                                std::max(0.0, eigen.eigenvalues()[0]));
  } else {
    const Eigen::MatrixXd lower = Eigen::MatrixXd(r).llt().matrixL();
    Eigen::VectorXd z(size);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t a = 0; a < d; ++a) z[static_cast<Eigen::Index>(a)] = s.z[a][k];
      lower.triangularView<Eigen::Lower>().solveInPlace(z);
      distance[k] = z.norm();
    }
    const auto [k_p, k_p_se] = factor(std::move(distance), p);
    region.k_p = k_p;
    region.k_p_se = k_p_se;
  }
  return region;
}

std::vector<JointRegion> joint_regions(const propagation::Experiment& e, const ValuesOf& values,
                                       const std::vector<Summary>& summaries, const std::vector<Budget>& budgets,
                                       int threads) {
  const auto wanted = groups(e);
  std::vector<JointRegion> regions(wanted.size());
  propagation::parallel_for(wanted.size(), threads, [&](std::size_t g) {
    const Group& group = wanted[g];
    std::vector<std::vector<double>> samples;
    std::vector<const Budget*> laws;
    for (const std::size_t o : group.outputs) {
      samples.push_back(values(o));
      laws.push_back(&budgets[o]);
    }
    JointRegion& region = regions[g] = joint_region(samples, e.scenario().analysis.coverage_probability);
    for (const std::size_t o : group.outputs) {
      region.outputs.push_back(e.outputs()[o]);
      const Summary& s = summaries[o];
      if (region.remark.starts_with("no region")) continue;
      if (std::isnan(s.standard_uncertainty) || std::isnan(s.symmetric.low)) {
        region.remark = fmt::format("no region: {} has no {}", e.outputs()[o].name,
                                    std::isnan(s.standard_uncertainty) ? "standard uncertainty" : "coverage interval");
        region.k_p = region.k_p_se = region.k_q = region.k_q_se = nan;
        std::ranges::fill(region.covariance, nan);
        std::ranges::fill(region.correlation, nan);
      }
    }
    if (e.scenario().run.design != scenario::Design::monte_carlo) region.k_p_se = region.k_q_se = nan;
    region.gum_covariance = law_of_propagation(laws, e, group.reading);
  });
  return regions;
}

} // namespace gumshoe::analysis
