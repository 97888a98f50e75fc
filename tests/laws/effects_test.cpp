/// Each effect against the size and sign that its card and the literature state.
#include <catch2/catch.hpp>

#include "effects/effect.h"
#include "models/rod_gauging/rod_gauging.h"

using namespace gumshoe;
namespace rod = gumshoe::models::rod_gauging;

namespace {

constexpr double deg = std::numbers::pi / 180, um = 1e-6;

/// Change of the indication when one effect takes the given values.
double shift(const std::string& effect, const std::vector<double>& values, const std::vector<double>& condition,
             double pitch = 0.2836 * deg, double azimuth = 144.086 * deg) {
  const std::vector<double> q{5e-3, 3e-5, 88.041 * deg, azimuth, 0.160, 0, 0, pitch, 2e-4, 0.5, -0.5};
  std::size_t index = 0;
  while (effects::cards()[index]->name != effect) ++index;
  const std::vector<effects::Active> active{{index, 0}};
  const auto read = [&](std::span<const effects::Active> a) {
    const rod::At<double> at{models::named<rod::Rows::Quantities>(q.data()),
                             models::named<rod::Rows::Conditions>(condition.data()),
                             {a, values.data()},
                             rod::full,
                             true};
    models::Outcome<double> outcome;
    return rod::RodGauging::simulate(at, rod::RodGauging::solve(at, outcome), outcome).indications.spindle_z;
  };
  return read(active) - read({});
}

const std::vector<double> slow{4e-3 / 60, 0, -1};

} // namespace

TEST_CASE("trigger latency lowers the reading by feed times delay", "[effects]") {
  // 4 mm/min and 1 ms: 0.0667 um; 1000 mm/min: 16.7 um.
  REQUIRE(shift("trigger_latency", {1e-3}, slow) == Approx(-4e-3 / 60 * 1e-3).epsilon(1e-8));
  REQUIRE(shift("trigger_latency", {1e-3}, {1.0 / 60, 0, -1}) == Approx(-16.6667 * um).epsilon(1e-5));
  REQUIRE(shift("trigger_latency", {1e-3}, {1.0 / 60, 0, 1}) == Approx(16.6667 * um).epsilon(1e-5));
}

TEST_CASE("the rod expands by 1.8 um per kelvin at 160 mm", "[effects]") {
  REQUIRE(shift("rod_expansion", {11.5e-6, 1}, slow) == Approx(1.84 * um).epsilon(1e-6));
}

TEST_CASE("half the backlash by the side of approach", "[effects]") {
  REQUIRE(shift("z_reversal", {4 * um}, slow) == Approx(-2 * um).epsilon(1e-8));
  REQUIRE(shift("z_reversal", {4 * um}, {4e-3 / 60, 0, 1}) == Approx(2 * um).epsilon(1e-8));
}

TEST_CASE("the positioning error grows with commanded Z", "[effects]") {
  // E_ZZ is actual minus commanded: at Z near -340 mm and 10 um/m the command is 3.4 um above the actual position.
  const double z = -0.5 + 0.160;
  REQUIRE(shift("z_scale", {10e-6}, slow) == Approx(-10e-6 * z).epsilon(1e-3));
}

TEST_CASE("thermal growth: steady and first-order", "[effects]") {
  REQUIRE(shift("thermal_growth", {5 * um / 3600, 0, 1800}, {4e-3 / 60, 7200, -1}) == Approx(10 * um).epsilon(1e-8));
  REQUIRE(shift("thermal_growth", {0, 20 * um, 1800}, {4e-3 / 60, 1800, -1}) ==
          Approx(20 * um * (1 - std::exp(-1.0))).epsilon(1e-8));
  REQUIRE(shift("thermal_growth", {0, 20 * um, 1800}, {4e-3 / 60, 0, -1}) == Approx(0).margin(1e-16));
}

TEST_CASE("an offset along a pitched beam moves its height by 4.95 um per mm", "[effects]") {
  REQUIRE(shift("beam_offset", {1e-3, 0}, slow) == Approx(4.95 * um).epsilon(1e-3));
  // Across, the beam sees the oblique bottom of rod 2 off its axis, at -y: the edge's slope cot(phi) sin(-tau)
  // moves the height by +slope y, the half-ellipse's curvature by -depth y^2 / (2 rho^2), to within the fillet's share
  // of the radius.
  const double y = 1e-4, phi = 88.041 * deg, tau = 144.086 * deg, pitch = 0.2836 * deg, rho = 5e-3 - 3e-5;
  const double slope = std::sin(-tau) / std::tan(phi);
  const double depth = rho * std::fabs(std::tan(pitch) + std::cos(-tau) / std::tan(phi));
  REQUIRE(shift("beam_offset", {0, y}, slow) == Approx(slope * y - depth * y * y / (2 * rho * rho)).epsilon(1e-3));
}

TEST_CASE("run-out turns with the holder, an offset does not", "[effects]") {
  REQUIRE(shift("rod_runout", {1e-3 * 0.5, 0}, slow) ==
          Approx(shift("beam_offset", {1e-3 * 0.5, 0}, slow)).epsilon(1e-12));
}

TEST_CASE("a longer seat raises the reading", "[effects]") {
  REQUIRE(shift("reclamp", {3 * um}, slow) == Approx(3 * um).epsilon(1e-8));
}
