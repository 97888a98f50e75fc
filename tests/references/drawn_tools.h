#pragma once
/// Mills drawn at random, for the tests of their trigger.
#include <random>

#include "base/si.h"
#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::fixture {

using namespace models::tool_length;
using namespace si;

struct Tool {
  std::vector<Flute<double>> flutes;
  Beam<double> beam{0, 0, 0.2 * mm, 0.5};
  InsertMotion motion;
};

/// Tools as they are used and, every other one, stranger ones: narrow views, flanks that show, hidden teeth, drops of
/// nanometres to half a millimetre per turn.
class Draw {
public:
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Tool tool(int n) {
    Tool t;
    const bool strange = n % 2;
    Draw& u = *this;
    const double r = u(8, 20) * mm, radius = strange ? u(0.5, 6) * mm : u(4, 7) * mm, lowest = r - radius;
    Insert<double> insert{r,
                          radius,
                          u(0, 4) * mm,
                          strange ? u(0, 20) * deg : u(11, 20) * deg,
                          u(-15, 15) * deg,
                          strange ? u(-25, 25) * deg : u(-10, 5) * deg};
    insert.thickness = std::min(insert.thickness, 0.9 * radius / std::tan(insert.clearance + 1e-9));
    insert.axis_y = -(strange && n % 8 < 4 ? u(0, 1.2) * r : lowest * (1 + u(-0.2, 0.1)));
    t.beam.radius = u(0.05, 0.4) * mm;
    if (n % 4 > 1) t.beam.fraction = u(0.2, 0.8);
    if (n % 3 == 0) t.beam.yaw = u(-1, 1) * deg, t.beam.pitch = u(-1, 1) * deg;
    const int size = n % 12 + 1;
    for (int k = 0; k < size; ++k) {
      t.flutes.push_back({insert, 2 * pi * k / size, n % 5 ? u(0, 0.02) * mm : 0});
      if (n % 7 != 0) continue; // each its own
      Insert<double>& own = t.flutes.back().insert;
      own.radius += u(-5, 5) * 1e-6, own.tool_radius += u(-5, 5) * 1e-6, own.axial_angle += u(-0.01, 0.01);
      t.flutes.back().azimuth += u(-0.01, 0.01);
    }
    t.motion.drop = std::pow(10, strange ? u(-8, -4.1) : u(-6.5, -5));
    t.motion.start_angle = u(-4, 7);
    t.motion.start_height = n % 16 == 5 ? u(0, 2) : u(-0.02, 0.2) * mm;
    if (n % 9 == 4) t.motion.not_before = u(0, 20);
    return t;
  }

private:
  std::mt19937_64 engine_{4};
};

/// The most that two searches may differ in height: they solve for k to 1e-14 m.
inline constexpr double agreed = 1e-13;

/// Four-flute mills with positive axial angles and the axis well off the beam, so that flanks are in it.
inline Tool leaning_mill(Draw& u) {
  const double r = u(8, 16) * mm, radius = u(4, 6) * mm;
  const Insert<double> insert{
      r, radius, u(2, 4) * mm, u(11, 18) * deg, u(-15, 5) * deg, u(2, 9) * deg, 0, -(r - radius) * u(0.5, 0.95)};
  Tool t;
  for (int k = 0; k < 4; ++k) t.flutes.push_back({insert, 0.5 * pi * k, u(0, 1) * 1e-6});
  t.beam.radius = u(0.1, 0.3) * mm;
  t.motion = {u(0, 2 * pi), u(0.05, 2) * mm, std::pow(10, u(-7.5, -5.5)), 0};
  return t;
}

} // namespace gumshoe::fixture
