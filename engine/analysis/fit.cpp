#include "analysis/fit.h"

#include <cmath>
#include <limits>

#include <boost/math/distributions/chi_squared.hpp>

#include "analysis/leaves.h"
#include "base/special_values.h"
#include "models/fit.h"
#include "propagation/all_readings.h"

namespace gumshoe::analysis {
namespace {

std::optional<models::Fit> fit_of(const propagation::Experiment& e) {
  const models::FitFunction function = models::fit_function(e.model());
  if (!function || !e.forward().joint() || e.scenario().method == scenario::Method::prediction) return std::nullopt;
  const auto all = propagation::all_readings(e.forward(), e.estimates());
  models::BlockCall call = e.forward().call(all.block, nullptr, nullptr, nullptr);
  if (e.scenario().readings.front().indications.empty()) call.indications = nullptr;
  return function(call);
}

/// Mean over the samples of the residuals' mean square, which each fit gives as their root mean square.
double mean_square(const Column& rms) {
  double sum = 0, count = 0;
  Room room;
  for_pieces(rms, 0, rms.size(), room, [&](std::span<const double> some) {
    for (const double x : some)
      if (!std::isnan(x)) sum += x * x, ++count;
  });
  return sum / count;
}

double probability_of_more(double chi_squared, double degrees_of_freedom) {
  const boost::math::chi_squared distribution(degrees_of_freedom);
  return boost::math::cdf(boost::math::complement(distribution, std::min(chi_squared, 1e300)));
}

} // namespace

std::vector<FitCovariance> fit_covariances(const propagation::Experiment& e, const Samples& samples) {
  const auto fit = fit_of(e);
  if (!fit) return {};
  FitCovariance out;
  const double freedom = fit->degrees_of_freedom;
  const bool redundant = freedom > 1e-6, read = !std::isnan(fit->squares); // beyond rounding of a sum of squares
  out.equations = fit->equations;
  out.degrees_of_freedom = redundant ? freedom : 0;
  out.output = e.outputs()[fit->residual_rms];
  out.scatter = out.chi_squared = out.probability = nan;
  double scale = 1;
  if (fit->whitened) {
    out.meaning = "from the weights, that is from the declared uncertainties of the readings";
    if (read && redundant) out.chi_squared = fit->squares, out.probability = probability_of_more(fit->squares, freedom);
  } else {
    out.meaning = "from the residuals, as if every indication had an independent error of the same size";
    const double squares =
        read ? fit->squares : static_cast<double>(fit->equations) * mean_square(samples.values(fit->residual_rms));
    scale = redundant ? squares / freedom : nan;
    out.scatter = std::sqrt(scale);
  }
  const std::size_t n = fit->measurands.size();
  const auto u = [&](std::size_t i) {
    return fit->determined[i] ? std::sqrt(scale * fit->cofactors[i * n + i]) : std::numeric_limits<double>::infinity();
  };
  for (std::size_t i = 0; i < n; ++i) {
    out.outputs.push_back(e.outputs()[fit->measurands[i]]);
    out.standard_uncertainty.push_back(u(i));
    for (std::size_t j = 0; j < n; ++j) {
      const bool known = fit->determined[i] && fit->determined[j];
      const double q = fit->cofactors[i * n + j];
      out.covariance.push_back(known ? scale * q : i == j ? u(i) : nan);
      out.correlation.push_back(i == j  ? 1
                                : known ? q / std::sqrt(fit->cofactors[i * n + i] * fit->cofactors[j * n + j])
                                        : nan);
    }
  }
  return {out};
}

} // namespace gumshoe::analysis
