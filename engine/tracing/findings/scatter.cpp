#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {

void describe_scatter(const TraceContext& c, const JointFit& fit, int component, Finding& finding) {
  const auto& card = c.experiment.model().card->indications[0];
  SizedQuantity q;
  q.name = "standard deviation";
  q.unit = card.si_unit == "m" ? "um" : std::string(card.unit);
  q.si_unit = card.si_unit;
  const double unit = fit.design.reference[0] * std::sqrt(fit.variance);
  if (component < 0) { // of single readings: the noise is larger than declared
    q.value = unit;
    const auto freedom = static_cast<double>(c.fitter.rows().size());
    q.u = unit / std::sqrt(2 * freedom);
    q.low95 = q.value - 1.96 * q.u;
    q.high95 = q.value + 1.96 * q.u;
    if (const double declared = unit / (fit.noise * std::sqrt(fit.variance)); c.fitter.noise_declared())
      finding.remarks.push_back(fmt::format("single readings scatter by {}; {} is declared",
                                            shown_size(unit, q.unit, q.si_unit),
                                            shown_size(declared, q.unit, q.si_unit)));
    finding.quantities = {q};
    return;
  }
  // Profile likelihood over the ratio, the other structure as fitted.
  const auto& rows = c.fitter.rows();
  const int indication = fit.covariance_model.scatter == component ? fit.covariance_model.indication : -1;
  const auto use = independent(fit.design, rows);
  const Whitened plain(fit.design, rows, use, {});
  const Matrix data = plain.winsorised(plain.take(fit.residual));
  std::vector<std::array<double, 3>> profile; // ratio, criterion, s
  const double freedom = static_cast<double>(rows.size() - use.size());
  for (int i = 0; i <= criteria.scatter_steps; ++i) {
    const double ratio =
        criteria.scatter_low * std::pow(criteria.scatter_span, i / static_cast<double>(criteria.scatter_steps));
    const Whitened w(plain, {fit.covariance_model.correlation, component, ratio, indication});
    const double left = w.squares(data)[0];
    profile.push_back({ratio, freedom * std::log(left) + w.log_determinant(), std::sqrt(left / freedom)});
  }
  const auto best = std::ranges::min_element(profile, [](const auto& a, const auto& b) { return a[1] < b[1]; });
  const double reference = fit.design.reference[indication < 0 ? 0 : index(indication)];
  const auto size = [&](const auto& p) { return p[0] * p[2] * reference; };
  if (indication >= 0) finding.remarks.push_back("of " + c.observations.names[index(indication)] + " alone");
  q.value = size(*best);
  q.low95 = q.high95 = q.value;
  for (const auto& p : profile)
    if (p[1] < (*best)[1] + criteria.decisive) {
      q.low95 = std::min(q.low95, size(p));
      q.high95 = std::max(q.high95, size(p));
    }
  q.u = (q.high95 - q.low95) / 3.92;
  finding.quantities = {q};
}

} // namespace gumshoe::tracing
