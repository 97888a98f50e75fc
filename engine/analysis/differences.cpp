#include "analysis/differences.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gumshoe::analysis {
namespace {

using Point = std::vector<double>;

/// A full step of one standard uncertainty (the scale of a t without one), short of the quantity's limits; 0: does not
/// vary.
std::vector<double> steps(const propagation::Experiment& e, std::size_t reading, const Point& point) {
  const auto& plan = e.plan();
  const auto& columns = e.columns_at(reading);
  std::vector<double> h(point.size(), 0.0);
  for (std::size_t q = 0; q < point.size(); ++q) {
    for (const std::size_t v : plan.columns[columns[q]].variates) {
      const auto& d = plan.variates[v].distribution;
      const double u2 = d.variance();
      h[q] = std::hypot(h[q], std::isfinite(u2) ? std::sqrt(u2) : d.parameters[1]);
    }
    if (h[q] == 0) continue;
    if (const std::size_t of = plan.columns[columns[q]].quantity; of < e.model_quantities()) {
      const Limits& limits = e.model().card->quantities[of].limits;
      const double room = std::min(point[q] - limits.low, limits.high - point[q]);
      if (room > 0) h[q] = std::min(h[q], 0.999 * room);
    }
    h[q] = std::exp2(std::floor(std::log2(h[q]))); // point + step - point is then the step again, mostly
  }
  return h;
}

/// Collects the points of a stencil, then finds their values by the shifts that made them.
class Stencil {
public:
  explicit Stencil(const Point& centre) : points{centre} {}
  std::size_t add(std::size_t q, double by) {
    points.push_back(points.front());
    points.back()[q] += by;
    return points.size() - 1;
  }
  std::size_t add(std::size_t q, double by, std::size_t p, double also) {
    const std::size_t i = add(q, by);
    points[i][p] += also;
    return i;
  }
  std::vector<Point> points;
};

struct Line {
  std::size_t up, down, half_up, half_down; ///< points at +h, -h, +h/2, -h/2
};

/// Whether the slopes on either side of the point differ by a kink: on a smooth branch their difference halves with
/// the step, at a kink it stays.
bool is_kink(double up, double down, double half_up, double half_down, double f0) {
  const double full = std::fabs(up - 2 * f0 + down), half = 2 * std::fabs(half_up - 2 * f0 + half_down);
  const double size = std::max(std::fabs(up - f0), std::fabs(down - f0));
  const double noise = 64 * std::numeric_limits<double>::epsilon() * std::fabs(f0);
  return half > 0.75 * full && half > 0.01 * size && half > noise;
}

} // namespace

namespace {

/// Of a joint evaluation: points hold values of the plan's columns.
std::vector<double> joint_values(const propagation::Experiment& e, const std::vector<Point>& points) {
  const std::size_t count = points.size(), n = (count + 7) / 8 * 8, width = points.front().size();
  const std::size_t outputs = e.outputs().size();
  std::vector<double> columns(width * n), values(outputs * n), out;
  std::vector<const double*> pointers;
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t i = 0; i < n; ++i) columns[c * n + i] = points[std::min(i, count - 1)][c];
    pointers.push_back(&columns[c * n]);
  }
  std::vector<std::uint8_t> status(n);
  propagation::Workspace w;
  e.run_columns(pointers, n, w, values.data(), status.data());
  for (std::size_t o = 0; o < outputs; ++o)
    out.insert(out.end(), values.begin() + static_cast<std::ptrdiff_t>(o * n),
               values.begin() + static_cast<std::ptrdiff_t>(o * n + count));
  return out;
}

} // namespace

std::vector<double> values_at(const propagation::Experiment& e, std::size_t reading, const std::vector<Point>& points) {
  if (e.joint()) return joint_values(e, points);
  const ModelCard& card = *e.model().card;
  const std::size_t count = points.size(), n = (count + 7) / 8 * 8, width = points.front().size();
  std::vector<double> columns(width * n), values(card.measurands.size() * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t q = 0; q < width; ++q) columns[q * n + i] = points[std::min(i, count - 1)][q];
  for (const propagation::StatedSize& s : e.stated())
    for (std::size_t i = 0; i < n; ++i)
      columns[(e.first_indication() + s.indication) * n + i] -= columns[s.quantity * n + i] * (*s.loading)[reading];
  std::vector<models::Column> inputs, conditions;
  for (std::size_t q = 0; q < width; ++q) inputs.push_back({&columns[q * n], 1});
  for (const double& c : e.scenario().readings[reading].conditions) conditions.push_back({&c, 0});
  std::vector<double*> measurands;
  for (std::size_t m = 0; m < card.measurands.size(); ++m) measurands.push_back(&values[m * n]);
  std::vector<std::uint8_t> status(n, 0);
  const std::size_t itself = 0;
  models::BlockCall call;
  call.samples = n;
  call.readings = 1;
  call.quantities = inputs.data();
  call.effects = inputs.data() + e.model_quantities();
  call.effect_quantities = e.effect_quantities();
  call.active = e.active();
  call.conditions = conditions.data();
  call.indications = inputs.data() + e.first_indication();
  call.measurands = measurands.data();
  call.solved_as = &itself;
  call.status = status.data();
  call.evaluation = static_cast<int>(e.evaluation());
  call.context = e.model().context;
  e.model().kernels()->evaluate(call);
  std::vector<double> out;
  for (std::size_t m = 0; m < card.measurands.size(); ++m)
    for (std::size_t i = 0; i < count; ++i)
      out.push_back(status[i] == 0 ? values[m * n + i] : std::numeric_limits<double>::quiet_NaN());
  return out;
}

Derivatives differences(const propagation::Experiment& e, std::size_t reading, std::size_t m, const Point& point,
                        bool second) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = point.size();
  const std::vector<double> h = steps(e, reading, point);
  Stencil stencil(point);
  std::vector<Line> lines(n);
  for (std::size_t q = 0; q < n; ++q)
    if (h[q] > 0)
      lines[q] = {stencil.add(q, h[q]), stencil.add(q, -h[q]), stencil.add(q, 0.5 * h[q]), stencil.add(q, -0.5 * h[q])};
  std::vector<std::size_t> corners(n * n, 0); // [i][j], i < j: first of ++ +- -+ --
  if (second)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        if (h[i] == 0 || h[j] == 0) continue;
        corners[i * n + j] = stencil.add(i, h[i], j, h[j]);
        stencil.add(i, h[i], j, -h[j]);
        stencil.add(i, -h[i], j, h[j]);
        stencil.add(i, -h[i], j, -h[j]);
      }
  const std::vector<double> all = values_at(e, reading, stencil.points);
  const auto f = [&](std::size_t i) { return all[m * stencil.points.size() + i]; };

  Derivatives d;
  d.exact = false;
  d.value = f(0);
  d.first.assign(n, nan);
  d.differentiable.assign(n, true);
  if (!std::isfinite(d.value)) {
    d.status = code(Status::model_failed);
    return d;
  }
  bool smooth = true;
  std::vector<double> curvature(n, nan), third(n, nan);
  for (std::size_t q = 0; q < n; ++q) {
    if (h[q] == 0) continue;
    const double up = f(lines[q].up), down = f(lines[q].down), half_up = f(lines[q].half_up),
                 half_down = f(lines[q].half_down);
    const double whole = (up - down) / (2 * h[q]), half = (half_up - half_down) / h[q];
    d.first[q] = (4 * half - whole) / 3;
    third[q] = 8 * (whole - half) / (h[q] * h[q]);
    const double bent = (up - 2 * d.value + down) / (h[q] * h[q]),
                 half_bent = 4 * (half_up - 2 * d.value + half_down) / (h[q] * h[q]);
    curvature[q] = (4 * half_bent - bent) / 3;
    if (!std::isfinite(d.first[q]) || is_kink(up, down, half_up, half_down, d.value)) {
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
      const std::size_t at = corners[i * n + j];
      const double pp = f(at), pm = f(at + 1), mp = f(at + 2), mm = f(at + 3);
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

} // namespace gumshoe::analysis
