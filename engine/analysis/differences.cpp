#include "analysis/differences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "analysis/gum.h"
#include "analysis/reach.h"
#include "base/special_values.h"

namespace gumshoe::analysis {
namespace {

using Point = std::vector<double>;

/// Collects the points of a stencil as shifts from its centre, which is the first.
struct Stencil {
  std::size_t add(std::vector<propagation::Change> shifts) {
    points.push_back({std::move(shifts)});
    return points.size() - 1;
  }
  std::vector<propagation::Variation> points{{}};
};

struct Line {
  std::size_t up, down, half_up, half_down; ///< points at +h, -h, +h/2, -h/2
};

/// Where the model is evaluated, and by which point each derivative is found.
struct Places {
  Stencil stencil;
  std::vector<Line> lines;          ///< by quantity
  std::vector<std::size_t> corners; ///< [i][j], i < j: first of ++ +- -+ --
};

Places places(const std::vector<double>& h, bool second) {
  const std::size_t n = h.size();
  Places out;
  Stencil& stencil = out.stencil;
  out.lines.resize(n);
  for (std::size_t q = 0; q < n; ++q)
    if (h[q] > 0)
      out.lines[q] = {stencil.add({{q, h[q]}}), stencil.add({{q, -h[q]}}), stencil.add({{q, 0.5 * h[q]}}),
                      stencil.add({{q, -0.5 * h[q]}})};
  if (!second) return out;
  out.corners.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      if (h[i] == 0 || h[j] == 0) continue;
      out.corners[i * n + j] = stencil.add({{i, h[i]}, {j, h[j]}});
      stencil.add({{i, h[i]}, {j, -h[j]}});
      stencil.add({{i, -h[i]}, {j, h[j]}});
      stencil.add({{i, -h[i]}, {j, -h[j]}});
    }
  return out;
}

/// Derivatives of one measurand from its values f(place) at the stencil.
template <class Value>
Derivatives of_values(const Value& f, const Places& at, const std::vector<double>& h, bool second) {
  const std::size_t n = h.size();
  const auto& lines = at.lines;
  Derivatives d;
  d.exact = false;
  d.value = f(0);
  d.first.assign(n, nan);
  d.differentiable.assign(n, true);
  if (!std::isfinite(d.value)) {
    d.status = Status::model_failed;
    return d;
  }
  bool smooth = true;
  // Rounding within the model looks like a kink where q does nothing: changes so much smaller than the largest are none.
  constexpr double negligible = 1e-8;
  double largest = 0;
  for (std::size_t q = 0; q < n; ++q)
    if (h[q] > 0) largest = std::fmax(largest, std::fabs(f(lines[q].up) - d.value));
  std::vector<double> curvature(n, nan), third(n, nan);
  for (std::size_t q = 0; q < n; ++q) {
    if (h[q] == 0) continue;
    const double up = f(lines[q].up), down = f(lines[q].down), half_up = f(lines[q].half_up),
                 half_down = f(lines[q].half_down);
    const auto rounds_away = [&](double x) { return std::fabs(x - d.value) <= rounding(d.value); };
    if (rounds_away(up) && rounds_away(down) && rounds_away(half_up) && rounds_away(half_down)) { // what q does cancels
      d.first[q] = curvature[q] = third[q] = 0;
      continue;
    }
    const double whole = (up - down) / (2 * h[q]), half = (half_up - half_down) / h[q];
    d.first[q] = (4 * half - whole) / 3;
    third[q] = 8 * (whole - half) / (h[q] * h[q]);
    const double bent = (up - 2 * d.value + down) / (h[q] * h[q]),
                 half_bent = 4 * (half_up - 2 * d.value + half_down) / (h[q] * h[q]);
    curvature[q] = (4 * half_bent - bent) / 3;
    const bool seen = std::max(std::fabs(up - d.value), std::fabs(down - d.value)) > negligible * largest;
    if (!std::isfinite(d.first[q]) || (seen && is_kink(up, down, half_up, half_down, d.value))) {
      d.differentiable[q] = smooth = false;
      d.first[q] = nan;
    }
  }
  if (!second || !smooth) return d;
  d.second.assign(n * n, 0);
  d.third.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (h[i] == 0) continue;
    d.second[i * n + i] = curvature[i];
    d.third[i * n + i] = third[i];
    for (std::size_t j = i + 1; j < n; ++j) {
      if (h[j] == 0) continue;
      const std::size_t c = at.corners[i * n + j];
      const double pp = f(c), pm = f(c + 1), mp = f(c + 2), mm = f(c + 3);
      d.second[i * n + j] = d.second[j * n + i] = (pp - pm - mp + mm) / (4 * h[i] * h[j]);
      // d^3 f / dx_i dx_j^2: the curvature by j, differenced by i; and the other way round.
      const auto of = [&](double above, double below, std::size_t a, std::size_t b) {
        return (above - 2 * (f(lines[a].up) - f(lines[a].down)) + below) / (2 * h[a] * h[b] * h[b]);
      };
      d.third[i * n + j] = of(pp - mp, pm - mm, i, j);
      d.third[j * n + i] = of(pp - pm, mp - mm, j, i);
    }
  }
  return d;
}

std::vector<Derivatives> of_responses(const propagation::Responses& all, const Places& at, const std::vector<double>& h,
                                      std::size_t measurands, bool second) {
  std::vector<Derivatives> out;
  for (std::size_t m = 0; m < measurands; ++m) {
    const auto f = [&](std::size_t i) {
      return all.status[i] == Status::ok ? all.at(i, m) : std::numeric_limits<double>::quiet_NaN();
    };
    out.push_back(of_values(f, at, h, second));
  }
  return out;
}

/// Whether a budget at a reading may have terms of second order: for few and independent inputs. Correlated inputs may
/// move only one of several measurands.
bool needs_second(const propagation::Experiment& e, std::size_t reading) {
  std::vector<double> u(e.columns_at(reading).size(), 0.0);
  std::vector<bool> reaches(e.plan().variates.size(), false);
  for (const auto& [v, moved] : variates_reaching(e, reading)) {
    const double of_variate = e.plan().variates[v].distribution.standard_uncertainty();
    for (const std::size_t q : moved) u[q] = std::hypot(u[q], of_variate);
    if (e.measurands().size() == 1 && moved.size() > 1 && of_variate > 0) return false;
    reaches[v] = true;
  }
  for (const auto& group : e.plan().copulas)
    if (e.measurands().size() == 1 &&
        std::ranges::count_if(group.variates, [&](std::size_t v) { return reaches[v]; }) > 1)
      return false;
  return has_second_order(u);
}

} // namespace

std::vector<double> steps(const propagation::Experiment& e, std::size_t reading, const Point& point) {
  const auto& plan = e.plan();
  const auto& columns = e.columns_at(reading);
  std::vector<double> h(point.size(), 0.0);
  for (std::size_t q = 0; q < point.size(); ++q) {
    for (const std::size_t v : plan.columns[columns[q]].variates) {
      const auto& d = plan.variates[v].distribution;
      h[q] = std::hypot(h[q], d.standard_uncertainty());
    }
    if (h[q] == 0) continue;
    if (const std::size_t of = plan.columns[columns[q]].quantity; e.layout().model.contains(of)) {
      const gumshoe::Limits& limits = e.model().card->quantities[of].limits;
      const double room = std::min(point[q] - limits.low, limits.high - point[q]);
      if (room > 0) h[q] = std::min(h[q], 0.999 * room);
    }
    h[q] = std::exp2(std::floor(std::log2(h[q]))); // point + step - point is then the step again, mostly
  }
  return h;
}

double rounding(double value) { return 64 * std::numeric_limits<double>::epsilon() * std::fabs(value); }

bool is_kink(double up, double down, double half_up, double half_down, double f0) {
  const double full = std::fabs(up - 2 * f0 + down), half = 2 * std::fabs(half_up - 2 * f0 + half_down);
  const double size = std::max(std::fabs(up - f0), std::fabs(down - f0));
  return half > 0.75 * full && half > 0.01 * size && half > rounding(f0);
}

std::vector<Derivatives> differences(const propagation::Experiment& e, std::size_t reading, const Point& point,
                                     bool second) {
  const std::vector<double> h = steps(e, reading, point);
  const Places at = places(h, second);
  return of_responses(e.outputs_at(reading, point, at.stencil.points), at, h, e.measurands().size(), second);
}

bool stencils_at_estimates(const propagation::Experiment& e) {
  return !e.has_gradient() && e.scenario().method != scenario::Method::virtual_experiment;
}

propagation::Work stencil_work(const propagation::Experiment& e, std::size_t reading) {
  const auto places_there =
      std::make_shared<const Places>(places(steps(e, reading, e.point(reading)), needs_second(e, reading)));
  const std::size_t rows = e.measurands().size(), liked = e.model().block;
  constexpr std::size_t few = 256;
  return {.name = "derivatives " + std::to_string(reading),
          .units = places_there->stencil.points.size(),
          .values = rows + 1,
          .together = liked > 0 ? liked : few,
          .compute = [&e, reading, places_there, rows](std::uint64_t first, std::uint64_t last, double* out) {
            const auto some = std::span(places_there->stencil.points).subspan(first, last - first);
            const propagation::Responses r = e.outputs_at(reading, e.point(reading), some);
            for (std::size_t i = 0; i < some.size(); ++i) {
              out[i * (rows + 1)] = static_cast<double>(r.status[i]);
              std::copy_n(&r.values[i * rows], rows, &out[i * (rows + 1) + 1]);
            }
          }};
}

propagation::Responses stencil_values(const propagation::Experiment& e, std::size_t reading,
                                      const propagation::Workers& workers) {
  propagation::Responses all{e.measurands().size(), {}, {}};
  workers.run(stencil_work(e, reading), [&](std::uint64_t first, std::uint64_t last, const double* values) {
    for (std::uint64_t i = first; i < last; ++i, values += all.rows + 1) {
      all.status.push_back(static_cast<Status>(values[0]));
      all.values.insert(all.values.end(), values + 1, values + 1 + all.rows);
    }
  });
  return all;
}

std::vector<Derivatives> differences_from(const propagation::Responses& values, const propagation::Experiment& e,
                                          std::size_t reading, bool second) {
  const Point point = e.point(reading);
  const std::vector<double> h = steps(e, reading, point);
  const Places at = places(h, second);
  if (values.status.size() < at.stencil.points.size()) return differences(e, reading, point, second);
  return of_responses(values, at, h, e.measurands().size(), second);
}

} // namespace gumshoe::analysis
