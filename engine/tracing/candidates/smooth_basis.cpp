#include "tracing/candidates/smooth_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gumshoe::tracing {
namespace {

/// Time as it is within the training readings, and at their ends beyond them: no curve says how it goes on.
Covariate within_training(const Observations& o, Covariate c) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t r = 0; r < o.readings; ++r)
    if (o.held_out.empty() || !o.held_out[r]) low = std::min(low, c.value[r]), high = std::max(high, c.value[r]);
  for (double& x : c.value) x = std::clamp(x, low, high);
  std::erase_if(c.levels, [&](double x) { return x < low || x > high; });
  return c;
}

} // namespace

Vector over_the_range(const Observations& o, const Covariate& c) {
  const double low = c.levels.front(), range = c.levels.back() - low;
  Vector x(index(o.readings));
  for (std::size_t i = 0; i < o.readings; ++i) x[index(i)] = (c.value[o.sequence[i]] - low) / range;
  return x;
}
Vector scaled(const Observations& o, const Covariate& c) {
  const double low = c.levels.front(), high = c.levels.back();
  Vector x(index(o.readings));
  for (std::size_t i = 0; i < o.readings; ++i) x[index(i)] = 2 * (c.value[o.sequence[i]] - low) / (high - low) - 1;
  return x;
}
Vector plain(const Observations& o, const Covariate& c) {
  Vector x(index(o.readings));
  for (std::size_t i = 0; i < o.readings; ++i) x[index(i)] = c.value[o.sequence[i]];
  return x;
}

Matrix smooth_basis(const Observations& o, const Covariate& all, int most) {
  const auto n = index(o.readings);
  const Covariate c = all.course && !all.comes_back ? within_training(o, all) : all;
  const Vector raw = plain(o, c), x = scaled(o, c);
  if (static_cast<int>(c.levels.size()) <= most + 1) {
    Matrix out = Matrix::Zero(n, index(c.levels.size()) - 1);
    for (Index i = 0; i < n; ++i)
      for (std::size_t l = 1; l < c.levels.size(); ++l)
        if (raw[i] == c.levels[l]) out(i, index(l) - 1) = 1;
    return out;
  }
  if (c.angle && c.levels.back() - c.levels.front() > 1.5 * std::numbers::pi) {
    Matrix out(n, 2 * ((most + 1) / 2));
    for (Index h = 0; h < out.cols() / 2; ++h) {
      out.col(2 * h) = (raw.array() * static_cast<double>(h + 1)).cos();
      out.col(2 * h + 1) = (raw.array() * static_cast<double>(h + 1)).sin();
    }
    return out;
  }
  // Truncated powers: x, x^2, x^3, then (x - knot)^3 at even shares of the levels.
  Matrix out(n, most);
  for (Index j = 0; j < most; ++j) {
    if (j < 3) {
      out.col(j) = x.array().pow(static_cast<int>(j) + 1);
      continue;
    }
    const std::size_t at = c.levels.size() * index(j - 2) / index(most - 2);
    const double knot = 2 * (c.levels[at] - c.levels.front()) / (c.levels.back() - c.levels.front()) - 1;
    out.col(j) = (x.array() - knot).max(0).cube();
  }
  return out;
}

} // namespace gumshoe::tracing
