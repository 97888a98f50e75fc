#include "analysis/combine.h"

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace gumshoe::analysis {

CombinedVariance combine(std::span<const Term> terms, quantities::Correlations& correlations) {
  struct Sum { // of the terms of one variate
    double contribution = 0, degrees = 0;
  };
  std::vector<std::map<std::size_t, Sum>> groups(correlations.groups() + 1); // by variate; the last: in no group
  CombinedVariance out;
  for (const Term& t : terms) {
    if (t.contribution == 0) continue;
    Sum& sum = groups[correlations.group_of(t.variate)][t.variate];
    out.independent += t.contribution * t.contribution;
    out.correlation += 2 * sum.contribution * t.contribution;
    sum.contribution += t.contribution;
    sum.degrees = t.degrees_of_freedom;
  }
  double satterthwaite = 0;
  std::vector<Sum> estimates(correlations.estimates()); // their squares
  for (const auto& [v, sum] : groups.back()) {
    if (const std::size_t e = correlations.estimate_of(v); e < estimates.size()) {
      estimates[e].contribution += sum.contribution * sum.contribution;
      estimates[e].degrees = sum.degrees;
    } else {
      satterthwaite += std::pow(sum.contribution, 4) / sum.degrees;
    }
  }
  for (const Sum& squares : estimates)
    if (squares.contribution > 0) satterthwaite += squares.contribution * squares.contribution / squares.degrees;
  for (std::size_t g = 0; g < correlations.groups(); ++g) {
    if (groups[g].empty()) continue;
    // The group has those of its members: for simultaneous observations n - 1, as for any function of them.
    const double degrees = groups[g].begin()->second.degrees;
    double own = 0, between_members = 0;
    for (auto a = groups[g].begin(); a != groups[g].end(); ++a) {
      out.unequal |= a->second.degrees != degrees;
      own += a->second.contribution * a->second.contribution;
      for (auto b = groups[g].begin(); b != a; ++b) {
        const double r = correlations.between(a->first, b->first);
        between_members += 2 * r * a->second.contribution * b->second.contribution;
        constexpr double one_error = 1 - 1e-9;
        out.unequal |= std::isfinite(degrees) && correlations.of_results(g) && std::fabs(r) < one_error;
      }
    }
    out.correlation += between_members;
    satterthwaite += std::pow(std::max(own + between_members, 0.0), 2) / degrees;
  }
  if (out.unequal)
    out.effective_degrees_of_freedom = std::numeric_limits<double>::quiet_NaN();
  else if (constexpr double rounding = 1e-12; satterthwaite > 0 && out.total() > rounding * out.independent)
    out.effective_degrees_of_freedom = out.total() * out.total() / satterthwaite;
  return out;
}

Expansion expand(const CombinedVariance& combined, double coverage_probability) {
  Expansion x;
  x.effective_degrees_of_freedom = combined.effective_degrees_of_freedom;
  if (x.effective_degrees_of_freedom >= 1) // not one less by rounding
    x.effective_degrees_of_freedom = std::floor(x.effective_degrees_of_freedom * (1 + 1e-12));
  constexpr double as_good_as_infinite = 1e6;
  if (x.effective_degrees_of_freedom >= as_good_as_infinite)
    x.effective_degrees_of_freedom = std::numeric_limits<double>::infinity();
  const double tail = 0.5 * (1 + coverage_probability);
  x.coverage_factor = std::isfinite(x.effective_degrees_of_freedom)
                          ? quantile(boost::math::students_t(x.effective_degrees_of_freedom), tail)
                          : quantile(boost::math::normal(), tail);
  x.expanded_uncertainty = x.coverage_factor * std::sqrt(combined.total());
  return x;
}

} // namespace gumshoe::analysis
