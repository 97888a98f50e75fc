#include "analysis/validation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/gum.h"
#include "analysis/tolerance.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

Validation validate(const Budget& b, const Summary& s, double coverage_probability, int digits) {
  Validation v;
  v.output = b.output;
  v.digits = digits;
  if (!b.applicable) {
    v.verdict = "not applicable";
    v.reason = b.reason;
    v.delta = v.d_low = v.d_high = v.monte_carlo_tolerance = nan;
    return v;
  }
  const double u = b.combined_standard_uncertainty;
  if (!std::isfinite(u) || !std::isfinite(b.expanded_uncertainty)) {
    v.verdict = "not applicable";
    v.reason = "the framework's uncertainty is not finite";
    v.delta = v.d_low = v.d_high = v.monte_carlo_tolerance = nan;
    return v;
  }
  if (u == 0) {
    v.verdict = s.standard_uncertainty == 0 ? "not applicable" : "not validated";
    v.reason = s.standard_uncertainty != 0 ? "the framework's standard uncertainty is zero"
               : any_uncertain(b)          ? "the uncertainties of the inputs cancel"
                                           : "no input is uncertain";
    return v;
  }
  v.delta = numerical_tolerance(u, digits, b.output);
  if (!resolved(s, u)) {
    v.verdict = "not applicable";
    v.reason = "the samples do not resolve the uncertainty";
    v.d_low = v.d_high = v.monte_carlo_tolerance = nan;
    return v;
  }
  v.d_low = std::fabs(b.estimate - b.expanded_uncertainty - s.symmetric.low);
  v.d_high = std::fabs(b.estimate + b.expanded_uncertainty - s.symmetric.high);
  v.monte_carlo_tolerance = 2 * std::max(s.symmetric.low_se, s.symmetric.high_se);
  const double worst = std::max(v.d_low, v.d_high);
  // The standard error of an end holds where some 50 trials lie beyond it.
  const double n = static_cast<double>(s.valid), least = std::ceil(100 / (1 - coverage_probability));
  if (n < least) {
    v.verdict = "undecided";
    v.reason = fmt::format("{} trials are too few to compare intervals; use at least {:.0f}", s.valid, least);
  } else if (std::isnan(v.monte_carlo_tolerance)) {
    v.verdict = "undecided";
    v.reason = "the Monte Carlo tolerance is unknown: the design's points are not independent";
  } else if (worst - 2 * v.monte_carlo_tolerance > v.delta) { // by four standard errors, however uncertain the ends are
    v.verdict = "not validated";
    v.reason = "an end differs by more than delta";
  } else if (v.monte_carlo_tolerance > v.delta / 5) {
    v.verdict = "undecided";
    const double needed = n * std::pow(5 * v.monte_carlo_tolerance / v.delta, 2),
                 digit = std::pow(10, std::floor(std::log10(needed)));
    v.reason = fmt::format("the Monte Carlo tolerance exceeds a fifth of delta; about {:.1g} trials are needed",
                           std::ceil(needed / digit) * digit);
  } else if (worst > v.delta) {
    v.verdict = "undecided";
    v.reason = "the difference of an end and delta agree within the Monte Carlo tolerance; use more samples";
  } else {
    v.verdict = "validated";
    v.reason = "both ends agree within delta";
  }
  return v;
}

namespace {

/// A t of four degrees of freedom or fewer reaches the output, so that its variance by samples has no standard error.
bool has_no_fourth_moment(const Budget& b) {
  constexpr double counts = 0.01; // of the variance
  return std::ranges::any_of(b.contributions, [](const Contribution& c) {
    return c.distribution == "t" && c.degrees_of_freedom <= 4 && c.share > counts;
  });
}

} // namespace

double variance_over_scale(const Contribution& c) {
  const double freedom = c.degrees_of_freedom;
  return c.distribution == "t" && freedom > 2 && std::isfinite(freedom) ? freedom / (freedom - 2) : 1;
}

bool accounts_for_variance(const Budget& b, const Summary& s) {
  constexpr double apart = 0.05;
  const double u = s.standard_uncertainty;
  if (!std::isfinite(u)) return true;
  // How far the samples' u is off is not known then; how long their interval is, is.
  if (has_no_fourth_moment(b) && std::isfinite(b.expanded_uncertainty)) {
    const double length = s.symmetric.high - s.symmetric.low,
                 error = 2 * std::hypot(s.symmetric.low_se, s.symmetric.high_se);
    return std::fabs(length - 2 * b.expanded_uncertainty) <= 2 * apart * length + (std::isfinite(error) ? error : 0);
  }
  double wider = 1;
  for (const Contribution& c : b.contributions)
    if (std::isfinite(c.share)) wider += c.share * (variance_over_scale(c) - 1);
  const double law = wider * b.combined_standard_uncertainty * b.combined_standard_uncertainty;
  const double error = std::isfinite(s.standard_uncertainty_se) ? 4 * u * s.standard_uncertainty_se : 0;
  return std::fabs(u * u - law) <= apart * u * u + error;
}

Summary with_stated_uncertainty(Summary s, const Budget* b) {
  if (std::isfinite(s.standard_uncertainty) || !b || !b->applicable || !(b->combined_standard_uncertainty > 0))
    return s;
  s.standard_uncertainty = b->combined_standard_uncertainty;
  s.expanded_uncertainty = b->expanded_uncertainty;
  s.coverage_factor = b->coverage_factor;
  return s;
}

} // namespace gumshoe::analysis
