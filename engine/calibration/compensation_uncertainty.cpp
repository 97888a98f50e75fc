#include "calibration/compensation_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/data.h"
#include "calibration/estimated_scenario.h"

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

/// Derivatives of the indications by the variates of these quantities, SI, at these points; rows are
/// [reading][indication], columns of other quantities are zero.
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

struct Held {
  std::vector<std::size_t> fitted, held; ///< columns
  /// Derivative of each fitted value by each held one, [fitted][held], SI; empty where the scenario no longer has the
  /// readings or their noise, by which the fit weighed them.
  Eigen::MatrixXd slopes;
};

/// The fit is the one that wrote the scenario: with the covariance C of its values, weights W and derivatives J by the
/// fitted and K by the held variates, a change of these moves the values by -C J' W K (exact with the squared loss,
/// priors included). Held variates that a correlation ties to fitted ones are no part of it: the covariance has them.
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

ErrorUncertainty::ErrorUncertainty(const Experiment& e, std::size_t indication, const propagation::Points& with,
                                   const propagation::Points& without, const std::vector<std::size_t>& sizes, bool all)
    : e_(e), indication_(indication), all_(all), columns_(e), correlations_(e.plan()),
      by_size_(derivatives(with, sizes)), by_variate_(by_size_) {
  if (!all) return;
  std::vector<std::size_t> others = columns_.quantities;
  for (const std::size_t q : sizes) std::erase(others, q);
  by_variate_ += derivatives(with, others) - derivatives(without, others);
  add_held();
}

/// Of the indication asked for.
Eigen::MatrixXd ErrorUncertainty::derivatives(const propagation::Points& at,
                                              const std::vector<std::size_t>& quantities) const {
  const Eigen::MatrixXd rows = indications_by_variate(e_, columns_, at, quantities);
  const auto k = static_cast<Eigen::Index>(e_.layout().indications.size());
  return rows(Eigen::seq(static_cast<Eigen::Index>(indication_), Eigen::last, k), Eigen::all);
}

/// What the fit held moves the values that it gave.
void ErrorUncertainty::add_held() {
  const Held fit = held_by_fit(e_, columns_);
  fitted_ = fit.fitted;
  const Eigen::MatrixXd direct = by_variate_;
  for (std::size_t h = 0; h < fit.held.size(); ++h) {
    if (fit.slopes.size() == 0) declared(fit.held[h]).contained = false;
    for (std::size_t f = 0; f < fit.fitted.size() && fit.slopes.size() > 0; ++f)
      by_variate_.col(static_cast<Eigen::Index>(fit.held[h])) +=
          direct.col(static_cast<Eigen::Index>(fit.fitted[f])) *
          fit.slopes(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(h));
  }
}

double ErrorUncertainty::u_of(const Eigen::VectorXd& slope) {
  std::vector<Eigen::Index> moved;
  for (Eigen::Index c = 0; c < slope.size(); ++c)
    if (slope[c] != 0) moved.push_back(c);
  double variance = 0;
  for (const auto a : moved)
    for (const auto b : moved)
      variance += slope[a] * slope[b] *
                  correlations_.covariance(columns_.variates[static_cast<std::size_t>(a)],
                                           columns_.variates[static_cast<std::size_t>(b)]);
  return std::sqrt(std::max(0.0, variance));
}

ErrorUncertainty::OfMean ErrorUncertainty::of_mean(const std::vector<std::size_t>& readings) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(by_variate_.cols()), of_sizes = slope;
  for (const std::size_t r : readings) {
    slope += by_variate_.row(static_cast<Eigen::Index>(r)).transpose();
    of_sizes += by_size_.row(static_cast<Eigen::Index>(r)).transpose();
  }
  const auto n = static_cast<double>(readings.size());
  slope /= n, of_sizes /= n;
  OfMean out{0, u_of(of_sizes)};
  out.u = all_ ? u_of(slope) : out.u_of_sizes;
  largest_ = std::max(largest_, out.u);
  note_declared(slope, of_sizes);
  return out;
}

Compensation::Declared& ErrorUncertainty::declared(std::size_t column) {
  const std::string& name = e_.scenario().quantities[e_.plan().variates[columns_.variates[column]].quantity].name;
  const auto known = std::ranges::find(declared_, name, &Compensation::Declared::name);
  if (known != declared_.end()) return *known;
  declared_.push_back({name});
  return declared_.back();
}

/// Contributions that come neither from sizes nor from other fitted values.
void ErrorUncertainty::note_declared(const Eigen::VectorXd& slope, const Eigen::VectorXd& of_sizes) {
  std::map<std::string, Eigen::VectorXd> by_quantity; // a quantity may have several draws
  for (Eigen::Index c = 0; c < slope.size(); ++c) {
    const auto column = static_cast<std::size_t>(c);
    if (slope[c] == 0 || of_sizes[c] != 0 || std::ranges::find(fitted_, column) != fitted_.end()) continue;
    by_quantity.try_emplace(declared(column).name, Eigen::VectorXd::Zero(slope.size())).first->second[c] = slope[c];
  }
  for (const auto& [name, own] : by_quantity) {
    double& most = std::ranges::find(declared_, name, &Compensation::Declared::name)->most;
    most = std::max(most, u_of(own));
  }
}

std::vector<Compensation::Declared> ErrorUncertainty::declared() const {
  constexpr double shows = 0.01; // share of the largest u
  std::vector<Compensation::Declared> out = declared_;
  std::erase_if(out, [&](const auto& d) { return d.contained && !(d.most > shows * largest_); });
  std::ranges::stable_sort(out, std::ranges::greater(), &Compensation::Declared::most);
  return out;
}

} // namespace gumshoe::calibration
