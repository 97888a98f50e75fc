#include "analysis/conditional_draws.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "base/hash.h"
#include "quantities/quantile_kernels.h"

namespace gumshoe::analysis {

using quantities::Distribution;
using quantities::Family;

namespace {

/// The plan with other streams, tied variates as normal scores; one further variate per group, the W of a multivariate t.
quantities::SamplePlan plan_of_scores(quantities::SamplePlan plan, std::string_view name) {
  const Distribution score{Family::normal, {0, 1}, {}, {}};
  for (auto& group : plan.copulas) {
    for (const std::size_t v : group.variates) plan.variates[v].distribution = score;
    quantities::Variate shared = plan.variates[group.variates[0]];
    if (group.multivariate_t()) shared.distribution = group.shared_scale();
    shared.key = group.key;
    plan.variates.push_back(shared);
    group.degrees_of_freedom = 0;
    group.together.clear();
  }
  for (auto& v : plan.variates) v.key = hash64(name, v.key);
  for (auto& e : plan.estimates) e.key = hash64(name, e.key);
  return plan;
}

} // namespace

struct ConditionalDraws::Impl {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  quantities::SamplePlan plan;
  quantities::Sampler a, b;
  std::vector<quantities::QuantileFunction> quantile; ///< of the variate's own distribution
  std::vector<bool> tied;

  explicit Impl(const quantities::SamplePlan& p)
      : plan(p), a(plan_of_scores(p, "shapley a"), quantities::PointSet::monte_carlo, 0),
        b(plan_of_scores(p, "shapley b"), quantities::PointSet::monte_carlo, 0), tied(p.variates.size(), false) {
    for (const auto& v : p.variates) quantile.emplace_back(v.distribution);
    for (const auto& group : p.copulas)
      for (const std::size_t v : group.variates) tied[v] = true;
  }

  /// The W of group g in a block of scores.
  const double* shared(const std::vector<double>& scores, std::size_t g, std::size_t rows) const {
    return scores.data() + (plan.variates.size() + g) * rows;
  }

  /// Deviations of variate v of group g from normal scores and W.
  void deviations(std::size_t g, std::size_t v, const double* scores, const double* w, double* out, std::size_t n) const {
    const Distribution& d = plan.variates[v].distribution;
    if (plan.copulas[g].multivariate_t()) {
      for (std::size_t i = 0; i < n; ++i) out[i] = d.parameters[0] + d.parameters[1] * (scores[i] / std::sqrt(w[i]));
    } else if (d.family == Family::normal) {
      for (std::size_t i = 0; i < n; ++i) out[i] = d.parameters[0] + d.parameters[1] * scores[i];
    } else {
      quantities::kernels().normal_probability(scores, out, n);
      quantile[v](out, out, n);
    }
  }

  /// Given x_F = z_F / sqrt(W), nu W + x_F' R_FF^-1 x_F W is chi-squared with nu + |F| degrees of freedom: the same draw of
  /// B, nu W_B + z_BF' R_FF^-1 z_BF, divided by nu + x_F' R_FF^-1 x_F, is W given x_F.
  std::vector<double> conditional_scale(std::size_t g, const Block& block, const std::vector<Eigen::Index>& fixed,
                                        const Matrix& inverse, std::size_t from, std::size_t count) const {
    const double nu = plan.copulas[g].degrees_of_freedom;
    const double *wa = shared(block.scores_a, g, block.rows) + from, *wb = shared(block.scores_b, g, block.rows) + from;
    std::vector<double> w(count);
    for (std::size_t i = 0; i < count; ++i) {
      double of_a = 0, of_b = 0;
      for (Eigen::Index j = 0; j < inverse.rows(); ++j)
        for (Eigen::Index k = 0; k < inverse.cols(); ++k) {
          const auto at = [&](const std::vector<double>& z, Eigen::Index m) {
            return z[plan.copulas[g].variates[static_cast<std::size_t>(fixed[static_cast<std::size_t>(m)])] * block.rows +
                     from + i];
          };
          of_a += inverse(j, k) * at(block.scores_a, j) * at(block.scores_a, k);
          of_b += inverse(j, k) * at(block.scores_b, j) * at(block.scores_b, k);
        }
      w[i] = (nu * wb[i] + of_b) / (nu + of_a / wa[i]);
    }
    return w;
  }

  void mix_group(std::size_t g, Block& block, const std::vector<bool>& frozen, std::size_t from,
                 std::size_t count) const {
    const auto& group = plan.copulas[g];
    std::vector<Eigen::Index> fixed, open;
    for (std::size_t i = 0; i < group.variates.size(); ++i)
      (frozen[group.variates[i]] ? fixed : open).push_back(static_cast<Eigen::Index>(i));
    const auto row = [&](std::vector<double>& x, Eigen::Index i) {
      return x.data() + group.variates[static_cast<std::size_t>(i)] * block.rows + from;
    };
    for (const Eigen::Index i : fixed) std::copy_n(row(block.a, i), count, row(block.mixed, i));
    if (fixed.empty())
      for (const Eigen::Index i : open) std::copy_n(row(block.b, i), count, row(block.mixed, i));
    if (fixed.empty() || open.empty()) return;

    const auto size = static_cast<Eigen::Index>(group.variates.size());
    const Eigen::Map<const Matrix> r(group.matrix.data(), size, size);
    const Matrix among = r(fixed, fixed);
    // Where frozen scores determine one another, the pseudo-inverse gives the same mean and their rank.
    const Matrix inverse = group.singular()
                               ? Matrix(Eigen::CompleteOrthogonalDecomposition<Matrix>(among).pseudoInverse())
                               : Matrix(among.llt().solve(Matrix::Identity(among.rows(), among.cols())));
    const Matrix weights = r(open, fixed) * inverse;
    const double* wa = shared(block.scores_a, g, block.rows) + from;
    std::vector<double> w(count, 1), pull(count, 1); // W given what is frozen; the frozen z_A as scores of that W
    if (group.multivariate_t()) {
      w = conditional_scale(g, block, fixed, inverse, from, count);
      for (std::size_t i = 0; i < count; ++i) pull[i] = std::sqrt(w[i] / wa[i]);
    }
    for (std::size_t u = 0; u < open.size(); ++u) {
      double* out = row(block.mixed, open[u]);
      std::copy_n(row(block.scores_b, open[u]), count, out);
      for (std::size_t f = 0; f < fixed.size(); ++f) {
        const double weight = weights(static_cast<Eigen::Index>(u), static_cast<Eigen::Index>(f));
        const double *za = row(block.scores_a, fixed[f]), *zb = row(block.scores_b, fixed[f]);
        for (std::size_t i = 0; i < count; ++i) out[i] += weight * (za[i] * pull[i] - zb[i]);
      }
      deviations(g, group.variates[static_cast<std::size_t>(open[u])], out, w.data(), out, count);
    }
  }
};

ConditionalDraws::ConditionalDraws(const quantities::SamplePlan& plan) : impl_(std::make_unique<const Impl>(plan)) {}

ConditionalDraws::~ConditionalDraws() = default;

ConditionalDraws::Block ConditionalDraws::draw(std::uint64_t first, std::size_t rows) const {
  const std::size_t d = impl_->plan.variates.size();
  Block block;
  block.rows = rows;
  const std::size_t drawn = d + impl_->plan.copulas.size();
  block.scores_a.resize(drawn * rows);
  block.scores_b.resize(drawn * rows);
  impl_->a.draw(first, rows, quantities::Purpose::pick_freeze, block.scores_a.data(), rows);
  impl_->b.draw(first, rows, quantities::Purpose::pick_freeze, block.scores_b.data(), rows);
  block.a.assign(block.scores_a.begin(), block.scores_a.begin() + static_cast<long>(d * rows));
  block.b.assign(block.scores_b.begin(), block.scores_b.begin() + static_cast<long>(d * rows));
  for (std::size_t g = 0; g < impl_->plan.copulas.size(); ++g)
    for (const std::size_t v : impl_->plan.copulas[g].variates)
      for (const auto& [scores, out] : {std::pair{&block.scores_a, &block.a}, std::pair{&block.scores_b, &block.b}})
        impl_->deviations(g, v, &(*scores)[v * rows], impl_->shared(*scores, g, rows), &(*out)[v * rows], rows);
  block.mixed = block.a;
  return block;
}

void ConditionalDraws::mix(Block& block, const std::vector<bool>& frozen, std::size_t from, std::size_t count) const {
  for (std::size_t v = 0; v < frozen.size(); ++v)
    if (!impl_->tied[v])
      std::copy_n(&(frozen[v] ? block.a : block.b)[v * block.rows + from], count, &block.mixed[v * block.rows + from]);
  for (std::size_t g = 0; g < impl_->plan.copulas.size(); ++g) impl_->mix_group(g, block, frozen, from, count);
}

} // namespace gumshoe::analysis
