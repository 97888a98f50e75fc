#include "analysis/derivatives.h"

#include <algorithm>
#include <cmath>

#include "analysis/differences.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t chunk = 8;

/// The measurands; NaN where the model has no value.
std::vector<double> plain(const propagation::Experiment& e, std::size_t reading, const std::vector<double>& point) {
  std::vector<models::Gradient> x(point.begin(), point.end()), y;
  const bool ok = e.outputs_at(reading, x, y).status == 0;
  std::vector<double> out;
  for (std::size_t m = 0; m < e.measurands().size(); ++m) out.push_back(ok ? y[m].v : std::nan(""));
  return out;
}

/// Finds the measurands and quantities that a kink concerns, from values on either side of the point. The others keep
/// their derivatives, or take the difference where the two disagree (the model may have left its branch at the kink).
/// @return by measurand, whether all of its derivatives stand
std::vector<bool> find_kinks(const propagation::Experiment& e, std::size_t reading, const std::vector<double>& point,
                             std::vector<Derivatives>& of) {
  constexpr double fraction = 1.0 / 64, alike = 1e-3;
  std::vector<bool> smooth(of.size(), true);
  const std::vector<double> u = steps(e, reading, point);
  for (std::size_t q = 0; q < point.size(); ++q) {
    const double h = u[q] > 0 && std::isfinite(u[q]) ? fraction * u[q] : 1e-6 * std::max(1e-3, std::fabs(point[q]));
    const auto at = [&](double by) {
      auto shifted = point;
      shifted[q] += by;
      return plain(e, reading, shifted);
    };
    const std::vector<double> up = at(h), down = at(-h), half_up = at(0.5 * h), half_down = at(-0.5 * h);
    for (std::size_t m = 0; m < of.size(); ++m) {
      const double slope = (4 * (half_up[m] - half_down[m]) - 0.5 * (up[m] - down[m])) / (3 * h);
      double& first = of[m].first[q];
      if (!std::isfinite(slope) || is_kink(up[m], down[m], half_up[m], half_down[m], of[m].value)) {
        of[m].differentiable[q] = smooth[m] = false;
        first = std::nan("");
      } else if (const double most = std::max({std::fabs(of[m].value), std::fabs(up[m]), std::fabs(down[m])});
                 !(std::fabs(first - slope) <= alike * std::fabs(slope) + rounding(most) / h)) {
        smooth[m] = false;
        first = slope;
      }
    }
  }
  return smooth;
}

/// Second derivatives by dual numbers of dual numbers.
void add_second(const propagation::Experiment& e, std::size_t reading, const std::vector<double>& point,
                std::vector<Derivatives>& of) {
  const std::size_t n = point.size();
  for (Derivatives& d : of) d.second.assign(n * n, 0);
  for (std::size_t row = 0; row < n; row += chunk)
    for (std::size_t column = row; column < n; column += chunk) {
      std::vector<models::Curvature> x, y;
      for (std::size_t q = 0; q < n; ++q) {
        models::Curvature c(point[q]);
        if (q >= column && q < column + chunk) c.v = models::Gradient::variable(point[q], static_cast<int>(q - column));
        if (q >= row && q < row + chunk) c.d[q - row] = models::Gradient(1.0);
        x.push_back(c);
      }
      e.outputs_at(reading, x, y);
      for (std::size_t m = 0; m < of.size(); ++m)
        for (std::size_t i = row; i < std::min(n, row + chunk); ++i)
          for (std::size_t j = column; j < std::min(n, column + chunk); ++j)
            of[m].second[i * n + j] = of[m].second[j * n + i] = y[m].d[i - row].d[j - column];
    }
}

} // namespace

std::vector<Derivatives> differentiate(const propagation::Experiment& e, std::size_t reading,
                                       const std::vector<double>& point, bool second) {
  if (!e.has_gradient() || (second && !e.has_curvature())) return differences(e, reading, point, second);
  const std::size_t n = point.size();
  std::vector<Derivatives> out(e.measurands().size());
  for (Derivatives& d : out) {
    d.first.assign(n, 0);
    d.differentiable.assign(n, true);
  }
  bool kink = false;
  Status status = Status::ok;
  for (std::size_t at = 0; at < n; at += chunk) {
    std::vector<models::Gradient> x(point.begin(), point.end()), y;
    for (std::size_t q = at; q < std::min(n, at + chunk); ++q)
      x[q] = models::Gradient::variable(point[q], static_cast<int>(q - at));
    const auto outcome = e.outputs_at(reading, x, y);
    status = std::max(status, static_cast<Status>(outcome.status));
    kink |= outcome.kink;
    for (std::size_t m = 0; m < out.size(); ++m) {
      out[m].value = y[m].v;
      for (std::size_t q = at; q < std::min(n, at + chunk); ++q) out[m].first[q] = y[m].d[q - at];
    }
  }
  for (Derivatives& d : out) d.status = status;
  if (status != Status::ok) return out;
  const std::vector<bool> smooth = kink ? find_kinks(e, reading, point, out) : std::vector<bool>(out.size(), true);
  if (!second || std::ranges::find(smooth, true) == smooth.end()) return out;
  add_second(e, reading, point, out);
  for (std::size_t m = 0; m < out.size(); ++m)
    if (!smooth[m]) out[m].second.clear();
  return out;
}

Derivatives differentiate(const propagation::Experiment& e, std::size_t reading, std::size_t m,
                          const std::vector<double>& point, bool second) {
  return std::move(differentiate(e, reading, point, second)[m]);
}

} // namespace gumshoe::analysis
