#include "analysis/conditional_draws.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "base/hash.h"
#include "quantities/quantile_kernels.h"

namespace gumshoe::analysis {

using quantities::Distribution;
using quantities::Family;

namespace {

/// The plan with other streams, tied variates as normal scores.
quantities::SamplePlan plan_of_scores(quantities::SamplePlan plan, std::string_view name) {
  const Distribution score{Family::normal, {0, 1}, {}, {}};
  for (const auto& group : plan.copulas)
    for (const std::size_t v : group.variates) plan.variates[v].distribution = score;
  for (auto& v : plan.variates) v.key = hash64(name, v.key);
  return plan;
}

} // namespace

struct ConditionalDraws::Impl {
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

  void deviations(std::size_t v, const double* scores, double* out, std::size_t n) const {
    const Distribution& d = plan.variates[v].distribution;
    if (d.family == Family::normal) {
      for (std::size_t i = 0; i < n; ++i) out[i] = d.parameters[0] + d.parameters[1] * scores[i];
    } else {
      quantities::kernels().normal_probability(scores, out, n);
      quantile[v](out, out, n);
    }
  }

  void mix_group(const quantities::CopulaGroup& group, Block& block, const std::vector<bool>& frozen, std::size_t from,
                 std::size_t count) const {
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

    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto size = static_cast<Eigen::Index>(group.variates.size());
    const Eigen::Map<const Matrix> r(group.matrix.data(), size, size);
    const Matrix weights = Matrix(r(fixed, fixed)).llt().solve(Matrix(r(fixed, open))).transpose();
    for (std::size_t u = 0; u < open.size(); ++u) {
      double* out = row(block.mixed, open[u]);
      std::copy_n(row(block.scores_b, open[u]), count, out);
      for (std::size_t f = 0; f < fixed.size(); ++f) {
        const double weight = weights(static_cast<Eigen::Index>(u), static_cast<Eigen::Index>(f));
        const double *za = row(block.scores_a, fixed[f]), *zb = row(block.scores_b, fixed[f]);
        for (std::size_t i = 0; i < count; ++i) out[i] += weight * (za[i] - zb[i]);
      }
      deviations(group.variates[static_cast<std::size_t>(open[u])], out, out, count);
    }
  }
};

ConditionalDraws::ConditionalDraws(const quantities::SamplePlan& plan) : impl_(std::make_unique<const Impl>(plan)) {}

ConditionalDraws::~ConditionalDraws() = default;

ConditionalDraws::Block ConditionalDraws::draw(std::uint64_t first, std::size_t rows) const {
  const std::size_t d = impl_->plan.variates.size();
  Block block;
  block.rows = rows;
  block.scores_a.resize(d * rows);
  block.scores_b.resize(d * rows);
  impl_->a.draw(first, rows, quantities::Purpose::pick_freeze, block.scores_a.data(), rows);
  impl_->b.draw(first, rows, quantities::Purpose::pick_freeze, block.scores_b.data(), rows);
  block.a = block.scores_a;
  block.b = block.scores_b;
  for (std::size_t v = 0; v < d; ++v) {
    if (!impl_->tied[v]) continue;
    impl_->deviations(v, &block.scores_a[v * rows], &block.a[v * rows], rows);
    impl_->deviations(v, &block.scores_b[v * rows], &block.b[v * rows], rows);
  }
  block.mixed = block.a;
  return block;
}

void ConditionalDraws::mix(Block& block, const std::vector<bool>& frozen, std::size_t from, std::size_t count) const {
  for (std::size_t v = 0; v < frozen.size(); ++v)
    if (!impl_->tied[v])
      std::copy_n(&(frozen[v] ? block.a : block.b)[v * block.rows + from], count, &block.mixed[v * block.rows + from]);
  for (const auto& group : impl_->plan.copulas) impl_->mix_group(group, block, frozen, from, count);
}

} // namespace gumshoe::analysis
