#include "tracing/noise/student.h"

#include <cmath>

namespace gumshoe::tracing {

ScaleFound scale_of(const Residuals& r) {
  constexpr double nu = 5;
  double all = 0, scale = 0;
  for (std::size_t i = 0; i < r.share.size(); ++i) {
    scale += r.share[i] * r.square[i];
    all += r.share[i];
  }
  if (!(all > 0 && scale > 0)) return {0, -HUGE_VAL};
  scale /= all;
  constexpr int steps = 40; // each comes closer by half at least
  for (int step = 0; step < steps; ++step) {
    double sum = 0;
    for (std::size_t i = 0; i < r.share.size(); ++i)
      sum += r.share[i] * (nu + 1) / (nu + r.square[i] / scale) * r.square[i];
    scale = sum / all;
  }
  double likelihood = 0;
  for (std::size_t i = 0; i < r.share.size(); ++i)
    likelihood -= r.share[i] * (std::log(scale) + (nu + 1) * std::log1p(r.square[i] / scale / nu));
  return {scale, likelihood};
}

} // namespace gumshoe::tracing
