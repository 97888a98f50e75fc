#include "tracing/findings/errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "tracing/criteria.h"
#include "tracing/judgement/holdout.h"

namespace gumshoe::tracing {

Blocks predicted_blocks(const Observations& o) {
  const bool any = std::ranges::find(o.held_out, true) != o.held_out.end();
  Blocks out;
  for (std::size_t g = 0; g < o.blocks.groups.size() && (any || o.blocks.groups.size() > 1); ++g) {
    std::vector<bool> chosen;
    for (std::size_t r = 0; r < o.readings; ++r) chosen.push_back(o.blocks.group[r] == g && (!any || o.held_out[r]));
    if (std::ranges::find(chosen, true) == chosen.end()) continue;
    out.rows.push_back(rows_where(o, chosen));
    out.names.push_back(o.blocks.groups[g]);
  }
  return out;
}

Vector in_first(const Observations& o, const Design& design) {
  Vector out = Vector::Ones(index(o.indications));
  for (Index k = 0; k < out.size() && !o.one_kind; ++k) out[k] = design.reference[0] / design.reference[index(k)];
  return out;
}

namespace {

/// Sum of squares of each set (column), in the unit of the first indication. @param rows  of the residuals
Vector squares_of(const Matrix& residual, const std::vector<Index>& rows, const Vector& in_first) {
  Vector out = Vector::Zero(residual.cols());
  for (Index i = 0; i < residual.rows(); ++i)
    out += (in_first[rows[index(i)] % in_first.size()] * residual.row(i)).cwiseAbs2().transpose();
  return out;
}

} // namespace

bool Scores::scored() const { return !rms.empty() && std::isfinite(rms[0]); }

double Scores::counts(Index row) const { return std::fabs(residual[row]) * in_first[row % in_first.size()]; }

Index Scores::worst_row() const {
  Index worst = -1;
  for (Index i = 0; i < residual.size(); ++i)
    if (std::isfinite(residual[i]) && (worst < 0 || counts(i) > counts(worst))) worst = i;
  return worst;
}

double Scores::worst_point() const { return worst_row() < 0 ? none : counts(worst_row()); }

Scores score(const JointFit& fit, const Matrix& residual, const std::vector<Index>& training, const Blocks& blocks,
             const CovarianceModel& units, const Vector& in_first) {
  Scores out;
  out.in_first = in_first;
  Vector squares = Vector::Zero(residual.cols());
  double count = 0;
  out.residual = out.declared = out.weighted = Vector::Constant(residual.rows(), Scores::none);
  for (std::size_t b = 0; b < blocks.rows.size(); ++b) {
    std::vector<Index> train;
    std::set_difference(training.begin(), training.end(), blocks.rows[b].begin(), blocks.rows[b].end(),
                        std::back_inserter(train));
    const HeldOut held = hold_out(fit.design, winsorised_in(fit.design, train, residual), train, blocks.rows[b],
                                  fit.covariance_model, units);
    if (held.count <= 0) continue;
    const Vector of_block = squares_of(held.residual, held.rows, in_first);
    squares += of_block;
    out.whitened += held.whitened[0];
    count += held.count;
    const double rms = std::sqrt(of_block[0] / held.count);
    if (!(rms <= out.worst_block)) out.worst_block = rms, out.worst_name = blocks.names[b];
    out.residual(held.rows) = held.residual.col(0);
    out.declared(held.rows) = held.declared;
    out.weighted(held.rows) = held.weighted;
  }
  for (Index j = 0; j < residual.cols(); ++j)
    out.rms.push_back(count > 0 ? std::sqrt(squares[j] / count) : Scores::none);
  return out;
}

Vector excess(const Scores& before, const Scores& after, const Design& design) {
  const auto noise = [&](Index row) { return noise_of_row(design, row); };
  std::vector<double> sizes;
  for (Index i = 0; i < after.residual.size(); ++i)
    if (std::isfinite(after.residual[i])) sizes.push_back(std::fabs(after.residual[i]) / noise(i));
  Vector out = Vector::Zero(after.residual.size());
  std::vector<Index> rows(index(after.residual.size()));
  std::iota(rows.begin(), rows.end(), Index{0});
  const double bound =
      sizes.empty() ? 0 : criteria.winsor_limit * std::max(robust_scale(sizes), least_scale(design, rows));
  if (!(bound > 0)) return out; // nearly all equal
  for (Index i = 0; i < out.size(); ++i) {
    const double a = before.residual[i], b = after.residual[i];
    if (!std::isfinite(a) || !std::isfinite(b) || a * b < 0) continue;
    out[i] = std::copysign(std::max(0.0, std::min(std::fabs(a), std::fabs(b)) - bound * noise(i)), b);
  }
  return out;
}

namespace {

/// Standard normal number as probable as a sum over the root of the sum of its n squares, which is sqrt(n) at most: by
/// Student's t of these numbers.
double as_normal(double ratio, double n) {
  const double rest = n - ratio * ratio, freedom = n - 1;
  if (!(ratio > 0) || !(freedom > 0)) return ratio;
  const boost::math::students_t t(freedom);
  const double beyond = rest > 0 ? boost::math::cdf(complement(t, ratio * std::sqrt(freedom / rest))) : 0;
  return boost::math::quantile(complement(boost::math::normal(), std::max(beyond, 1e-300)));
}

} // namespace

Overstated overstated(const Scores& before, const Scores& after, const Design& design) {
  const auto of = [&](const auto& gained_and_left) {
    double sum = 0, squares = 0, count = 0;
    for (Index i = 0; i < after.residual.size(); ++i) {
      const auto [gained, r] = gained_and_left(i);
      if (!std::isfinite(r) || !std::isfinite(gained)) continue;
      sum += gained * r;
      squares += gained * gained * r * r;
      count += gained != 0;
    }
    return squares > 0 ? as_normal(-sum / std::sqrt(squares), count) : 0;
  };
  return {of([&](Index i) {
            const double noise = noise_of_row(design, i);
            return std::pair{(before.residual[i] - after.residual[i]) / noise, after.residual[i] / noise};
          }),
          of([&](Index i) {
            return std::pair{before.declared[i] - after.declared[i], after.weighted[i]};
          })};
}

InSample in_sample(const JointFit& fit, const std::vector<Index>& rows, const Matrix& residual,
                   const Vector& in_first) {
  const auto use = independent(fit.design, rows);
  const Whitened w(fit.design, rows, use, {});
  Matrix covariance;
  const Matrix x = w.coefficients(w.winsorised(w.take(residual)), &covariance);
  const auto p = index(use.size()), q = fit.design.random.cols();
  InSample out{w.take(residual), {}};
  out.left -= fit.design.fixed(rows, use) * x.topRows(p) + fit.design.random(rows, Eigen::all) * x.bottomRows(q);
  // A draw of which the readings say nothing is no unknown; one that they determine is.
  double freedom = static_cast<double>(rows.size() - use.size());
  for (Index j = p; j < p + q; ++j) freedom -= 1 - covariance(j, j);
  out.rms = (squares_of(out.left, rows, in_first) / freedom).cwiseSqrt();
  return out;
}

} // namespace gumshoe::tracing
