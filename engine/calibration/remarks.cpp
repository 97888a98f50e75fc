// What a reader of an estimate must know beyond its numbers.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "calibration/fit.h"

namespace gumshoe::calibration {
namespace {

/// Standard uncertainty of a quantity, the largest of its entries; 0 if it is exact.
double uncertainty_of(const quantities::InputQuantity& quantity) {
  double largest = 0;
  for (const quantities::Entry& entry : quantity.entries) {
    double squares = 0;
    for (const quantities::Component& c : entry.components)
      squares += std::pow(c.distribution.standard_uncertainty(), 2);
    largest = std::max(largest, std::sqrt(squares));
  }
  return largest;
}

/// What is left of readings without noise.
double rounding_of(const Estimate& estimate) {
  const auto measured = [](const Row& r) { return std::fabs(r.measured); };
  constexpr double rounding = 1e-12;
  return rounding * measured(std::ranges::max(estimate.rows, {}, measured));
}

} // namespace

void Fit::remarks(Estimate& out) const {
  const auto& s = experiment_.scenario();
  // What is said of the data; that readings without noise are exact is not true of a fit.
  const auto of_data = [](const std::string& note) { return !note.ends_with("the readings are treated as exact"); };
  std::vector<std::string> said;
  std::ranges::copy_if(s.notes, std::back_inserter(said), of_data);
  out.notes.insert(out.notes.begin(), said.begin(), said.end());
  const auto& card = *experiment_.model().card;
  for (std::size_t q = 0; q < s.quantities.size(); ++q) {
    if (experiment_.layout().indications.contains(q)) continue;
    const auto& quantity = s.quantities[q];
    const double u = quantity.estimated ? 0 : uncertainty_of(quantity);
    // A quantity of the measurands alone has its uncertainty in the run of the written scenario.
    if (!(u > 0) || !simulation_.depends_on(x_.data(), q, u)) continue;
    out.held.push_back(quantity.name);
    out.notes.push_back(quantity.name +
                        " is held at its estimate, so that its uncertainty is not in the result (mark it "
                        "estimated to include it)");
  }
  if (!out.indistinguishable.empty())
    for (std::size_t c = 0; c < card.conditions.size() && s.readings.size() > 1; ++c) {
      const double first = s.readings.front().conditions[c];
      const std::string unit(card.conditions[c].unit);
      if (std::all_of(s.readings.begin(), s.readings.end(), [&](const auto& r) { return r.conditions[c] == first; }))
        out.notes.push_back(fmt::format("{} is {:.6g}{} in every reading", card.conditions[c].name,
                                        units::from_si(first, unit, std::string(card.conditions[c].si_unit)),
                                        units::suffix(unit)));
    }
  for (const Parameter& p : out.parameters)
    if (p.at_limit) out.notes.push_back(p.unknown.name + " is at a limit of its card");
  beyond_priors(out);
  contradicted_priors(out);
  if (!out.noise_declared && !(out.degrees_of_freedom > 0))
    out.notes.push_back(
        "there are as many unknowns as readings and no declared noise: no standard uncertainties are given");
  if (!out.noise_declared && out.degrees_of_freedom > 0 && out.s <= rounding_of(out))
    out.notes.push_back("the readings lie on the model but for rounding: their noise is not known from them, and the "
                        "standard uncertainties are rounding, too. Declare the noise of a reading");
  if (out.chi_squared_probability < 1e-6)
    out.notes.push_back(fmt::format("the residuals are {:.3g} times what the declared noise explains: is a unit, a "
                                    "label or a reading wrong, an effect missing, or the noise larger?",
                                    out.s));
  outlier(out);
}

/// Values that the distribution stated for them excludes.
void Fit::beyond_priors(Estimate& out) const {
  for (const Parameter& p : out.parameters) {
    const Unknown& x = p.unknown;
    if (!(x.prior_u > 0)) continue;
    const quantities::Entry& entry = experiment_.scenario().quantities[x.quantity].entries[x.entry];
    double low = entry.value, high = entry.value;
    for (const quantities::Component& c : entry.components)
      low += c.distribution.support_low(), high += c.distribution.support_high();
    const auto shown = [&](double si) { return units::from_si(si, x.unit, x.si_unit); };
    if (p.value < low || p.value > high)
      out.notes.push_back(fmt::format("{} lies outside of what is stated for it, {:.6g} to {:.6g}{}: a prior counts by "
                                      "its mean and standard uncertainty",
                                      x.name, shown(low), shown(high), units::suffix(x.unit)));
  }
}

/// Where the noise is not declared, a wrong prior makes it large, and no chi-squared tells: values that the readings
/// alone give, and that differ from what is stated.
void Fit::contradicted_priors(Estimate& out) const {
  constexpr double chance = 1e-4; // of a t: there are seldom more than ten priors
  for (std::size_t j = 0; j < alone_.x.size(); ++j) {
    const Unknown& x = unknowns_[j];
    if (!(x.prior_u > 0) || !(alone_.u[j] > 0)) continue;
    const double t = std::fabs(alone_.x[j] - x.start) / std::hypot(x.prior_u, alone_.u[j]);
    if (2 * boost::math::cdf(boost::math::complement(boost::math::students_t(alone_.freedom), t)) >= chance) continue;
    const auto size = [&](double si) { return units::from_si(si, x.unit, x.si_unit, units::Kind::difference); };
    out.notes.push_back(fmt::format(
        "the readings alone give {} = {:.6g}{}, u = {:.2g}, {:.3g} standard uncertainties from what is stated for it, "
        "{:.6g}{}, u = {:.2g}: one of the two is wrong. The result "
        "stands between them, and s is too large",
        x.name, units::from_si(alone_.x[j], x.unit, x.si_unit), units::suffix(x.unit), size(alone_.u[j]), t,
        units::from_si(x.start, x.unit, x.si_unit), units::suffix(x.unit), size(x.prior_u)));
  }
}

/// The largest residual, if it stands out from the others' middle.
void Fit::outlier(Estimate& out) const {
  std::vector<double> sizes;
  for (const Row& r : out.rows) sizes.push_back(std::fabs(r.normalised));
  if (sizes.size() < 5 || !defined()) return;
  const double scale = median_of(sizes) / 0.6744897501960817;
  const auto largest = std::max_element(sizes.begin(), sizes.end());
  if (!(scale > 0) || !(*largest > 8 * scale) || !(*largest > (out.noise_declared ? 5 : 0))) return;
  const Row& row = out.rows[static_cast<std::size_t>(largest - sizes.begin())];
  if (std::fabs(row.residual) <= rounding_of(out)) return;
  const auto others = std::ranges::count_if(sizes, [&](double size) { return size > 8 * scale; }) - 1;
  const auto& indication = experiment_.model().card->indications[row.indication];
  const std::string unit(indication.unit);
  out.notes.push_back(fmt::format(
      "{} stands out: {} is {:.4g}{} from the fit, {:.3g} times the usual residual{}",
      experiment_.reading_text(row.reading), indication.name,
      units::from_si(row.residual, unit, std::string(indication.si_unit), units::Kind::difference), units::suffix(unit),
      *largest / scale, others > 0 ? fmt::format("; so {} {} more", others == 1 ? "does" : "do", others) : ""));
}

} // namespace gumshoe::calibration
