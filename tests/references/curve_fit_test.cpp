/// The fit of a characteristic curve: its squares against those of the true flutes and of points about them.
#include <algorithm>
#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "models/tool_length/curve_fit.h"
#include "references/drawn_tools.h"

using namespace gumshoe;
using namespace gumshoe::fixture;

namespace {

/// Readings of a mill whose flutes and phase are known.
struct Set {
  std::vector<std::unique_ptr<TriggerCurve>> curves;
  CurveReadings readings;
  std::vector<double> flutes; ///< H_k, m
  double phase = 0;           ///< m

  double squares(const std::vector<double>& h, double u, const std::vector<bool>& there) const {
    double sum = 0;
    for (std::size_t i = 0; i < readings.readings; ++i) {
      double highest = -1e300;
      for (std::size_t k = 0; k < readings.flutes; ++k) {
        const std::size_t ik = i * readings.flutes + k;
        if (there[k]) highest = std::max(highest, h[k] + readings.curves[ik]->at(readings.lines[ik] + u - h[k]).height);
      }
      sum += (highest - readings.heights[i]) * (highest - readings.heights[i]);
    }
    return sum;
  }
};

/// Mills as in practice: the lowest point of the insert passes the beam, or nearly.
Set drawn_set(Draw& draw, int n, double noise) {
  Set s;
  Insert<double> insert{draw(8, 20) * mm, draw(2, 7) * mm,    draw(2, 4) * mm,
                        15 * deg,         draw(-15, 5) * deg, draw(-8, 8) * deg};
  insert.axis_y = -draw(0.9, 1.03) * std::hypot(insert.tool_radius - insert.radius * std::cos(insert.radial_angle),
                                                insert.radius * std::sin(insert.radial_angle));
  const Beam<double> beam{0, 0, draw(0.1, 0.25) * mm, 0.5};
  const bool differ = n % 5 == 4;
  const std::size_t flutes = static_cast<std::size_t>(1 + n % 4),
                    readings = flutes + 1 + static_cast<std::size_t>(n % 11);
  const double turn = draw(10, 60) * 1e-6;
  for (std::size_t k = 0; k < (differ ? flutes : 1); ++k) {
    if (differ) insert.radius += draw(-20, 20) * 1e-6, insert.axial_angle += draw(-0.01, 0.01);
    const InsertHeight heights(insert, beam);
    if (!heights.ever_covered()) return {};
    s.curves.push_back(std::make_unique<TriggerCurve>(heights, turn / (2 * pi)));
  }
  s.phase = draw(0, turn);
  for (std::size_t k = 0; k < flutes; ++k) s.flutes.push_back(0.2 - draw(0, 1.4) * turn / static_cast<double>(flutes));
  CurveReadings& d = s.readings;
  d.readings = readings, d.flutes = flutes, d.drop = turn / (2 * pi), d.alike = !differ;
  for (std::size_t i = 0; i < readings; ++i) {
    double highest = -1e300;
    for (std::size_t k = 0; k < flutes; ++k) {
      d.curves.push_back(s.curves[differ ? k : 0].get());
      d.lines.push_back(turn * (static_cast<double>(i) / static_cast<double>(readings) +
                                static_cast<double>(k) / static_cast<double>(flutes)));
      highest = std::max(highest, s.flutes[k] + d.curves.back()->at(d.lines.back() + s.phase - s.flutes[k]).height);
    }
    // Between a rectangular and a normal distribution.
    d.heights.push_back(highest + noise * (draw(-1, 1) + draw(-1, 1) + draw(-1, 1)));
  }
  return s;
}

} // namespace

// A minimum is no higher than any other point: neither than the truth, whatever the noise, nor than points about it. A
// descent that is given up too early, or a scan that misses a phase, leaves more. The search is no proof: of 2,000 such
// sets, 10 end in a higher minimum.
TEST_CASE("the squares of a fitted curve are no larger than those of the true flutes and of points about them",
          "[references][tool_length]") {
  Draw draw;
  int fitted = 0, hidden = 0, higher = 0;
  for (int n = 0; n < 200; ++n) {
    const double noise = n % 4 == 0 ? 0 : n % 4 == 1 ? 1e-7 : 5e-7;
    const Set s = drawn_set(draw, n / 4 + 50 * (n % 4), noise);
    if (s.curves.empty()) continue;
    const CurveFit fit = fit_curve(s.readings);
    INFO("set " << n << ", " << s.readings.flutes << " flutes, " << s.readings.readings << " readings");
    REQUIRE(fit.converged);
    const double rounding = 2.5e-21 * static_cast<double>(s.readings.readings);
    const std::vector<bool> all(s.readings.flutes, true);
    // Each flute that is left out may cost ten variances.
    const auto seen = static_cast<std::size_t>(std::count(fit.seen.begin(), fit.seen.end(), true));
    double allowed = 1;
    for (std::size_t shown = s.readings.flutes; shown > seen; --shown)
      if (s.readings.readings > shown + 1) allowed *= 1 + 10 / static_cast<double>(s.readings.readings - shown - 1);
    const std::size_t missing = s.readings.flutes - seen;
    double least = s.squares(s.flutes, s.phase, all);
    for (int point = 0; point < 200 && noise > 0; ++point) {
      auto h = s.flutes;
      for (double& x : h) x += draw(-1, 1) * noise;
      least = std::min(least, s.squares(h, s.phase + draw(-1, 1) * noise, all));
    }
    higher += fit.squares > allowed * least + static_cast<double>(1 + missing) * rounding;
    ++fitted, hidden += missing > 0;
  }
  REQUIRE(fitted > 150);
  REQUIRE(hidden > 20);
  REQUIRE(higher <= 4);
}
