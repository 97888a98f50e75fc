#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/derivatives.h"
#include "analysis/poincare.h"
#include "analysis/reach.h"
#include "analysis/screening.h"
#include "analysis/units.h"
#include "base/special_values.h"
#include "propagation/parallel.h"

namespace gumshoe::analysis {

namespace {

/// Derivatives of the outputs by the variates that reach them, at points drawn at random. Thread-safe.
class SlopesAtPoints {
public:
  explicit SlopesAtPoints(const propagation::Experiment& e, std::uint64_t points)
      : e_(e), points_(points), d_(e.plan().variates.size()),
        by_differences_(e.scenario().method == scenario::Method::virtual_experiment || !e.has_gradient()),
        sampler_(e.plan(), quantities::PointSet::monte_carlo, points) {
    for (const auto& output : e.outputs()) {
      begin_.push_back(numbers_);
      reach_.push_back(variates_reaching(e, output.reading));
      numbers_ += reach_.back().size();
    }
  }

  bool exact() const { return !by_differences_; }
  const std::vector<Reach>& reach(std::size_t output) const { return reach_[output]; }
  /// Numbers of a point: [output][k of reach].
  std::size_t numbers() const { return numbers_; }
  std::size_t number(std::size_t output, std::size_t k) const { return begin_[output] + k; }
  std::uint64_t runs() const { return points_per_unit * (by_differences_ ? 2 * d_ : 1 + d_ / 8); }

  /// Units [first, last): out[point * numbers() + number]; NaN where there is no derivative.
  void find(std::uint64_t first, std::uint64_t last, double* out) const {
    const std::uint64_t from = first * points_per_unit, to = std::min(points_, last * points_per_unit);
    const auto rows = static_cast<std::size_t>(to - from), n = (rows + 7) / 8 * 8;
    std::fill_n(out, (last - first) * points_per_unit * numbers_, nan);
    const Aligned at(from);
    const std::size_t stride = at.offset + n;
    std::vector<double> drawn(d_ * stride), x(d_ * n);
    sampler_.draw(at.begin, stride, quantities::Purpose::fresh, drawn.data(), stride);
    for (std::size_t v = 0; v < d_; ++v) std::copy_n(&drawn[v * stride + at.offset], n, &x[v * n]);
    by_differences_ ? differences(x, n, rows, out) : exact_slopes(x, n, rows, out);
  }

private:
  void exact_slopes(const std::vector<double>& x, std::size_t n, std::size_t rows, double* out) const {
    const std::size_t measurands = e_.measurands().size();
    std::vector<double> variates(d_);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t v = 0; v < d_; ++v) variates[v] = x[v * n + i];
      std::vector<Derivatives> all;
      for (std::size_t o = 0; o < reach_.size(); ++o) {
        const std::size_t reading = e_.outputs()[o].reading;
        if (o % measurands == 0) all = differentiate(e_, reading, e_.point(reading, variates.data()), false);
        const Derivatives& at = all[o % measurands];
        if (at.status != Status::ok) continue;
        for (std::size_t k = 0; k < reach_[o].size(); ++k) {
          double& slope = out[i * numbers_ + number(o, k)] = 0;
          for (const std::size_t q : reach_[o][k].quantities) slope += at.first[q];
        }
      }
    }
  }

  void differences(std::vector<double>& x, std::size_t n, std::size_t rows, double* out) const {
    propagation::Workspace w;
    std::vector<double> up(reach_.size() * n), down(reach_.size() * n);
    std::vector<std::uint8_t> status(n);
    std::vector<const double*> pointers(d_);
    for (std::size_t v = 0; v < d_; ++v) pointers[v] = &x[v * n];
    for (std::size_t v = 0; v < d_; ++v) {
      const double h = 1e-3 * e_.plan().variates[v].distribution.standard_uncertainty();
      const std::vector<double> kept(&x[v * n], &x[v * n] + n);
      for (const auto& [sign, values] : {std::pair{1.0, &up}, std::pair{-1.0, &down}}) {
        for (std::size_t i = 0; i < n; ++i) x[v * n + i] = kept[i] + sign * h;
        e_.run(pointers, n, w, values->data(), status.data());
      }
      std::ranges::copy(kept, &x[v * n]);
      for (std::size_t o = 0; o < reach_.size(); ++o)
        for (std::size_t k = 0; k < reach_[o].size(); ++k)
          if (reach_[o][k].variate == v)
            for (std::size_t i = 0; i < rows; ++i)
              out[i * numbers_ + number(o, k)] = (up[o * n + i] - down[o * n + i]) / (2 * h);
    }
  }

  const propagation::Experiment& e_;
  std::uint64_t points_;
  std::size_t d_, numbers_ = 0;
  bool by_differences_;
  quantities::Sampler sampler_;
  std::vector<std::vector<Reach>> reach_;
  std::vector<std::size_t> begin_; ///< by output
};

/// Mean and standard error of the squares at the points that are not dropped; the bound from them.
DgsmRow row_of(const quantities::Variate& variate, const std::vector<double>& slopes, const std::vector<bool>& dropped,
               double constant, const Summary& summary) {
  DgsmRow row{variate.name, nan, nan, nan, nan, nan};
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (!dropped[i]) n += 1, sum += slopes[i] * slopes[i];
  if (n < 2) return row;
  row.nu = sum / n;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (!dropped[i]) squares += std::pow(slopes[i] * slopes[i] - row.nu, 2);
  row.nu_se = std::sqrt(squares / (n - 1) / n);
  const double u = summary.standard_uncertainty;
  row.bound = u > 0 ? constant * row.nu / (u * u) : nan;
  const double of_nu = row.nu > 0 ? row.nu_se / row.nu : 0;
  const double of_variance =
      std::isfinite(summary.standard_uncertainty_se) ? 2 * summary.standard_uncertainty_se / u : 0;
  const double half = 1.959964 * row.bound * std::hypot(of_nu, of_variance);
  row.bound_low = std::fmax(0, row.bound - half);
  row.bound_high = row.bound + half;
  if (std::isnan(row.bound)) row.bound_low = nan;
  return row;
}

} // namespace

propagation::Work dgsm_work(const propagation::Experiment& e, std::uint64_t points) {
  const auto slopes = std::make_shared<const SlopesAtPoints>(e, points);
  return {
      .name = "dgsm",
      .units = (points + points_per_unit - 1) / points_per_unit,
      .values = points_per_unit * slopes->numbers(),
      .runs = slopes->runs(),
      .together = points_in_a_call(e) / points_per_unit,
      .compute = [slopes](std::uint64_t first, std::uint64_t last, double* out) { slopes->find(first, last, out); }};
}

std::vector<Dgsm> derivative_measures(const propagation::Experiment& e, std::uint64_t points,
                                      const std::vector<Summary>& summaries, const propagation::Workers& workers) {
  const auto& plan = e.plan();
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size();
  std::vector<double> constants(d, nan);
  if (plan.copulas.empty())
    propagation::parallel_for(d, workers.threads,
                              [&](std::size_t v) { constants[v] = poincare_constant(plan.variates[v].distribution); });
  const SlopesAtPoints slopes(e, points);
  const std::vector<double> all = workers.values(dgsm_work(e, points));

  std::vector<Dgsm> results;
  for (std::size_t o = 0; o < outputs; ++o) {
    Dgsm g;
    g.output = e.outputs()[o];
    g.points = points;
    g.exact = slopes.exact();
    const auto& reach = slopes.reach(o);
    std::vector<std::vector<double>> by(reach.size(), std::vector<double>(points));
    std::vector<bool> dropped(points, false);
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t k = 0; k < reach.size(); ++k) by[k][i] = all[i * slopes.numbers() + slopes.number(o, k)];
      dropped[i] = std::ranges::any_of(by, [&](const auto& s) { return !std::isfinite(s[i]); });
      g.dropped += dropped[i];
    }
    for (std::size_t k = 0; k < reach.size(); ++k)
      g.rows.push_back(
          row_of(plan.variates[reach[k].variate], by[k], dropped, constants[reach[k].variate], summaries[o]));
    results.push_back(g);
  }
  return results;
}

} // namespace gumshoe::analysis
