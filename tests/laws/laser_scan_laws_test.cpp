/// Laws of the scanner that hold whatever the numbers are, and its refusals.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/csv.h"
#include "chain/machine.h"
#include "propagation/point_table.h"

using namespace gumshoe;

namespace {

const models::Model& scanner() { return *models::find("laser_scan"); }
constexpr double mm = 1e-3, deg = 3.14159265358979323846 / 180;

propagation::PointTable points(const std::string& text, const std::string& evaluation = "", const models::Model& model = scanner()) {
  return propagation::evaluate_points(model, parse_csv(text, "points.csv"), evaluation);
}
double first(const propagation::PointTable& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.header[table.header.size() - table.columns.size() + c] == name) return table.columns[c][0];
  FAIL("no column " << name);
  return 0;
}
double displacement(const std::string& names, const std::string& values) {
  return first(points(names + "\n" + values + "\n"), "displacement (mm)");
}
/// What is said of one row of values.
std::string refusal(const std::string& names, const std::string& values, const std::string& evaluation = "") {
  const auto table = points(names + "\n" + values + "\n", evaluation);
  return table.impossible.empty() ? "" : table.impossible[0].what;
}
std::string misfit(std::vector<chain::AxisDescription> workpiece, std::vector<chain::AxisDescription> tool,
                   std::vector<std::pair<std::string, double>> errors = {}) {
  std::string why;
  CHECK_FALSE(scanner().on_machine({"", std::move(workpiece), std::move(tool), std::move(errors)}, why));
  return why;
}

} // namespace

TEST_CASE("a surface that is nearer makes a positive displacement, along the beam", "[laws][laser_scan]") {
  // B tilts the table: the beam meets a level plane at B, so a rise of e_z counts e_z / cos B less what B itself moves.
  CHECK(std::fabs(displacement("surface (1),surface_height (mm),e_z (mm)", "1,10,0.1") - 0.1) < 1e-12);
  CHECK(std::fabs(displacement("surface (1),surface_height (mm),e_z (mm),B (deg)", "1,10,0.1,60") - 0.2) < 1e-12);
  CHECK(std::fabs(displacement("surface (1),surface_height (mm),E_Z0B (mm),B (deg)", "1,10,0.1,60") - 0.1) < 1e-12);
  CHECK(std::fabs(displacement("sensor_zero (mm),sensor_gain (1),e_z (mm)", "0.5,0.01,0.1") - 0.601) < 1e-12);
}

TEST_CASE("a tilt acts about the table's origin, a shift of the axes not at all along a plane", "[laws][laser_scan]") {
  // e_a lifts the part by y tan e_a. y = workpiece_y + radius.
  const double lift = displacement("surface (1),workpiece_y (mm),theta (deg),radius (mm),e_a (mrad)", "1,50,90,20,1");
  CHECK(std::fabs(lift - 70 * std::tan(1e-3)) < 1e-9);
  for (const char* error : {"E_X0B", "E_Y0C", "E_X0C_minus_E_X0B", "e_x", "e_y"})
    CHECK(displacement("surface (1)," + std::string(error) + " (mm)", "1,0.3") == 0);
}

TEST_CASE("all surfaces are where their heights say, hollow ones too", "[laws][laser_scan]") {
  for (const char* values : {"0,0.2,0,0", "1,0.1,0.05,0", "2,0,0,80", "3,0,0,80", "4,0,0,20", "2,0,0,-80", "3,0,0,-80", "4,0,0,-20"})
    for (const char* theta : {"0", "77", "200"}) {
      const double d = displacement("surface (1),cone_slope (1),plane_slope_x (1),surface_radius (mm),theta (deg),radius (mm)",
                                    std::string(values) + "," + theta + ",62");
      CAPTURE(values, theta);
      CHECK(std::fabs(d) < 1e-12);
    }
}

TEST_CASE("of two points on a cone the beam takes the nearer one, on the nappe that is there", "[laws][laser_scan]") {
  // At 45 deg, in the plane y = 0: from (70, 0) mm, tilted to within 0.5 deg of a generator, the other side of the cone is
  // metres away; over the apex of a cone that points upwards there is nothing but its tip.
  const std::string names = "cone_slope (1),cone_radius (mm),radius (mm),B (deg),e_z (mm)";
  CHECK(std::fabs(displacement(names, "-1,70,70,45,0.1") - 0.1 / std::sqrt(2.0)) < 1e-12);
  CHECK(std::fabs(displacement(names, "1,70,70,-45,0.1") - 0.1 / std::sqrt(2.0)) < 1e-12);
  CHECK(std::fabs(displacement(names, "-1,70,70,45.5,0") - 0) < 1e-12);
  CHECK(refusal("cone_slope (1),cone_radius (mm),radius (mm),e_x (mm),B (deg)", "-10,1,0,5,88") ==
        "the beam meets only the other nappe of the cone, beyond its tip, where the part has no surface");
}

TEST_CASE("a joint evaluation judges each profile by its extremes and its plane", "[laws][laser_scan]") {
  // Form deviations of 3 + 2 sin theta um at a radius of 50 mm: 4 um from peak to valley, a tilt of 0.04 mrad about X, and
  // nothing left from the plane. A second profile has a bump of 1 um.
  std::string text = "profiles (1),profile (1),theta (deg),C (deg),radius (mm),cone_radius (mm),displacement (mm)\n";
  for (int theta = 0; theta < 360; theta += 30)
    text += "2,1," + std::to_string(theta) + "," + std::to_string(theta) + ",50,50," +
            std::to_string(1e-3 * (3 + 2 * std::sin(theta * deg))) + "\n";
  for (int theta = 0; theta < 360; theta += 30)
    text += "2,2," + std::to_string(theta) + "," + std::to_string(theta) + ",60,50," + (theta == 90 ? "0.001" : "0") + "\n";
  const auto found = points(text, "profile");
  REQUIRE(found.impossible.empty());
  CHECK(std::fabs(first(found, "peak_to_valley_1 (um)") - 4) < 2e-3); // six digits of a millimetre
  CHECK(std::fabs(first(found, "mean_1 (um)") - 3) < 1e-3);
  CHECK(std::fabs(first(found, "tilt_a_1 (mrad)") - 0.04) < 3e-5);
  CHECK(std::fabs(first(found, "tilt_b_1 (mrad)")) < 3e-5);
  CHECK(first(found, "roundness_1 (um)") < 3e-3);
  CHECK(std::fabs(first(found, "peak_to_valley_2 (um)") - 1) < 1e-9);
  CHECK(std::fabs(first(found, "mean_2 (um)") - 1 / 12.0) < 1e-9);
  // The plane takes 1/12 of the bump as its mean and 2/12 as its slope at the bump: 9/12 are left there, and -3/12 beside it
  // at most. By hand, with sum sin^2 = 6: the smallest remainder is -(1/12)(1 + 2 cos 30 deg).
  CHECK(std::fabs(first(found, "roundness_2 (um)") - (9 / 12.0 + (1 + 2 * std::cos(30 * deg)) / 12)) < 1e-9);
}

TEST_CASE("the default machine and the same one described give the same bits", "[laws][laser_scan]") {
  std::string why;
  const auto made = scanner().on_machine(
      {"", std::vector<chain::AxisDescription>{{.name = "B"}, {.name = "C"}},
       std::vector<chain::AxisDescription>{{.name = "X"}, {.name = "Y"}, {.name = "Z"}}, {{"E_A0B", 1e-4}}}, why);
  CHECK(why == "");
  REQUIRE(made);
  const std::string rest = "B (deg),C (deg),theta (deg),e_x (mm),E_Z0B (mm),E_C0B (mrad),c_radial_motion.x_sine (um)\n"
                           "0.28,35,35,0.1,0.02,0.3,4\n-3,190,200,-0.1,0.01,-0.2,2\n";
  const auto here = points("E_A0B (mrad)," + std::string(rest).replace(rest.find("\n0.28"), 1, "\n0.1,").replace(rest.find("\n-3") + 4, 1, "\n0.1,"));
  const auto there = points(rest, "", *made);
  REQUIRE(here.columns.size() == there.columns.size());
  for (std::size_t c = 0; c < here.columns.size(); ++c) CHECK(here.columns[c] == there.columns[c]);
  CHECK(made->card->quantities[10].default_value == 1e-4);
}

TEST_CASE("a machine that the scanner cannot follow is refused", "[laws][laser_scan][machine]") {
  using Axes = std::vector<chain::AxisDescription>;
  const Axes BC{{.name = "B"}, {.name = "C"}}, XYZ{{.name = "X"}, {.name = "Y"}, {.name = "Z"}};
  CHECK(misfit({{.name = "C"}}, XYZ) == "the number of rotary axes is 1, and laser_scan has two");
  CHECK(misfit({{.name = "C"}, {.name = "C2"}}, XYZ) == "the axes C and C2 are parallel, and laser_scan needs two directions");
  CHECK(misfit(BC, {{.name = "X"}, {.name = "Z"}}) == "no slide along Y, and laser_scan moves one");
  CHECK(misfit(BC, {{.name = "X"}, {.name = "Y"}, {.name = "Z"}, {.name = "W"}}) == "two slides along Z, and laser_scan moves one");
  CHECK(misfit({{.name = "B"}, {.name = "X"}, {.name = "C"}}, {{.name = "Y"}, {.name = "Z"}}) ==
        "the slide X is carried by the rotary axis B, and laser_scan moves its slides on the bed");
  CHECK(misfit(BC, XYZ, {{"E_XZ", 1e-6}}) == "E_XZ is no quantity of laser_scan on this machine");
}

TEST_CASE("impossible points are refused in words", "[laws][laser_scan]") {
  CHECK(refusal("radius (mm)", "-1") == "radius is negative");
  CHECK(refusal("speed (deg/s)", "-1") == "speed is negative");
  CHECK(refusal("direction (1)", "2") == "direction must be 1, -1 or 0");
  CHECK(refusal("B_direction (1)", "0.5") == "B_direction must be 1, -1 or 0");
  CHECK(refusal("surface (1)", "5") == "surface must be 0 (cone), 1 (plane), 2 (cylinder), 3 (sphere) or 4 (torus)");
  CHECK(refusal("profile (1)", "0") == "profile must be a whole number from 1 to 12");
  CHECK(refusal("surface (1),radius (mm)", "3,101") == "the surface does not reach as far as the commanded spot");
  CHECK(refusal("surface (1),radius (mm),e_x (mm)", "3,99.9,-5") == "the beam misses the surface");
  CHECK(refusal("surface (1),B (deg)", "1,90") == "the beam misses the surface");
  CHECK(refusal("surface (1),cylinder_azimuth (deg),B (deg),radius (mm)", "2,0,90,0") == "the beam misses the surface");
  const auto joint = [](const std::string& rows) {
    return refusal("profiles (1),profile (1),theta (deg),displacement (mm)", rows, "profile");
  };
  CHECK(joint("1,1,0,0\n1,1,90,0\n1,2,180,0") == "a point belongs to profile 2, but there are 1 (quantity profiles)");
  CHECK(joint("1,1,0,0\n1,1,180,0\n1,1,0,0") == "profile 1 has too few points for a plane: three that are not on a line");
  CHECK(joint("2,1,0,0\n2,1,90,0\n2,1,180,0") == "profile 2 has too few points for a plane: three that are not on a line");
}
