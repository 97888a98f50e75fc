#include "calibration/estimate.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "base/special_values.h"
#include "calibration/fit.h"
#include "math/direction_words.h"
#include "math/parameter_covariance.h"

namespace gumshoe::calibration {
namespace {

using least_squares::Loss;

/// Slope of psi, for the covariance of an M-estimate.
double slope(Loss loss, double r, double width) {
  const double q = (r / width) * (r / width);
  if (loss == Loss::huber) return q <= 1 ? 1 : 0;
  if (loss == Loss::cauchy) return (1 - q) / ((1 + q) * (1 + q));
  if (loss == Loss::tukey) return q < 1 ? (1 - q) * (1 - 5 * q) : 0;
  return 1;
}

} // namespace

void Fit::describe(Estimate& out) const {
  out.notes = data_.notes;
  out.notes.insert(out.notes.end(), notes_.begin(), notes_.end());
  out.noise_declared = data_.noise_declared;
  out.loss = loss_;
  out.loss_width = loss_ == Loss::squared ? 0 : width_;
  out.solver = solution_.report;
  out.solver.iterations = iterations_;
  out.solver.evaluations = evaluations_;
  out.solver.cost_before = cost_before_;
  if (!scale_settled_) {
    out.solver.converged = false;
    out.solver.reason = "the scale of the residuals does not settle";
  }
  if (!defined()) {
    const auto failed = simulation_.failure();
    out.solver.reason += ": " + experiment_.reading_text(failed.reading) + ": " + status_name(failed.status);
  }
  for (const std::size_t j : out.solver.vanished) out.solver.reason += fmt::format(": {}", unknowns_[j].name);
  for (std::size_t j = 0; j < p_; ++j) out.parameters.push_back({unknowns_[j], x_[j], nan, false});
  for (const std::size_t j : out.solver.at_bound) out.parameters[j].at_limit = true;
}

void Fit::covariance(Estimate& out) const {
  out.covariance.assign(p_ * p_, nan);
  out.correlation.assign(p_ * p_, nan);
  out.condition = nan;
  out.determined = false;
  if (!defined()) return;
  const double tolerance = simulation_.exact() ? 1e-11 : 1e-7;
  const auto by_data = least_squares::parameter_covariance(solution_.jacobian, n_, p_, magnitudes(), tolerance);
  const auto all =
      least_squares::parameter_covariance(stacked(), n_ + priors_.target.size(), p_, magnitudes(), tolerance);
  out.rank = by_data.rank;
  out.condition = by_data.condition;
  std::vector<least_squares::Parameter> named;
  for (const Unknown& u : unknowns_) named.push_back({u.name, u.unit, u.si_unit});
  for (const auto& direction : by_data.unseen) out.indistinguishable.push_back(in_words(direction, named));
  out.determined = all.rank == p_;
  if (by_data.rank == p_ && by_data.condition > 1e6) {
    const auto names = members(by_data.weakest, named);
    out.notes.push_back(fmt::format("{} {} hardly distinguished by the data (condition number {:.1e})",
                                    fmt::join(names, ", "), names.size() > 1 ? "are" : "is", by_data.condition));
  }
  const double factor = variance_factor(out, all.rank);
  for (std::size_t i = 0; i < p_; ++i) {
    Parameter& parameter = out.parameters[i];
    parameter.standard_uncertainty = all.determined[i] ? std::sqrt(factor * all.matrix[i * p_ + i]) : infinity;
    for (std::size_t j = 0; j < p_; ++j) {
      if (!all.determined[i] || !all.determined[j]) continue;
      out.covariance[i * p_ + j] = factor * all.matrix[i * p_ + j];
      out.correlation[i * p_ + j] =
          i == j ? 1
                 : std::clamp(all.matrix[i * p_ + j] / std::sqrt(all.matrix[i * p_ + i] * all.matrix[j * p_ + j]), -1.0,
                              1.0);
    }
  }
}

/// What the covariance of rows in standard deviations is multiplied by; sets s and its degrees of freedom.
double Fit::variance_factor(Estimate& out, std::size_t rank) const {
  double squares = 0, psi = 0, slopes = 0, kept = 0; // a reading that the loss rejects, with weight 0, is not one
  for (const double r : solution_.residuals) {
    const double w = least_squares::weight(loss_, r, width_);
    if (w == 0) continue;
    kept += 1;
    squares += r * r;
    psi += (w * r) * (w * r);
    slopes += slope(loss_, r, width_);
  }
  slopes /= kept;
  const double left = kept - static_cast<double>(rank);
  out.residual_sum_of_squares = squares * sigma_ * sigma_;
  // Repeats of a reading know the noise too: with them the fit of the means is the fit of all readouts.
  const bool repeats = !data_.noise_declared && loss_ == Loss::squared;
  if (repeats) out.residual_sum_of_squares += data_.pure_error;
  out.noise_freedom = data_.noise_freedom;
  out.degrees_of_freedom = data_.noise_declared ? left + static_cast<double>(priors_.target.size())
                           : priors_.target.empty() || loss_ != Loss::squared
                               ? left + (repeats ? data_.pure_freedom : 0)
                               : freedom();
  out.s = out.degrees_of_freedom > 0 ? std::sqrt(out.residual_sum_of_squares / out.degrees_of_freedom) : nan;
  if (loss_ != Loss::squared) {
    if (!data_.noise_declared) out.s = sigma_;
    return left > 0 ? psi / left / (slopes * slopes) : nan; // Huber 1981, section 7.6
  }
  if (data_.noise_declared || !priors_.target.empty()) return 1;
  return out.s * out.s;
}

void Fit::rows(Estimate& out) const {
  const std::size_t k = experiment_.model().card->indications.size();
  std::vector<double> simulated(n_, nan);
  if (defined()) simulation_(x_.data(), simulated.data(), nullptr);
  const double unit = out.noise_declared || sigma_ != 1 ? 1 : out.s;
  for (std::size_t i = 0; i < n_; ++i)
    out.rows.push_back({i / k, i % k, data_.measured[i], simulated[i], data_.measured[i] - simulated[i],
                        defined() ? solution_.residuals[i] / unit : nan, solution_.weights[i]});
}

void Fit::goodness(Estimate& out) const {
  out.chi_squared = out.chi_squared_probability = nan;
  if (!out.noise_declared || !defined()) return;
  out.chi_squared = out.residual_sum_of_squares;
  for (std::size_t i = 0; i < priors_.target.size(); ++i) {
    double r = -priors_.target[i];
    for (std::size_t j = 0; j < p_; ++j) r += priors_.matrix[i * p_ + j] * x_[j];
    out.chi_squared += r * r;
  }
  if (!(out.degrees_of_freedom > 0)) return;
  out.s = std::sqrt(out.chi_squared / out.degrees_of_freedom);
  out.chi_squared_probability = boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(out.degrees_of_freedom), std::min(out.chi_squared, 1e300)));
}

Estimate estimate(const propagation::Experiment& experiment, const Options& options) {
  Fit fit(experiment, options);
  fit.solve();
  Estimate out;
  fit.describe(out);
  fit.covariance(out);
  fit.rows(out);
  fit.goodness(out);
  fit.remarks(out);
  return out;
}

} // namespace gumshoe::calibration
