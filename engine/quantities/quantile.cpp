/// Quantile functions: a distribution's constants for the kernels, and the discrete ones.
#include <algorithm>
#include <cmath>

#include "quantities/deviate_table.h"
#include "quantities/distribution.h"
#include "quantities/quantile_kernels.h"

namespace gumshoe::quantities {
namespace {

double probability_in_lanes(double z) {
  double lanes[8];
  std::fill(lanes, lanes + 8, z);
  kernels().normal_probability(lanes, lanes, 8);
  return lanes[0];
}

QuantileSpec trapezoid_spec(double low, double high, double top_ratio) {
  const double width = high - low, flank = width / 2 * (1 - top_ratio);
  return {Form::trapezoid,
          {low, high, (1 - top_ratio) / (2 * (1 + top_ratio)), width * std::sqrt((1 - top_ratio * top_ratio) / 2),
           flank / 2, width * (1 + top_ratio) / 2},
          {}};
}

QuantileSpec curvilinear_spec(double low, double high, double d) {
  const double half_width = (high - low) / 2, l = half_width - d, h = half_width + d;
  // Where flat, y = 4 d (1/2 - p) / ln(h / l); with l = 0 nothing is flat.
  const double flat = l > 0 ? 4 * d / std::log(h / l) : 1.0;
  return {Form::curvilinear, {(low + high) / 2, l > 0 ? l : -1.0, h, 4 * d / h, flat}, {}};
}

QuantileSpec truncated_spec(double mean, double u, double low, double high) {
  const double a = (low - mean) / u, b = (high - mean) / u;
  const double below = probability_in_lanes(a), above = probability_in_lanes(-b);
  const double between = a > 0 ? probability_in_lanes(-a) - above : probability_in_lanes(b) - below;
  return {Form::truncated, {mean, u, low, high, below, above, between}, {}};
}

} // namespace

struct QuantileFunction::Impl {
  Distribution distribution;
  QuantileSpec spec;
  std::shared_ptr<const DeviateTable> table;
  std::vector<double> cumulative; ///< discrete

  explicit Impl(const Distribution& d) : distribution(d) {
    const auto& p = d.parameters;
    switch (d.family) {
    case Family::constant:
      spec = {Form::constant, {p[0]}, {}};
      break;
    case Family::rectangular:
      spec = {Form::linear, {p[0], p[1] - p[0]}, {}};
      break;
    case Family::curvilinear_trapezoid:
      spec = curvilinear_spec(p[0], p[1], p[2]);
      break;
    case Family::trapezoid:
      spec = trapezoid_spec(p[0], p[1], p[2]);
      break;
    case Family::triangular:
      spec = trapezoid_spec(p[0], p[1], 0);
      break;
    case Family::arcsine:
      spec = {Form::arcsine, {p[0], p[1], p[1] - p[0]}, {}};
      break;
    case Family::normal:
      spec = {Form::normal, {p[0], p[1]}, {}};
      break;
    case Family::t:
      table = t_table(p[2]);
      spec = {Form::odd_table, {p[0], p[1]}, table->view()};
      break;
    case Family::exponential:
      spec = {Form::exponential, {p[0]}, {}};
      break;
    case Family::gamma:
      table = gamma_table(p[0]);
      spec = {Form::table, {0.0, p[1]}, table->view()};
      break;
    case Family::lognormal:
      spec = {Form::lognormal, {p[0], p[1]}, {}};
      break;
    case Family::truncated_normal:
      spec = truncated_spec(p[0], p[1], p[2], p[3]);
      break;
    case Family::discrete: {
      double sum = 0;
      for (const double probability : *d.probabilities) cumulative.push_back(std::min(sum += probability, 1.0));
      break;
    }
    case Family::empirical:
      break;
    }
  }

  /// Smallest value whose distribution function reaches u.
  double discrete(double u) const {
    const auto& values = *distribution.values;
    const std::size_t last = values.size() - 1;
    const auto i =
        static_cast<std::size_t>(std::lower_bound(cumulative.begin(), cumulative.end(), u) - cumulative.begin());
    return values[std::min(i, last)];
  }

  double empirical(double u) const {
    const auto& values = *distribution.values;
    const double n = static_cast<double>(values.size());
    auto i = static_cast<std::size_t>(std::clamp(std::ceil(u * n) - 1, 0.0, n - 1));
    // The product may have rounded across a step: compare as probability() divides.
    if (i > 0 && u <= static_cast<double>(i) / n) --i;
    return values[i];
  }
};

QuantileFunction::QuantileFunction(const Distribution& distribution)
    : impl_(std::make_shared<const Impl>(distribution)) {}

void QuantileFunction::operator()(const double* u, double* out, std::size_t n) const {
  if (impl_->distribution.family == Family::discrete) {
    for (std::size_t i = 0; i < n; ++i) out[i] = impl_->discrete(u[i]);
  } else if (impl_->distribution.family == Family::empirical) {
    for (std::size_t i = 0; i < n; ++i) out[i] = impl_->empirical(u[i]);
  } else {
    kernels().quantile(&impl_->spec, u, out, n);
  }
}

double Distribution::quantile(double u) const {
  double lanes[8];
  std::fill(lanes, lanes + 8, u);
  QuantileFunction{*this}(lanes, lanes, 8);
  return lanes[0];
}

} // namespace gumshoe::quantities
