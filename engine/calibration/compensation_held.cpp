#include "calibration/compensation_held.h"

#include <algorithm>
#include <cmath>

#include "calibration/data.h"
#include "calibration/estimated_scenario.h"
#include "quantities/correlations.h"

namespace gumshoe::calibration {
namespace {

using propagation::Experiment;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool from_estimate(const Experiment& e, std::size_t variate) {
  const auto& v = e.plan().variates[variate];
  const auto& component = e.scenario().quantities[v.quantity].entries[v.entry].components[v.component];
  return component.source.starts_with(estimate_source);
}

/// Some columns, over the standard deviations of the readings.
Rows whitened(const Eigen::MatrixXd& derivatives, const std::vector<std::size_t>& columns, const Data& data) {
  Rows out(derivatives.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = derivatives.col(static_cast<Eigen::Index>(columns[i]));
  whiten(data, out.data(), columns.size());
  return out;
}

} // namespace

Columns::Columns(const Experiment& e) : of_variate(e.plan().variates.size()) {
  for (std::size_t v = 0; v < of_variate.size(); ++v) {
    const std::size_t q = e.plan().variates[v].quantity;
    if (e.layout().indications.contains(q)) continue;
    of_variate[v] = variates.size();
    variates.push_back(v);
    quantities.push_back(q);
  }
  std::ranges::sort(quantities);
  const auto again = std::ranges::unique(quantities);
  quantities.erase(again.begin(), again.end());
}

Eigen::MatrixXd indications_by_variate(const Experiment& e, const Columns& columns, const propagation::Points& at,
                                       const std::vector<std::size_t>& quantities) {
  const auto& plan = e.plan();
  std::vector<propagation::Partial> partials;
  for (const std::size_t q : quantities) {
    double u = 0;
    for (const std::size_t v : columns.variates)
      if (plan.variates[v].quantity == q) u = std::max(u, plan.variates[v].distribution.standard_uncertainty());
    const double step = 1e-3 * u; // where derivatives are differences
    if (step > 0 && std::isfinite(step)) partials.push_back({q, step, -step, false, {}});
  }
  const propagation::Linearisation f = e.forward().linearise(at, partials);
  const std::size_t k = e.layout().indications.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(at.size() * k),
                                              static_cast<Eigen::Index>(columns.variates.size()));
  for (std::size_t p = 0; p < partials.size(); ++p)
    for (std::size_t row = 0; row < f.rows; ++row)
      for (const std::size_t v : plan.columns[plan.gather[row / k][partials[p].quantity]].variates)
        out(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(columns.of_variate[v])) +=
            f.derivatives[p * f.rows + row];
  return out;
}

Held held_by_fit(const Experiment& e, const Columns& columns) {
  Held out;
  quantities::Correlations correlations(e.plan());
  const Eigen::MatrixXd all = indications_by_variate(e, columns, e.estimates(), columns.quantities);
  const auto& variates = columns.variates;
  for (std::size_t c = 0; c < variates.size(); ++c)
    if (from_estimate(e, variates[c])) out.fitted.push_back(c);
  const auto tied = [&](std::size_t c) {
    const std::size_t group = correlations.group_of(variates[c]);
    return group < correlations.groups() &&
           std::ranges::any_of(out.fitted, [&](std::size_t f) { return correlations.group_of(variates[f]) == group; });
  };
  for (std::size_t c = 0; c < variates.size() && !out.fitted.empty(); ++c)
    if (!from_estimate(e, variates[c]) && !tied(c) && all.col(static_cast<Eigen::Index>(c)).any())
      out.held.push_back(c);
  if (out.held.empty()) return out;
  try {
    const Data data = data_of(e);
    if (!data.noise_declared) return out;
    const Rows j = whitened(all, out.fitted, data), k = whitened(all, out.held, data);
    Eigen::MatrixXd covariance(j.cols(), j.cols());
    for (std::size_t a = 0; a < out.fitted.size(); ++a)
      for (std::size_t b = 0; b < out.fitted.size(); ++b)
        covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
            correlations.covariance(variates[out.fitted[a]], variates[out.fitted[b]]);
    out.slopes = -covariance * (j.transpose() * k);
  } catch (const InputError&) { // no readings, or no noise of theirs
  }
  return out;
}

} // namespace gumshoe::calibration
