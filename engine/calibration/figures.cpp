#include "calibration/figures.h"

#include <algorithm>

namespace gumshoe::calibration {

analysis::Figure figure(const Estimate& estimate, const propagation::Experiment& experiment, const std::string& text) {
  const auto name = analysis::parse_figure(text);
  const auto& parameters = estimate.parameters;
  const auto at = [&](std::size_t argument) {
    const auto it =
        argument < name.arguments.size()
            ? std::ranges::find(parameters, name.arguments[argument], [](const Parameter& p) { return p.unknown.name; })
            : parameters.end();
    return static_cast<std::size_t>(it - parameters.begin());
  };
  const std::size_t n = parameters.size(), i = at(0), j = at(1);
  const auto plain = [](double value) { return analysis::Figure{value, 0, "1", "1", true, ""}; };
  const auto of = [&](double value, bool difference) {
    return analysis::Figure{value, 0, parameters[i].unknown.unit, parameters[i].unknown.si_unit, difference, ""};
  };
  if (name.word == "fit.converged") return {0, 0, "1", "1", true, estimate.solver.converged ? "yes" : "no"};
  if (name.word == "fit.degrees_of_freedom") return plain(estimate.degrees_of_freedom);
  if (name.word == "fit.residual_sum_of_squares") return plain(estimate.residual_sum_of_squares);
  if (name.word == "fit.residual_standard_deviation") {
    if (estimate.noise_declared) return plain(estimate.s);
    const auto& card = experiment.model().card->indications[0];
    return {estimate.s, 0, std::string(card.unit), std::string(card.si_unit), true, ""};
  }
  if (i < n && name.word == "fit.value") return of(parameters[i].value, false);
  if (i < n && name.word == "fit.standard_uncertainty") return of(parameters[i].standard_uncertainty, true);
  if (i < n && j < n && name.word == "fit.correlation") return plain(estimate.correlation[i * n + j]);
  throw InputError("'" + text + "' is not a figure of this fit", "",
                   "the header calibration/figures.h of the program lists them");
}

} // namespace gumshoe::calibration
