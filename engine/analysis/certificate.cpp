#include "analysis/certificate.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/rounding.h"
#include "base/special_values.h"
#include "base/units.h"

namespace gumshoe::analysis {

std::string certificate_line(const Summary& s, double p) {
  const auto& o = s.output;
  const double expanded = units::from_si(s.expanded_uncertainty, o.unit, o.si_unit, units::Kind::difference);
  const int d = decimals_for(expanded);
  const std::string pair =
      fmt::format("{} +- {}", fixed(units::from_si(s.estimate, o.unit, o.si_unit), d), fixed(expanded, d));
  return fmt::format(
      "{} = {}, k = {:.2f}{}, {}", o.name, o.unit == "1" ? pair : "(" + pair + ") " + o.unit, s.coverage_factor,
      std::isfinite(s.degrees_of_freedom) ? fmt::format(" ({})", effective_freedom(s.degrees_of_freedom)) : "",
      coverage_text(p));
}

std::string uncertainty_of_factor(const Summary& s, const Budget& b) {
  const auto text = [&](double u) { return with_suitable_unit(u, s.output.unit, s.output.si_unit); };
  const std::string u_c = text(b.combined_standard_uncertainty);
  return u_c == text(s.standard_uncertainty) ? "" : ", of u_c = " + u_c;
}

void certify(Summary& s, const Budget& b, const Validation& v, double p) {
  const bool gum = b.applicable && v.verdict == "validated";
  s.expanded_uncertainty = gum ? b.expanded_uncertainty : s.monte_carlo_expanded;
  s.coverage_factor = gum ? b.coverage_factor : s.monte_carlo_expanded / s.standard_uncertainty;
  s.degrees_of_freedom = gum ? b.effective_degrees_of_freedom : std::numeric_limits<double>::infinity();
  s.certificate.clear();
  if (!std::isfinite(s.standard_uncertainty) || !std::isfinite(s.estimate) || !std::isfinite(s.expanded_uncertainty))
    return void(s.expanded_uncertainty = s.coverage_factor = nan);
  if (!(s.expanded_uncertainty > 0)) return void(s.coverage_factor = nan); // a constant
  s.certificate = certificate_line(s, p);
}

} // namespace gumshoe::analysis
