#include "tracing/judgement/assess.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>

#include "tracing/criteria.h"
#include "tracing/noise/block_spread.h"

namespace gumshoe::tracing {
namespace {

/// Without long double: a tail probability needs no more digits.
using Gamma =
    boost::math::gamma_distribution<double,
                                    boost::math::policies::policy<boost::math::policies::promote_double<false>>>;

Null null_of(const Eigen::Ref<const Matrix>& draws) {
  Null out;
  const double n = static_cast<double>(draws.size());
  out.mean = draws.mean();
  out.variance = (draws.array() - out.mean).square().sum() / std::max(1.0, n - 1);
  // One that is the same for all draws but for rounding: of two passes about their common mean, say.
  if (constexpr double alike = 1e-6; out.variance < alike * alike * out.mean * out.mean) out.variance = 0;
  return out;
}

double share_at_most(const std::vector<double>& draws, double value) {
  const auto below = std::ranges::count_if(draws, [&](double d) { return d <= value; });
  return (1.0 + static_cast<double>(below)) / (1.0 + static_cast<double>(draws.size()));
}

/// Null distribution of each statistic (row), from the first half of the draws.
std::vector<Null> nulls_of(const Matrix& draws, const std::vector<double>& rarity = {}) {
  std::vector<Null> out;
  for (Index j = 0; j < draws.rows(); ++j) {
    out.push_back(null_of(draws.row(j).head(draws.cols() / 2)));
    if (!rarity.empty()) out.back().rarity = rarity[index(j)];
  }
  return out;
}

/// The same of variance components. Of draws that resemble those before them, as long blocks with an offset each do,
/// hardly any has a component that explains more than that: then as one size by chance does, chi-squared.
std::vector<Null> nulls_of_components(const Matrix& draws) {
  constexpr double few = 0.02;
  std::vector<Null> out = nulls_of(draws);
  for (Index j = 0; j < draws.rows(); ++j) {
    const auto first = draws.row(j).head(draws.cols() / 2);
    if (static_cast<double>((first.array() > 0).count()) < few * static_cast<double>(first.size())) out[index(j)] = Null{};
  }
  return out;
}

/// The smallest p-value of the statistics of one data set.
double least_p(const std::vector<Null>& nulls, const Matrix& statistics, Index set, double least = 1) {
  for (std::size_t j = 0; j < nulls.size(); ++j) least = std::min(least, nulls[j].p(statistics(index(j), set)));
  return least;
}

/// Size of the noise as a statistic, lognormal to the eye: a robust scale, but with few readings, where that is blunt,
/// or few values that readings can have, where half of them may be equal, the root mean square.
class NoiseSize {
public:
  /// @param drawn  standard deviation of the draws that are not outlying   @param step  in which readings were recorded
  NoiseSize(const Scan& scan, const Statistics& data, const Statistics& draws, double drawn, double declared,
            double freedom, double step) {
    const double rms = std::sqrt(data.variance_without_scatter[0]);
    const bool blunt = scan.degrees_of_freedom() < criteria.robust_freedom || step > rms;
    const Vector size = blunt ? Vector(draws.variance_without_scatter.cwiseSqrt()) : draws.scale;
    const double observed = blunt ? rms : data.scale[0];
    drawn_ = size.array().log() - std::log(drawn);
    const auto first = drawn_.head(drawn_.size() / 2);
    middle_ = first.mean();
    spread_ = std::sqrt((first.array() - middle_).square().mean());
    // A declared s of nu degrees of freedom has a relative uncertainty of 1 / sqrt(2 nu) itself.
    spread_of_data_ = std::sqrt(spread_ * spread_ + 1 / (2 * freedom));
    constexpr double alike = 1e-6; // of readings in coarse steps most draws may be equal but for rounding
    // Where the data hold no more than rounding, they do not tell how large the noise is.
    const double least = scan.whitened(data.without_scatter[0]).least_variance();
    judged_ = declared > 0 && spread_ > alike && data.variance_without_scatter[0] > least;
    if (judged_) observed_ = std::log(observed / declared);
  }
  bool judged() const { return judged_; } ///< a noise is declared
  double p() const { return judged_ ? p_of(observed_, spread_of_data_) : 1; }
  double p_drawn(Index set) const { return judged_ ? p_of(drawn_[set], spread_) : 1; }

private:
  double p_of(double log_size, double spread) const {
    return boost::math::cdf(boost::math::complement(boost::math::normal(), (log_size - middle_) / spread));
  }
  Vector drawn_;
  double middle_ = 0, spread_ = 0, spread_of_data_ = 0, observed_ = 0;
  bool judged_ = false;
};

/// What repeats, and the scatter of each block, as statistics. Serial correlation within a block does not come back in
/// the next one, and so takes nothing from what does.
class RepeatStatistics {
public:
  RepeatStatistics(const Repeats* repeats, const Vector& residuals) : repeats_(repeats), observed_(of(residuals)) {
    if (repeats_ && repeats_->blocks > 0)
      observed_.bottomRows(index(repeats_->blocks)) = beyond_steps(spread(residuals));
  }
  /// Takes some of the draws, from set `first` on.
  void take(const Matrix& draws, Index first, Index sets) {
    drawn_.conservativeResize(observed_.rows(), sets);
    drawn_.middleCols(first, draws.cols()) = of(draws);
  }
  void match() { nulls_ = nulls_of(drawn_); }
  double p_lack_of_fit() const { return tests_fit() ? nulls_[0].p(observed_(0, 0)) : 1; }
  std::vector<double> p_blocks() const {
    std::vector<double> out;
    for (Index j = first_block(); j < index(nulls_.size()); ++j) out.push_back(nulls_[index(j)].p(observed_(j, 0)));
    return out;
  }
  double least() const { return least_p(nulls_, observed_, 0); }
  double least_drawn(Index set) const { return least_p(nulls_, drawn_, set); }

private:
  bool tests_fit() const { return repeats_ && repeats_->pure.known(); }
  Index first_block() const { return tests_fit() ? 1 : 0; }
  BlockSpread spread(const Matrix& residuals) const {
    return block_spread(repeats_->pure.about_cells(residuals), repeats_->block, repeats_->blocks);
  }
  /// Zero for blocks that scatter by no more than a step of the display: where the few readings lie that are off by one
  /// step is chance, and draws of a continuous noise do not contain that chance.
  Matrix beyond_steps(const BlockSpread& blocks) const {
    return (blocks.typical.array() <= repeats_->step).select(0, blocks.statistic);
  }
  /// Rows: lack of fit if it is tested, then blocks.
  Matrix of(const Matrix& residuals) const {
    if (!repeats_) return Matrix(0, residuals.cols());
    Matrix out(first_block() + index(repeats_->blocks), residuals.cols());
    if (tests_fit()) out.row(0) = repeats_->pure.lack_of_fit(residuals).transpose();
    if (repeats_->blocks == 0) return out;
    const BlockSpread blocks = spread(residuals);
    out.bottomRows(index(repeats_->blocks)) = repeats_->steps.any() ? beyond_steps(blocks) : blocks.statistic;
    return out;
  }

  const Repeats* repeats_;
  Matrix observed_, drawn_;
  std::vector<Null> nulls_;
};

} // namespace

double Null::single(double statistic) const {
  if (!(mean > 0) || !(variance > 0)) return 1;
  const Gamma gamma(mean * mean / variance, variance / mean);
  if (!(statistic > 0)) return 1;
  return std::max(boost::math::cdf(boost::math::complement(gamma, statistic)), 1e-300);
}

double Null::p(double statistic) const { return std::min(1.0, rarity * single(statistic)); }

double Null::quantile(double p) const {
  if (!(mean > 0) || !(variance > 0)) return std::numeric_limits<double>::infinity();
  const Gamma gamma(mean * mean / variance, variance / mean);
  return boost::math::quantile(boost::math::complement(gamma, p / rarity));
}

Assessment assess(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                  double declared, const ScatterResponse& response, const Repeats* repeats, double freedom,
                  const std::vector<double>& rarity, const std::vector<double>& exact) {
  Assessment out;
  out.data = scan.run(residuals);
  for (std::size_t j = 0; j < exact.size(); ++j)
    out.data.ratio(index(j), 0) = std::max(out.data.ratio(index(j), 0), exact[j]);
  out.noise_shape = scan.noise_shape(residuals);
  const std::size_t k0 = out.data.without_scatter[0], k1 = out.data.covariance_model[0];
  // Two lots: one tells how each statistic is distributed, the other, as new to that as the data are, how small the
  // least of all probabilities comes out by chance.
  const Index sets = draws;
  RepeatStatistics repeated(repeats, residuals);
  const CoarseSteps* steps = repeats && repeats->steps.any() ? &repeats->steps : nullptr;
  const auto null_draw = [&](const Whitened& w, double variance, const Draws& some, std::uint64_t key) {
    NoiseShape shape = out.noise_shape;
    const double s = std::sqrt(variance);
    if (steps) shape.own = steps->share(s);
    Matrix drawn = s * w.draw(some, key, shape);
    return steps ? steps->read(std::move(drawn), some, key) : drawn;
  };
  const auto null_draws = [&](std::size_t k, double variance, std::uint64_t key) {
    Statistics all;
    constexpr Index together = 512; // so that memory does not grow with the draws
    for (Index first = 0; first < 2 * sets; first += together) {
      const Draws some{index(first), index(std::min(together, 2 * sets - first)), index(2 * sets)};
      const Matrix drawn = null_draw(scan.whitened(k), variance, some, key);
      repeated.take(drawn, first, 2 * sets);
      put(scan.run(drawn, criteria.beyond_chance), first, 2 * sets, all);
    }
    repeated.match();
    return all;
  };
  // Nothing at all: no variance component either.
  const Statistics nothing = null_draws(k0, out.data.variance_without_scatter[0], seed);
  out.null = nulls_of(nothing.ratio, rarity);
  const auto component = nulls_of_components(nothing.scatter);
  const double drawn_variance = steps ? nothing.variance_without_scatter.mean() : out.data.variance_without_scatter[0];
  const NoiseSize size(scan, out.data, nothing, std::sqrt(drawn_variance) * out.noise_shape.core(), declared, freedom,
                       repeats ? repeats->step : 0);
  out.p_noise = size.p();
  out.noise_small = size.judged() && 1 - out.p_noise < criteria.noise_small_p;
  std::vector<double> least;
  for (Index i = sets; i < 2 * sets; ++i)
    least.push_back(least_p(component, nothing.scatter, i,
                            least_p(out.null, nothing.ratio, i, std::min(size.p_drawn(i), repeated.least_drawn(i)))));
  for (std::size_t j = 0; j < component.size(); ++j)
    out.p_component.push_back(share_at_most(least, component[j].p(out.data.scatter(index(j), 0))));
  out.p_anything =
      share_at_most(least, least_p(component, out.data.scatter, 0,
                                   least_p(out.null, out.data.ratio, 0, std::min(out.p_noise, repeated.least()))));
  out.p_noise_overall = share_at_most(least, out.p_noise);
  // Signatures given the noise as it seems to be, with its variance component.
  if (k1 != k0) {
    if (response) out.noise_shape.scatter = response(scan.covariance_models()[k1], out.data.variance[0]);
    const Statistics given_scatter = null_draws(k1, out.data.variance[0], seed ^ 0x5ca77e5ull);
    out.null = nulls_of(given_scatter.ratio, rarity);
    for (Index i = 0; i < sets; ++i)
      least[index(i)] = least_p(out.null, given_scatter.ratio, sets + i, repeated.least_drawn(sets + i));
  }
  for (std::size_t j = 0; j < out.null.size(); ++j) out.p.push_back(out.null[j].p(out.data.ratio(index(j), 0)));
  out.p_lack_of_fit = share_at_most(least, repeated.p_lack_of_fit());
  for (const double p : repeated.p_blocks()) out.p_block.push_back(share_at_most(least, p));
  out.p_signature = share_at_most(least, least_p(out.null, out.data.ratio, 0));
  std::ranges::sort(least);
  const auto rank = static_cast<std::size_t>(alpha * static_cast<double>(least.size() + 1));
  out.threshold = least[std::min(least.size() - 1, rank > 0 ? rank - 1 : 0)];
  return out;
}

Assessment assess_surely(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                         double declared, const ScatterResponse& response, const Repeats* repeats, double freedom,
                         const std::vector<double>& rarity, const std::vector<double>& exact) {
  const auto unsure = [&](double p, double n) {
    return p > criteria.unsure_low * alpha && p < criteria.unsure_high * alpha &&
           std::fabs(p - alpha) < criteria.sure * std::sqrt(alpha * (1 - alpha) / n);
  };
  for (double times = 1;; times *= criteria.more_draws) {
    const double n = times * draws;
    Assessment out =
        assess(scan, residuals, static_cast<int>(n), seed, alpha, declared, response, repeats, freedom, rarity, exact);
    if (times >= criteria.most_draws || !(unsure(out.p_anything, n) || unsure(out.p_signature, n))) return out;
  }
}

} // namespace gumshoe::tracing
