/// Size and sign of the effects on a scan, against closed forms.
#include <catch2/catch.hpp>

#include <cmath>

#include <fmt/format.h>

#include "base/csv.h"
#include "propagation/point_table.h"

using namespace gumshoe;

namespace {

constexpr double deg = 3.14159265358979323846 / 180;

/// Displacements in um with an effect, less those without it. `rest` stands in both tables.
std::vector<double> change(const std::string& effect, const std::string& size, const std::string& rest, const std::vector<std::string>& rows) {
  const auto read = [&](bool with) {
    std::string text = (with ? effect + "," : "") + rest + "\n";
    for (const std::string& row : rows) text += (with ? size + "," : "") + row + "\n";
    const auto points = propagation::evaluate_points(*models::find("laser_scan"), parse_csv(text, "points.csv"), "");
    for (const std::string& status : points.status) CHECK(status == "ok");
    return points.columns.back();
  };
  auto out = read(true);
  const auto without = read(false);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 1e3 * (out[i] - without[i]);
  return out;
}
double change(const std::string& effect, const std::string& size, const std::string& rest, const std::string& row) {
  return change(effect, size, rest, std::vector<std::string>{row})[0];
}

} // namespace

TEST_CASE("lobes stay with the jaws, form with the part", "[laws][laser_scan][effects]") {
  for (const int theta : {0, 20, 130}) {
    const std::string row = std::to_string(theta) + ",40";
    const double lobes = change("clamping_lobes.cosine (um)", "3", "theta (deg),part_angle (deg)", row),
                 form = change("part_form.sine_3 (um)", "2", "theta (deg),part_angle (deg)", row);
    CHECK(std::fabs(lobes - 3 * std::cos(3 * theta * deg)) < 1e-9);
    CHECK(std::fabs(form - 2 * std::sin(3 * (theta - 40) * deg)) < 1e-9);
  }
}

TEST_CASE("a late sensor sees what lies ahead in the direction of the scan", "[laws][laser_scan][effects]") {
  // A part 0.1 mm off on a cone of slope 0.2, theta = C: the displacement is -m e_x cos(theta) / sqrt(1 + m^2) to first order, at
  // 90 deg/s and 2 ms 0.18 deg ahead.
  const double m = 0.2, ahead = 90 * 2e-3 * deg;
  for (const int direction : {1, -1, 0}) {
    const double found = change("stamp_skew.delay (ms)", "2", "cone_slope (1),B (deg),C (deg),theta (deg),e_x (mm),speed (deg/s),direction (1)",
                                "0.2,-11.309932474,90,90,0.1,90," + std::to_string(direction));
    CHECK(std::fabs(found - direction * 100 * m / std::sqrt(1 + m * m) * std::sin(ahead)) < 2e-3 * 0.062);
  }
}

TEST_CASE("what the sensor adds, and how the axes move the part", "[laws][laser_scan][effects]") {
  CHECK(std::fabs(change("standoff_shift.shift (um)", "7", "sensor_gain (1)", "0.01") - 7) < 1e-9);
  CHECK(std::fabs(change("sensor_nonlinearity.quadratic (um)", "4", "e_z (mm)", "0.5") - 1) < 1e-9);
  CHECK(std::fabs(change("sensor_nonlinearity.cubic (um)", "4", "e_z (mm)", "-0.5") + 0.5) < 1e-9);
  // The spindle grows towards the part; the table rises; each makes the surface nearer.
  CHECK(std::fabs(change("thermal_growth.rate (um/h)", "6", "surface (1),time (s)", "1,7200") - 12) < 1e-9);
  CHECK(std::fabs(change("c_axial_motion.cosine (um)", "2", "surface (1),C (deg)", "1,30") - 2 * std::cos(60 * deg)) < 1e-9);
  // The table that stands at -B turns by 10 arcsec about +Y: a plane of slope tan B is less steep.
  const double turn = 10.0 / 3600 * deg;
  CHECK(std::fabs(change("b_brake_shift.angle (arcsec)", "10", "surface (1),B (deg)", "1,30") + 0.07e6 * turn / std::cos(30 * deg)) < 1e-3);
}

TEST_CASE("Z counts as lowered to every spot", "[laws][laser_scan][effects]") {
  // Half a backlash of 30 um too high, whatever the rotary axes come from: with the part turned below it as well.
  for (const char* directions : {"1,1", "-1,1", "1,-1", "0,-1"})
    CHECK(std::fabs(change("z_reversal.backlash (um)", "30",
                           "sensor_gain (1),surface (1),B (deg),direction (1),B_direction (1)",
                           fmt::format("0.01,1,20,{}", directions)) +
                    1.01 * 15) < 1e-9);
}

TEST_CASE("an axis that lags leaves the table behind its command, and a gear ratio turns it further", "[laws][laser_scan][effects]") {
  // The table turns by minus the command. A table that is delta further about +Z than it should be shows a plane of slope m,
  // at radius r and theta, where theta - delta was: nearer by m r (cos(theta - delta) - cos theta).
  const double m = 0.2, r = 60e3;
  const auto nearer = [&](double theta, double delta) { return m * r * (std::cos(theta - delta) - std::cos(theta)); };
  const std::string at = "surface (1),plane_slope_x (1),radius (mm),theta (deg),C (deg),direction (1)";
  for (const int direction : {1, -1, 0}) {
    const double lag = direction * 50.0 / 3600 * deg;
    const double found = change("c_axis_reversal.backlash (arcsec)", "100", at, "1,0.2,60,70,30," + std::to_string(direction));
    CHECK(std::fabs(found - nearer(70 * deg, lag)) < 1e-9);
  }
  const double found = change("c_scale.scale (um/m)", "200", at, "1,0.2,60,70,30,1");
  CHECK(std::fabs(found - nearer(70 * deg, -200e-6 * 30 * deg)) < 1e-9);
  // About Y the same error is one of location: half the reversal value is E_B0B, of the table that stands at -B.
  const std::string tilted = "surface (1),plane_slope_x (1),radius (mm),theta (deg),B (deg),B_direction (1)", row = "1,0.2,60,50,10,";
  for (const int direction : {1, -1}) {
    const std::string side = std::to_string(direction);
    CHECK(std::fabs(change("b_axis_reversal.backlash (arcsec)", "100", tilted, row + side) -
                    change("E_B0B (arcsec)", std::to_string(50 * direction), tilted, row + side)) < 1e-9);
  }
  CHECK(std::fabs(change("b_scale.scale (um/m)", "200", tilted, row + "1") -
                  change("E_B0B (mrad)", fmt::format("{}", -0.2 * 10 * deg), tilted, row + "1")) < 1e-9);
}
