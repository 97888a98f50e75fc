#include "analysis/derivatives.h"

#include <algorithm>
#include <cmath>

#include "analysis/differences.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t chunk = 8;

double plain(const propagation::Experiment& e, std::size_t reading, std::size_t m, const std::vector<double>& point) {
  std::vector<models::Gradient> x(point.begin(), point.end()), y;
  const auto outcome = e.outputs_at(reading, x, y);
  return outcome.status == 0 ? y[m].v : std::nan("");
}

/// At a kink: which quantities the kink concerns, by comparing the slopes on either side.
void one_sided(const propagation::Experiment& e, std::size_t reading, std::size_t m, const std::vector<double>& point,
               Derivatives& d) {
  for (std::size_t q = 0; q < point.size(); ++q) {
    const double h = 1e-6 * std::max(1e-3, std::fabs(point[q]));
    auto up = point, down = point;
    up[q] += h;
    down[q] -= h;
    const double right = (plain(e, reading, m, up) - d.value) / h, left = (d.value - plain(e, reading, m, down)) / h;
    const double scale = std::max({std::fabs(left), std::fabs(right), 1e-9});
    // On a smooth branch the slopes differ by h times the curvature; at a kink by their own size.
    if (!(std::fabs(right - left) < 1e-2 * scale)) {
      d.differentiable[q] = false;
      d.first[q] = std::nan("");
    } else {
      d.first[q] = 0.5 * (left + right);
    }
  }
}

} // namespace

Derivatives differentiate(const propagation::Experiment& e, std::size_t reading, std::size_t m,
                          const std::vector<double>& point, bool second) {
  if (!e.has_gradient() || (second && !e.has_curvature())) return differences(e, reading, m, point, second);
  const std::size_t n = point.size();
  Derivatives d;
  d.first.assign(n, 0);
  d.differentiable.assign(n, true);
  bool kink = false;
  for (std::size_t at = 0; at < n; at += chunk) {
    std::vector<models::Gradient> x(point.begin(), point.end()), y;
    for (std::size_t q = at; q < std::min(n, at + chunk); ++q)
      x[q] = models::Gradient::variable(point[q], static_cast<int>(q - at));
    const auto outcome = e.outputs_at(reading, x, y);
    d.status = std::max(d.status, static_cast<Status>(outcome.status));
    kink |= outcome.kink;
    d.value = y[m].v;
    for (std::size_t q = at; q < std::min(n, at + chunk); ++q) d.first[q] = y[m].d[q - at];
  }
  if (d.status != Status::ok) return d;
  if (kink) {
    one_sided(e, reading, m, point, d);
    return d;
  }
  if (!second) return d;
  d.second.assign(n * n, 0);
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
      for (std::size_t i = row; i < std::min(n, row + chunk); ++i)
        for (std::size_t j = column; j < std::min(n, column + chunk); ++j)
          d.second[i * n + j] = d.second[j * n + i] = y[m].d[i - row].d[j - column];
    }
  return d;
}

} // namespace gumshoe::analysis
