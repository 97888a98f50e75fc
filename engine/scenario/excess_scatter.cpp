#include "scenario/excess_scatter.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gumshoe::scenario {
namespace {

constexpr double significance = 0.001;
constexpr double practically_infinite = 1e6; ///< degrees of freedom

/// Probability that the ratio of two variances is larger; `below` 0: the degrees of freedom of the second are infinite.
double p_value(double ratio, double above, double below) {
  using boost::math::complement;
  ratio = std::min(ratio, 1e100);
  if (below > 0 && below < practically_infinite) return cdf(complement(boost::math::fisher_f(above, below), ratio));
  return cdf(complement(boost::math::chi_squared(above), above * ratio));
}

std::string freedom_text(double degrees) {
  if (!(degrees > 0)) return {};
  return fmt::format(" ({:.6g} degree{} of freedom)", degrees, degrees == 1 ? "" : "s");
}

std::string declared_text(const DeclaredNoise& d, const VariableCard& card) {
  std::vector<std::string> parts;
  if (d.u > 0) parts.push_back("u = " + shown_scatter(d.u, card));
  if (d.repeatability.s > 0)
    parts.push_back("s = " + shown_scatter(d.repeatability.s, card) + freedom_text(d.repeatability.degrees_of_freedom));
  if (d.step > 0) parts.push_back("resolution " + shown_scatter(d.step, card));
  return fmt::format("{}", fmt::join(parts, ", "));
}

} // namespace

std::string excess_scatter(const std::vector<Readouts>& readings, const DeclaredNoise& d, const VariableCard& card) {
  const Scatter found = pooled_scatter(readings);
  if (!(found.degrees_of_freedom > 0) || !(d.u > 0 || d.repeatability.s > 0)) return {};
  const double uncertain = d.repeatability.s * d.repeatability.s;
  const double variance = uncertain + d.u * d.u + d.step * d.step / 4;
  // Welch-Satterthwaite: only the repeatability has finite degrees of freedom.
  const double share = uncertain / variance;
  const double freedom = share > 0 ? d.repeatability.degrees_of_freedom / (share * share) : 0;
  if (!(p_value(found.s * found.s / variance, found.degrees_of_freedom, freedom) < significance)) return {};
  return fmt::format(
      "repeats scatter by s = {}{}, which exceeds what is declared ({}; p < {}): is a reading wrong, or is "
      "the declared value too small?",
      shown_scatter(found.s, card), freedom_text(found.degrees_of_freedom), declared_text(d, card), significance);
}

} // namespace gumshoe::scenario
