#include "analysis/sobol.h"

#include <algorithm>
#include <cmath>

#include "analysis/index_verdict.h"
#include "analysis/influence.h"
#include "analysis/pick_freeze.h"
#include "base/error.h"

namespace gumshoe::analysis {

namespace {

/// A series over the groups: sums of centred products, in units of their standard deviations.
using Series = std::vector<double>;

/// One kind of run: its sums and, from them, mean and standard deviation over the valid rows.
struct Margin {
  const double *sum, *squares;
  double mean, deviation;
};

class Estimator {
public:
  Estimator(PickFreezeSums& sums, std::size_t output) : s_(sums), o_(output), n_(sums.base(output, base_n)) {
    rows_ = total(n_);
    a_ = margin(s_.base(o_, base_a), s_.base(o_, base_aa));
    b_ = margin(s_.base(o_, base_b), s_.base(o_, base_bb));
    const double mean = 0.5 * (a_.mean + b_.mean);
    variance_.resize(s_.groups);
    for (std::size_t g = 0; g < s_.groups; ++g)
      variance_[g] = 0.5 * (a_.squares[g] + b_.squares[g]) - mean * (a_.sum[g] + b_.sum[g]) + n_[g] * mean * mean;
    v_ = total(variance_.data()) / rows_;
    // In this order: if x_i does not matter, AB_i is A, and shared and chance cancel to the last bit.
    chance_ = correlation(b_, a_, s_.base(o_, base_ab));
  }

  double rows() const { return rows_; }

  SobolIndex index(std::size_t v, const std::string& name) {
    const double *change = s_.frozen(o_, v, frozen_change), *mirrored = nullptr;
    const double images = s_.mirrored ? 2 : 1;
    if (s_.mirrored) mirrored = s_.frozen(o_, v, frozen_mirrored_change);
    Series jansen(change, change + s_.groups);
    for (std::size_t g = 0; mirrored && g < s_.groups; ++g) jansen[g] += mirrored[g];
    const Estimate whole = share(jansen, 2 * images);

    const Margin c = margin(s_.frozen(o_, v, frozen_c), s_.frozen(o_, v, frozen_cc));
    Correlation shared = correlation(b_, c, s_.frozen(o_, v, frozen_bc)), chance = chance_;
    // The weight of the control variate that is best for a linear model of normal inputs.
    const double rest = std::max(0.0, 1 - whole.value);
    double weight = rest;
    if (s_.mirrored) {
      const Margin d = margin(s_.frozen(o_, v, frozen_d), s_.frozen(o_, v, frozen_dd));
      shared = mean(shared, correlation(a_, d, s_.frozen(o_, v, frozen_ad)));
      chance = mean(chance, correlation(c, d, s_.frozen(o_, v, frozen_cd)));
      weight = rest / (rest + whole.value * whole.value);
    }
    Series influence(s_.groups);
    for (std::size_t g = 0; g < s_.groups; ++g) influence[g] = shared.influence[g] - weight * chance.influence[g];
    const Estimate first = with_interval(v_ > 0 ? shared.value - weight * chance.value : std::nan(""), influence, n_);
    return {name, first.value, first.low, first.high, whole.value, whole.low, whole.high, first.verdict, whole.verdict};
  }

  SobolPair pair(std::size_t i, std::size_t j, const std::string& a, const std::string& b) {
    const double* products = s_.pair(o_, i, j);
    const Estimate e = share({products, products + s_.groups}, 2);
    return {a, b, e.value, e.low, e.high, e.verdict};
  }

private:
  struct Correlation {
    double value = 0;
    Series influence;
  };

  double total(const double* series) const {
    double sum = 0;
    for (std::size_t g = 0; g < s_.groups; ++g) sum += series[g];
    return sum;
  }

  Margin margin(const double* sum, const double* squares) const {
    const double mean = total(sum) / rows_;
    return {sum, squares, mean, std::sqrt(std::max(0.0, total(squares) / rows_ - mean * mean))};
  }

  /// sum / (parts n V), with its influence (sum_g / parts - value V_g) / n V.
  Estimate share(const Series& sums, double parts) const {
    const double value = total(sums.data()) / parts / (rows_ * v_);
    Series influence(s_.groups);
    for (std::size_t g = 0; g < s_.groups; ++g) influence[g] = (sums[g] / parts - value * variance_[g]) / (rows_ * v_);
    return with_interval(v_ > 0 ? value : std::nan(""), influence, n_);
  }

  /// Pearson's r, with its influence (z_x z_y - r (z_x^2 + z_y^2) / 2) / n.
  Correlation correlation(const Margin& x, const Margin& y, const double* products) const {
    Correlation r{0, Series(s_.groups)};
    const double scale = 1 / (x.deviation * y.deviation), xx = 1 / (x.deviation * x.deviation),
                 yy = 1 / (y.deviation * y.deviation);
    if (!std::isfinite(scale)) return r; // one of the two does not vary: nothing is shared
    for (std::size_t g = 0; g < s_.groups; ++g)
      r.influence[g] = (products[g] - x.mean * y.sum[g] - y.mean * x.sum[g] + n_[g] * x.mean * y.mean) * scale / rows_;
    r.value = total(r.influence.data());
    for (std::size_t g = 0; g < s_.groups; ++g) {
      const double zx = (x.squares[g] - 2 * x.mean * x.sum[g] + n_[g] * x.mean * x.mean) * xx;
      const double zy = (y.squares[g] - 2 * y.mean * y.sum[g] + n_[g] * y.mean * y.mean) * yy;
      r.influence[g] -= 0.5 * r.value * (zx + zy) / rows_;
    }
    return r;
  }

  Correlation mean(Correlation x, const Correlation& y) const {
    x.value = 0.5 * (x.value + y.value);
    for (std::size_t g = 0; g < s_.groups; ++g) x.influence[g] = 0.5 * (x.influence[g] + y.influence[g]);
    return x;
  }

  PickFreezeSums& s_;
  std::size_t o_;
  const double* n_;
  double rows_ = 0, v_ = 0;
  Margin a_{}, b_{};
  Series variance_;
  Correlation chance_;
};

} // namespace

std::vector<Sensitivity> sobol_indices(const propagation::Experiment& e, std::uint64_t n,
                                       const propagation::Workers& workers) {
  const auto& plan = e.plan();
  if (!plan.copulas.empty())
    throw InputError("analysis.sensitivity: the inputs are correlated",
                     "Sobol' indices need independent inputs, Shapley effects do not",
                     "sensitivity = { shapley = 4096 }");
  const bool second_order = e.scenario().analysis.sensitivity.second_order;
  const auto groups = factors(e);
  PickFreezeSums sums = run_pick_freeze(e, n, second_order, workers);
  const auto reaching = reaching_variates(e);
  std::vector<Sensitivity> results;
  for (std::size_t o = 0; o < sums.outputs; ++o) {
    Estimator estimator(sums, o);
    Sensitivity s;
    s.output = e.outputs()[o];
    s.base_samples = sums.rows;
    s.dropped_rows = sums.rows - static_cast<std::uint64_t>(estimator.rows());
    s.confidence = index_confidence;
    const auto matters = [&](std::size_t f) { return reaches(reaching[o], groups[f]); };
    for (std::size_t f = 0; f < groups.size(); ++f)
      if (matters(f)) s.indices.push_back(estimator.index(f, groups[f].name));
    for (std::size_t i = 0; second_order && i < groups.size(); ++i)
      for (std::size_t j = i + 1; j < groups.size(); ++j)
        if (matters(i) && matters(j)) s.pairs.push_back(estimator.pair(i, j, groups[i].name, groups[j].name));
    results.push_back(std::move(s));
  }
  return results;
}

} // namespace gumshoe::analysis
