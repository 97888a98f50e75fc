#include "analysis/joint.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "analysis/combine.h"
#include "analysis/complete.h"
#include "analysis/leaves.h"
#include "analysis/ranked.h"
#include "analysis/reach.h"
#include "analysis/summary.h"
#include "base/special_values.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct CoverageFactor {
  double k, se;
};

/// The p-quantile of n distances, whose squares `fill` computes, ranked as in JCGM 101 7.7.2, and half the distance
/// between the ranks one binomial standard deviation to either side.
CoverageFactor factor(std::size_t n, const Fill& fill, double p, int threads) {
  const double m = static_cast<double>(n), step = std::max(1.0, std::sqrt(m * p * (1 - p)));
  const double rank = static_cast<double>(std::max<std::size_t>(1, covered_ranks(n, p)) - 1);
  std::size_t ranks[3];
  for (int i = 0; i < 3; ++i) ranks[i] = static_cast<std::size_t>(std::clamp(rank + (i - 1) * step, 0.0, m - 1));
  const auto square = ranked(n, fill, ranks, threads);
  return {std::sqrt(square[1]), 0.5 * (std::sqrt(square[2]) - std::sqrt(square[0]))};
}

using Values = std::vector<Column>; ///< of each measurand

/// The samples of which every measurand has a value, if some have none: then `mean` is NaN.
class Valid {
public:
  Valid(const Values& all, int threads) : values_(all) {
    find_means(threads);
    if (std::ranges::none_of(means_, [](double m) { return std::isnan(m); })) return;
    complete_.emplace(
        all, [](double v) { return !std::isnan(v); }, threads);
    for (std::size_t a = 0; a < all.size(); ++a) values_[a] = complete_->column(a);
    find_means(threads);
  }
  Valid(const Valid&) = delete; // values_ refers to complete_
  Valid& operator=(const Valid&) = delete;
  const Values& values() const { return values_; }
  const std::vector<double>& means() const { return means_; }

private:
  void find_means(int threads) {
    means_.clear();
    for (const Column& y : values_) {
      const double origin = y.size() > 0 ? y[0] : nan;
      const auto leaf = [&](std::span<const double> some) {
        double sum = 0;
        for (const double v : some) sum += v - origin;
        return sum;
      };
      means_.push_back(y.size() == 0 ? nan
                                     : origin + leaf_sum<double>(y, threads, leaf) / static_cast<double>(y.size()));
    }
  }
  Values values_;
  std::optional<Complete> complete_;
  std::vector<double> means_;
};

/// Deviations from the means, scaled by u; a measurand that does not vary beyond its rounding is zero. Computed when
/// they are wanted: one value takes as long to read as to compute.
struct Scaled {
  const Values& values;
  const std::vector<double>& mean;
  std::vector<double> u, rounding; ///< rounding: of a value, over u

  Scaled(const Valid& valid, int threads) : values(valid.values()), mean(valid.means()) {
    for (std::size_t a = 0; a < values.size(); ++a) {
      const auto leaf = [&](std::span<const double> some) {
        double sum = 0;
        for (const double v : some) sum += (v - mean[a]) * (v - mean[a]);
        return sum;
      };
      const double square = leaf_sum<double>(values[a], threads, leaf);
      double standard = std::sqrt(square / (static_cast<double>(size()) - 1));
      const double value_rounding = 4 * std::numeric_limits<double>::epsilon() * std::fabs(mean[a]);
      if (standard <= value_rounding) standard = 0;
      u.push_back(standard);
      rounding.push_back(standard > 0 ? value_rounding / standard : 0);
    }
  }
  std::size_t size() const { return values[0].size(); }

  /// Calls body(a, values) for samples [first, first + count) of every measurand in turn.
  template <class Body> void each(std::size_t first, std::size_t count, const Body& body) const {
    Room room;
    std::vector<double> z(count);
    for (std::size_t a = 0; a < values.size(); ++a) {
      if (u[a] > 0) {
        const auto y = values[a].read(first, count, room);
        for (std::size_t i = 0; i < count; ++i) z[i] = (y[i] - mean[a]) / u[a];
      } else {
        std::ranges::fill(z, 0.0);
      }
      body(a, std::span<const double>(z));
    }
  }

  /// Products of the measurands, one below the diagonal after the other, summed over samples.
  struct Products : std::vector<double> {
    void operator+=(const Products& other) {
      for (std::size_t i = 0; i < size(); ++i) (*this)[i] += other[i];
    }
  };

  /// Correlations of measurands b < a, in the order (1, 0), (2, 0), (2, 1), ...
  std::vector<double> correlations(int threads) const {
    const std::size_t d = values.size();
    Products sums = leaf_sum<Products>(size(), threads, [&](std::size_t first, std::size_t count) {
      Products some;
      std::vector<double> all(d * count);
      each(first, count, [&](std::size_t a, std::span<const double> x) {
        std::ranges::copy(x, &all[a * count]);
        for (std::size_t b = 0; b < a; ++b) {
          double products = 0;
          for (std::size_t k = 0; k < count; ++k) products += all[b * count + k] * x[k];
          some.push_back(products);
        }
      });
      return some;
    });
    for (double& sum : sums) sum /= static_cast<double>(size()) - 1;
    return sums;
  }

  /// The square of the largest deviation, either way.
  void largest(std::size_t first, std::span<double> out) const {
    std::ranges::fill(out, 0.0);
    each(first, out.size(), [&](std::size_t, std::span<const double> z) {
      for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], z[k] * z[k]);
    });
  }

  /// The square of the Mahalanobis distance: of L^-1 z, row by row of the correlation matrix' Cholesky factor L.
  void mahalanobis(const Matrix& lower, std::size_t first, std::span<double> out) const {
    const std::size_t n = out.size();
    std::vector<double> all(values.size() * n);
    std::ranges::fill(out, 0.0);
    each(first, n, [&](std::size_t a, std::span<const double> z) {
      const auto row = std::span(all).subspan(a * n, n);
      std::ranges::copy(z, row.begin());
      const auto i = static_cast<Eigen::Index>(a);
      for (std::size_t b = 0; b < a; ++b) {
        const double factor = lower(i, static_cast<Eigen::Index>(b)), *other = &all[b * n];
        for (std::size_t k = 0; k < n; ++k) row[k] -= other[k] * factor;
      }
      for (std::size_t k = 0; k < n; ++k) row[k] /= lower(i, i);
      for (std::size_t k = 0; k < n; ++k) out[k] += row[k] * row[k];
    });
  }
};

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
  std::map<std::size_t, Eigen::VectorXd> of; // by variate
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::VectorXd y(d);
    for (Eigen::Index a = 0; a < d; ++a) y[a] = signed_contribution(a, i);
    of.emplace(rows[i].variate, std::move(y));
  }
  Matrix v = Matrix::Zero(d, d);
  for (const auto& [variate, y] : of) v += y * y.transpose();
  quantities::Correlations correlations(e.plan());
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

JointRegion joint_region(const Values& all, double p, int threads) {
  JointRegion region;
  region.coverage_probability = p;
  const std::size_t d = all.size();
  const Valid valid(all, threads);
  const std::size_t n = valid.values()[0].size();
  region.k_p = region.k_p_se = region.k_q = region.k_q_se = nan;
  if (n < 2 * d + 2) {
    region.estimate.assign(d, nan);
    region.covariance.assign(d * d, nan);
    region.correlation = region.covariance;
    region.remark = "too few valid samples";
    return region;
  }
  const Scaled s(valid, threads);
  region.estimate = s.mean;
  const auto size = static_cast<Eigen::Index>(d);
  Matrix r(size, size), covariance(size, size);
  const std::vector<double> correlations = s.correlations(threads);
  for (std::size_t a = 0, k = 0; a < d; ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    r(i, i) = 1;
    for (Eigen::Index j = 0; j < i; ++j) r(i, j) = r(j, i) = correlations[k++];
  }
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t b = 0; b < d; ++b) {
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      covariance(i, j) = r(i, j) * s.u[a] * s.u[b];
    }

  const auto largest = [&](std::size_t first, std::span<double> out) { s.largest(first, out); };
  const auto [k_q, k_q_se] = factor(n, largest, p, threads);
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
    const Matrix lower = Eigen::MatrixXd(r).llt().matrixL();
    const auto mahalanobis = [&](std::size_t first, std::span<double> out) { s.mahalanobis(lower, first, out); };
    const auto [k_p, k_p_se] = factor(n, mahalanobis, p, threads);
    region.k_p = k_p;
    region.k_p_se = k_p_se;
  }
  return region;
}

std::vector<JointRegion> joint_regions(const propagation::Experiment& e, const Samples& samples,
                                       const std::vector<Summary>& summaries, const std::vector<Budget>& budgets,
                                       int threads) {
  const auto wanted = groups(e);
  std::vector<JointRegion> regions(wanted.size());
  std::size_t most = 1;
  for (const Group& group : wanted) most = std::max(most, group.outputs.size());
  side_by_side(wanted.size(), most * samples.size, threads, [&](std::size_t g) {
    const Group& group = wanted[g];
    std::vector<Room> rooms(group.outputs.size());
    Values values;
    std::vector<const Budget*> laws;
    for (const std::size_t o : group.outputs) {
      values.push_back(held(samples.values(o), rooms[values.size()], group.outputs.size()));
      laws.push_back(&budgets[o]);
    }
    JointRegion& region = regions[g] = joint_region(values, e.scenario().analysis.coverage_probability, threads);
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
