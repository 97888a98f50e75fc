#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {

namespace {

/// Where a parabola through three points at -1, 0 and 1 is lowest, of which the middle one is.
double lowest(double left, double middle, double right) {
  const double bend = left - 2 * middle + right;
  return bend > 0 ? 0.5 * (left - right) / bend : 0;
}

/// Where ln(t) + 1 / t - 1, which is what a variance t times the best one lacks in likelihood, reaches a limit: ln(t).
/// @param side  -1 below the best, 1 above it
double noise_within(double limit, int side) {
  double x = side * std::sqrt(2 * limit);
  constexpr int iterations = 8; // Newton's, of a convex function near its parabola
  for (int i = 0; i < iterations && limit > 0; ++i) x -= (x + std::expm1(-x) - limit) / -std::expm1(-x);
  return x;
}

} // namespace

ScatterSize size_of_scatter(const TraceContext& c, const JointFit& fit, int component) {
  // Likelihood over the ratio to the noise, the other structure as fitted.
  const auto& rows = c.fitter.rows();
  const int indication = fit.covariance_model.scatter == component ? fit.covariance_model.indication : -1;
  const auto use = independent(fit.design, rows);
  const Whitened plain(fit.design, rows, use, {});
  const Matrix data = plain.winsorised(plain.take(fit.residual));
  const double freedom = static_cast<double>(rows.size() - use.size());
  struct Ratio {
    double criterion, size; // -2 ln L with the noise that fits best, and the size then
  };
  const auto at = [&](double step) {
    const double ratio = criteria.scatter_low * std::pow(criteria.scatter_span, step / criteria.scatter_steps);
    const Whitened w(plain, {fit.covariance_model.correlation, component, ratio, indication});
    const double left = w.squares(data)[0];
    return Ratio{freedom * std::log(left) + w.log_determinant(), ratio * std::sqrt(left / freedom)};
  };
  std::vector<Ratio> all;
  for (int i = 0; i <= criteria.scatter_steps; ++i) all.push_back(at(i));
  const auto found = std::ranges::min_element(all, {}, &Ratio::criterion);
  Ratio best = *found;
  if (found != all.begin() && found + 1 != all.end())
    if (const Ratio between = at(static_cast<double>(found - all.begin()) +
                                 lowest((found - 1)->criterion, best.criterion, (found + 1)->criterion));
        between.criterion < best.criterion)
      best = between;
  // At each ratio the noise may be another: as far as the likelihood of the size allows it.
  ScatterSize out{best.size, best.size, best.size, indication};
  all.push_back(best);
  for (const Ratio& one : all) {
    const double slack = criteria.decisive - (one.criterion - best.criterion);
    if (slack < 0) continue;
    out.low = std::min(out.low, one.size * std::exp(noise_within(slack / freedom, -1) / 2));
    out.high = std::max(out.high, one.size * std::exp(noise_within(slack / freedom, 1) / 2));
  }
  return out;
}

std::vector<MoreNoise> larger_noise(const JointFit& fit, const Finding& found) {
  if (found.kind != Kind::scatter || found.depends_on != std::vector<std::string>{"reading"}) return {};
  std::vector<MoreNoise> out;
  const auto& reference = fit.design.reference;
  const double scale = fit.noise * std::sqrt(fit.variance); // what is missing in its square
  for (std::size_t i = 0; i < reference.size(); ++i)
    out.push_back({i, reference[i] / fit.noise * std::sqrt(std::max(0.0, scale * scale - 1))});
  return out;
}

std::vector<MoreNoise> noise_of(const Component& component, const JointFit& fit) {
  std::vector<MoreNoise> out;
  const auto& reference = fit.design.reference;
  for (std::size_t i = 0; i < reference.size(); ++i)
    if (component.indication < 0 || i == index(component.indication))
      out.push_back({i, component.u * reference[i], component.group});
  return out;
}

void describe_scatter(const TraceContext& c, const JointFit& fit, const FittedScatter& scatter, int component,
                      const Rms& rms, Finding& finding) {
  const auto& card = c.experiment.model().card->indications[0];
  SizedQuantity q;
  q.name = "standard deviation";
  q.si_unit = card.si_unit;
  q.unit = display_unit(rms, std::string(card.unit), q.si_unit);
  const double unit = fit.design.reference[0] * std::sqrt(fit.variance);
  if (component < 0) { // of single readings: the noise is larger than declared
    q.value = unit;
    const auto& rows = c.fitter.rows();
    const auto freedom = static_cast<double>(rows.size() - independent(fit.design, rows).size());
    const boost::math::chi_squared squares(freedom);
    q.u = unit / std::sqrt(2 * freedom);
    q.low95 = unit * std::sqrt(freedom / quantile(squares, 0.975));
    q.high95 = unit * std::sqrt(freedom / quantile(squares, 0.025));
    if (const double declared = unit / (fit.noise * std::sqrt(fit.variance)); c.fitter.noise_declared())
      finding.remarks.push_back(fmt::format("single readings scatter by {}; {} is declared",
                                            shown_size(unit, q.unit, q.si_unit),
                                            shown_size(declared, q.unit, q.si_unit)));
    finding.quantities = {q};
    return;
  }
  const auto known = std::ranges::find(scatter.components, component, &Component::index);
  ScatterSize size = size_of_scatter(c, given_others(fit, scatter, component), component);
  if (known != scatter.components.end()) size.best = known->u;
  const double reference = fit.design.reference[index(std::max(0, size.indication))];
  if (size.indication >= 0) finding.remarks.push_back("of " + c.observations.names[index(size.indication)] + " alone");
  q.value = size.best * reference;
  q.low95 = size.low * reference;
  q.high95 = size.high * reference;
  q.u = (q.high95 - q.low95) / 3.92;
  finding.quantities = {q};
}

} // namespace gumshoe::tracing
