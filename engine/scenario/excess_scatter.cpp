#include "scenario/excess_scatter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/special_values.h"
#include "math/variance_ratio.h"

namespace gumshoe::scenario {
namespace {

constexpr double significance = 0.001;

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
  const double freedom = d.repeatability.degrees_of_freedom > 0 && share > 0
                             ? d.repeatability.degrees_of_freedom / (share * share)
                             : infinity;
  const double ratio = found.s * found.s / variance;
  if (!(p_of_variance_ratio(ratio, found.degrees_of_freedom, freedom) < significance)) return {};
  return fmt::format(
      "repeats scatter by s = {}{}, which exceeds what is declared ({}; p < {}): is a reading wrong, or is "
      "the declared value too small?",
      shown_scatter(found.s, card), freedom_text(found.degrees_of_freedom), declared_text(d, card), significance);
}

} // namespace gumshoe::scenario
