#include "analysis/poincare.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

using std::numbers::pi;
constexpr std::size_t cells = 1000;

/// Masses of nodes and stiffnesses of cells: var g is sum m_j g_j^2 - (sum m_j g_j)^2, and E[g'^2] is
/// sum k_j (g_{j+1} - g_j)^2. Nodes crowd at both ends, where densities vanish or grow without bound.
struct Elements {
  std::vector<double> mass, stiffness;
};

Elements elements_of(const quantities::Distribution& d) {
  const double middle = 0.5 * (d.support_low() + d.support_high()), half = 0.5 * (d.support_high() - d.support_low());
  const auto at = [&](double j) { return middle - half * std::cos(pi * j / cells); };
  const auto between = [&](double a, double b) { return d.probability(b) - d.probability(a); };
  Elements e;
  for (std::size_t j = 0; j <= cells; ++j) {
    const double x = static_cast<double>(j);
    e.mass.push_back(between(at(std::fmax(0, x - 0.5)), at(std::fmin(cells, x + 0.5))));
    if (j == cells) break;
    const double width = at(x + 1) - at(x);
    e.stiffness.push_back(between(at(x), at(x + 1)) / (width * width));
  }
  return e;
}

/// One step of inverse iteration without constants: the flux k_j (h_{j+1} - h_j) of the solution h balances the
/// masses to its left, so no linear system is solved.
std::vector<double> inverse_step(const Elements& e, std::vector<double> g) {
  const auto centre = [&](std::vector<double>& v) {
    double sum = 0, mass = 0;
    for (std::size_t j = 0; j < v.size(); ++j) sum += e.mass[j] * v[j], mass += e.mass[j];
    for (double& x : v) x -= sum / mass;
  };
  centre(g);
  std::vector<double> h(g.size());
  double flux = 0;
  for (std::size_t j = 0; j + 1 < g.size(); ++j) {
    flux += e.mass[j] * g[j];
    h[j + 1] = h[j] - (e.stiffness[j] > 0 ? flux / e.stiffness[j] : 0);
  }
  centre(h);
  return h;
}

double bounded(const quantities::Distribution& d) {
  const Elements e = elements_of(d);
  std::vector<double> g(cells + 1);
  for (std::size_t j = 0; j <= cells; ++j) g[j] = -std::cos(pi * static_cast<double>(j) / cells);
  double constant = 0;
  for (int step = 0; step < 500; ++step) {
    const auto h = inverse_step(e, g);
    double hg = 0, gg = 0;
    for (std::size_t j = 0; j <= cells; ++j) hg += e.mass[j] * h[j] * g[j], gg += e.mass[j] * g[j] * g[j];
    const double next = hg / gg;
    double norm = 0;
    for (std::size_t j = 0; j <= cells; ++j) norm = std::fmax(norm, std::fabs(h[j]));
    for (std::size_t j = 0; j <= cells; ++j) g[j] = h[j] / norm;
    if (step > 3 && std::fabs(next - constant) < 1e-13 * next) return next;
    constant = next;
  }
  return constant;
}

} // namespace

double poincare_constant(const quantities::Distribution& d) {
  using quantities::Family;
  const auto& p = d.parameters;
  switch (d.family) {
  case Family::rectangular:
    return (p[1] - p[0]) * (p[1] - p[0]) / (pi * pi);
  case Family::normal:
    return p[1] * p[1];
  case Family::exponential:
    return 4 * p[0] * p[0];
  case Family::curvilinear_trapezoid:
  case Family::trapezoid:
  case Family::triangular:
  case Family::arcsine:
  case Family::truncated_normal:
    return std::isfinite(d.support_high() - d.support_low()) && d.support_high() > d.support_low() ? bounded(d) : nan;
  default:
    return nan;
  }
}

} // namespace gumshoe::analysis
