#include "tracing/findings/noise_alone.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "tracing/criteria.h"
#include "tracing/findings/errors.h"
#include "tracing/judgement/holdout.h"

namespace gumshoe::tracing {
namespace {

constexpr std::uint64_t key = 0xf100f;      ///< of these draws, in the seed
constexpr std::uint16_t scale_of_noise = 5; ///< stream of random numbers, after those of noise/draws

/// Declared draws that no training reading shows.
std::vector<Index> draws_of_held_out(const TraceContext& c, const Matrix& random) {
  std::vector<Index> out;
  for (Index j = 0; j < random.cols(); ++j)
    if (random(c.fitter.rows(), j).isZero(0)) out.push_back(j);
  return out;
}

/// Declared draws of one block each.
std::vector<Index> draws_of_single_blocks(const TraceContext& c, const Matrix& random) {
  const Blocks blocks = predicted_blocks(c.observations);
  std::vector<Index> out;
  for (Index j = 0; j < random.cols(); ++j)
    if (std::ranges::count_if(blocks.rows, [&](const auto& rows) { return !random(rows, j).isZero(0); }) == 1)
      out.push_back(j);
  return out;
}

/// @param own  declared draws that are not part of the fit
Matrix with_draws(const TraceContext& c, const JointFit& fit, const std::vector<Index>& own) {
  Design design = fit.design;
  design.random = Matrix(design.random(Eigen::all, own));
  std::vector<int> bent;
  for (const Index j : own) bent.push_back(design.bent[index(j)]);
  design.bent = std::move(bent);
  std::vector<Index> every(index(fit.residual.size()));
  std::iota(every.begin(), every.end(), 0);
  const Whitened w(design, every, {}, fit.covariance_model);
  return std::sqrt(fit.variance) * w.draw(criteria.noise_draws, c.seed ^ key);
}

bool in_turn(const TraceContext& c) { return c.observations.holdout_blocks.empty(); }

} // namespace

Matrix noise_of_readings(const TraceContext& c, const JointFit& fit) {
  return with_draws(c, fit, in_turn(c) ? std::vector<Index>{} : draws_of_held_out(c, fit.design.random));
}

Matrix noise_of_predicted(const TraceContext& c, const JointFit& fit, const Matrix& noise) {
  return in_turn(c) ? with_draws(c, fit, draws_of_single_blocks(c, fit.design.random)) : noise;
}

Matrix not_fitted(const TraceContext& c, const JointFit& fit, Matrix noise) {
  const std::size_t freedom = c.fitter.rows().size() - independent(fit.design, c.fitter.rows()).size();
  const Matrix chance = normals(freedom, index(noise.cols()), c.seed ^ key, scale_of_noise);
  for (Index j = 0; j < noise.cols(); ++j)
    noise.col(j) *= std::sqrt(static_cast<double>(freedom) / chance.col(j).squaredNorm());
  const std::vector<Index> rows = rows_where(c.observations, c.observations.held_out);
  if (!rows.empty()) noise(rows, Eigen::all) += c.fitter.across_jumps(fit, noise.cols())(rows, Eigen::all);
  return noise;
}

} // namespace gumshoe::tracing
