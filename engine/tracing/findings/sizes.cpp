#include "tracing/findings/sizes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "quantities/cells.h"
#include "tracing/criteria.h"
#include "tracing/findings/interval.h"

namespace gumshoe::tracing {

std::string shown_size(double si, const std::string& unit, const std::string& si_unit) {
  return fmt::format("{:.3g}{}", units::from_si(si, unit, si_unit, units::Kind::difference), units::suffix(unit));
}

std::string with_u(double si, double u, const std::string& unit, const std::string& si_unit, std::string shown) {
  shown = shown.empty() ? units::suffix(unit) : " " + shown;
  const auto number = [&](double x) { return units::from_si(x, unit, si_unit, units::Kind::difference); };
  if (!(u > 0 && std::isfinite(u))) // readings without noise tell the size, and no uncertainty
    return fmt::format("{:.4g}{}, without an uncertainty", number(si), shown);
  const int decimals = analysis::decimals_for(number(u));
  return fmt::format("{}{}, u = {}{}", analysis::fixed(number(si), decimals), shown,
                     analysis::fixed(number(u), decimals), shown);
}

std::string display_unit(const Rms& rms) {
  double largest = 0;
  for (const double x : {rms.before, rms.after, rms.noise})
    if (std::isfinite(x)) largest = std::max(largest, x);
  return units::error_unit(rms.unit, rms.si_unit, largest);
}

std::string display_unit(const Rms& rms, const std::string& unit, const std::string& si_unit) {
  return rms.si_unit == si_unit ? display_unit(rms) : units::error_unit(unit, si_unit);
}

std::string shown_rms(double si, const Rms& rms) {
  if (rms.si_unit != "m") return shown_size(si, rms.unit, rms.si_unit);
  const std::string unit = display_unit(rms);
  const double x = units::from_si(si, unit, rms.si_unit, units::Kind::difference), size = std::fabs(x);
  return (size < 100 ? fmt::format("{:.2g}", x) : analysis::fixed(x, analysis::decimals_for(size))) + " " + unit;
}

std::vector<SizedQuantity> sizes(const TraceContext& c, const JointFit& fit, std::size_t term, double limit) {
  const Term& t = fit.terms[term];
  const Vector u = uncertainties(fit, term);
  std::vector<SizedQuantity> out;
  const auto amplitudes = std::ranges::count(t.candidate.amplitudes, false, &Amplitude::is_shape);
  for (Index j = 0; j < t.size.size(); ++j) {
    const Amplitude& a = t.candidate.amplitudes[index(j)];
    if (a.scenario_name.empty()) continue;
    SizedQuantity q{a.name, a.unit, a.si_unit, t.size[j], u[j], 0, 0, a.scenario_name, a.labels, false};
    // A size alone was reported because it passed the limit; of a pair neither was.
    const double least = amplitudes == 1 && !a.is_shape ? std::sqrt(limit) * u[j] : 0;
    std::tie(q.low95, q.high95) = interval_after_selection(q.value, q.u, least);
    if (a.is_shape) {
      q.low95 = std::max(q.low95, a.low);
      q.high95 = std::min(q.high95, a.high);
      for (double* x : {&q.value, &q.low95, &q.high95}) *x += a.held;
    }
    // A declared quantity is reported as it stands; by its shift where it differs from reading to reading.
    if (t.candidate.family == Family::declared) {
      const Points at = c.fitter.without_draws(fit);
      double low = 1e300, high = -1e300;
      for (std::size_t r = 0; r < at.size(); ++r) {
        if (!quantities::holds_for(a.labels, c.experiment.scenario().readings[r].labels)) continue;
        low = std::min(low, at[r][a.quantity]);
        high = std::max(high, at[r][a.quantity]);
      }
      if (low != high) {
        q.name = "shift of " + q.name;
        q.shift = true;
      } else {
        const double declared = low - q.value;
        for (double* x : {&q.value, &q.low95, &q.high95}) *x += declared;
      }
    }
    out.push_back(std::move(q));
  }
  return out;
}

void remark_on_size(const Term& term, Finding& finding) {
  constexpr const char* suspicion = "it may have another cause";
  // One component of a vector may be small.
  const bool single = std::ranges::count(term.candidate.amplitudes, false, &Amplitude::is_shape) == 1;
  for (Index j = 0; j < term.size.size(); ++j) {
    const Amplitude& a = term.candidate.amplitudes[index(j)];
    const auto shown = [&](double size) { return shown_size(size, a.unit, a.si_unit); };
    if (a.far_too_large(term.size[j]))
      finding.implausible = fmt::format("far above typical sizes (up to {})", shown(a.typical));
    else if (a.of_wrong_sign(term.size[j]))
      finding.implausible = "negative, which no such effect is";
    else if (single && !a.is_shape && std::fabs(term.size[j]) < criteria.negligible_size * a.least_typical)
      finding.implausible = fmt::format("far below typical sizes (from {})", shown(a.least_typical));
    else
      continue;
    finding.remarks.push_back(fmt::format("{} of {} is {}; likely an alias of another effect", a.name,
                                          shown(term.size[j]), finding.implausible));
  }
  for (Index j = 0; j < term.size.size(); ++j) {
    const Amplitude& a = term.candidate.amplitudes[index(j)];
    if (const double times = std::fabs(term.size[j]) / a.declared; a.declared > 0 && times > criteria.implausible_shift)
      finding.remarks.push_back(
          fmt::format("the value differs by {:.0f} times its declared standard uncertainty; {}", times, suspicion));
    if (a.at_limit(term.size[j]))
      finding.remarks.push_back(fmt::format("{} is at a limit of its range; {}", a.name, suspicion));
  }
  if (!term.candidate.held.empty() && !term.candidate.shape.empty())
    finding.remarks.push_back("with " + term.candidate.shape + ", which fits best of the shapes tried");
}

} // namespace gumshoe::tracing
