// Displacements of the scanner against independent values: laser_scan_cases.csv (40-digit matrices and bisection, see
// laser_scan_reference.py), the consistent model of Ibaraki et al. 2018, Table 3, and other machines.
#include <catch2/catch.hpp>

#include <cmath>

#include <fmt/format.h>

#include "base/csv.h"
#include "chain/machine.h"
#include "places.h"
#include "propagation/point_table.h"

using namespace gumshoe;

namespace {

const models::Model& scanner() { return *models::find("laser_scan"); }

/// The column of a table of points.
std::vector<double> column(const propagation::PointTable& points, const std::string& name) {
  for (std::size_t c = 0; c < points.columns.size(); ++c)
    if (points.header[points.header.size() - points.columns.size() + c] == name) return points.columns[c];
  return {};
}
std::vector<double> displacements(const models::Model& model, const std::string& text) {
  const auto points = propagation::evaluate_points(model, parse_csv(text, "points.csv"), "");
  for (const std::string& status : points.status) CHECK(status == "ok");
  return column(points, "displacement (mm)");
}

constexpr double pi = 3.14159265358979323846, lines[2][3] = {{71, 70.5, 70}, {68.5, 66.5, 64.5}};

/// Largest minus smallest change of the displacement over the three lines of a surface, um: a value of Table 3.
double spread(const std::string& error, int setup, int surface) {
  // Normal incidence on A; on B the slope is 3.6 deg in rad, as printed, and B stands at -3.6 deg.
  const double slope = surface == 0 ? -0.005 : 3.6 * pi / 180, B = surface == 0 ? std::atan(0.005) : -3.6 * pi / 180;
  const double first = lines[surface][0];
  std::string text = fmt::format("{},workpiece_x (mm),workpiece_y (mm),cone_slope (1),cone_radius (mm),B (rad),C (deg),theta (deg),radius (mm)\n", error);
  for (const double radius : lines[surface])
    for (int theta = 0; theta < 360; ++theta)
      text += fmt::format("0.1,{},{},{:.17g},{},{:.17g},{},{},{}\n", setup == 1 ? 0 : 75.453, setup == 1 ? 0 : -77.898, slope,
                          first, B, theta, theta, radius);
  const auto d = displacements(scanner(), text);
  const auto [low, high] = std::minmax_element(d.begin(), d.end());
  return 1e3 * (*high - *low);
}

chain::MachineDescription machine(std::vector<chain::AxisDescription> workpiece, std::vector<chain::AxisDescription> tool) {
  return {"", std::move(workpiece), std::move(tool)};
}
models::MadeModel on(const chain::MachineDescription& description) {
  std::string why;
  auto made = scanner().on_machine(description, why);
  CHECK(why == "");
  return made;
}

} // namespace

TEST_CASE("displacements match 40-digit references on all five surfaces", "[references][laser_scan]") {
  // Sums and products of lengths up to 0.3 m, divided by slopes of 0.3 at least: some 50 roundings of 2.2e-16 relative.
  constexpr double tolerance = 50 * 2.2e-16 * 300 / 0.3;
  static_assert(tolerance < 1e-9);
  Csv table = read_csv(GUMSHOE_SOURCE_DIR "/tests/references/laser_scan_cases.csv");
  std::vector<double> expected;
  for (auto& row : table.rows) {
    expected.push_back(table.number(row.back()));
    row.pop_back();
  }
  table.header.pop_back();
  const auto points = propagation::evaluate_points(scanner(), table, "");
  const auto found = column(points, "displacement (mm)");
  REQUIRE(found.size() == 100);
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, table.rows[i].back().text);
    CHECK(points.status[i] == "ok");
    CHECK(std::fabs(found[i] - expected[i]) < tolerance);
  }
}

TEST_CASE("Table 3 of Ibaraki et al. 2018, the consistent model", "[references][laser_scan]") {
  // um, of 0.1 mrad or 100 um; matrices and Newton's method in numpy. A cone that stays at the table's centre in set-up 2,
  // as eq (11) is printed, makes 12.6 of E_X0B and 5.7 of e_x; a tilt about the part makes the same as about the table.
  struct Row {
    const char* error;
    double value[4]; ///< set-up 1 A and B, set-up 2 A and B
  };
  const Row rows[] = {{"E_A0B (mrad)", {0, 0, 21.690, 21.690}},
                      {"E_B0B (mrad)", {0.100, 0.401, 21.790, 22.048}},
                      {"E_C0B (mrad)", {0, 0, 0, 0.002}},
                      {"E_A0C_minus_E_A0B (mrad)", {0, 0, 21.690, 21.647}},
                      {"E_X0B (mm)", {0, 0, 0, 0}},
                      {"E_Y0C (mm)", {0, 0, 0, 0}},
                      {"E_X0C_minus_E_X0B (mm)", {0, 0, 0, 0}},
                      {"E_Z0B (mm)", {0, 0, 0, 0}},
                      {"E_C0Y (mrad)", {0, 0, 0, 0.002}},
                      {"E_A0Z (mrad)", {0, 0, 0, 0}},
                      {"E_B0Z (mrad)", {0, 0, 0, 0}},
                      {"e_x (mm)", {1.000, 12.542, 1.000, 12.542}},
                      {"e_y (mm)", {1.000, 12.542, 1.000, 12.542}},
                      {"e_a (mrad)", {14.200, 13.673, 14.200, 13.673}},
                      {"e_b (mrad)", {14.200, 13.673, 14.200, 13.673}}};
  for (const Row& row : rows)
    for (int i = 0; i < 4; ++i) {
      CAPTURE(row.error, i);
      CHECK(std::fabs(spread(row.error, 1 + i / 2, i % 2) - row.value[i]) <= 0.0005 + 1e-9);
    }
}

TEST_CASE("other machines: A and C in the table, both in the head, one in each", "[references][laser_scan]") {
  // 40 digits, laser_scan_reference.py. B at (10, -20, 120) mm, or A; errors of every row of eq (8) in its place.
  const std::array<double, 3> point{10e-3, -20e-3, 120e-3};
  const std::string common = "cone_slope (1),cone_height (mm),workpiece_x (mm),workpiece_y (mm),sensor_length (mm),theta (deg),";
  const auto row = [](int theta, double first, double second, int rotating) {
    return fmt::format("0.0629,20,30,-40,150,{},{},{},0.11,-0.07,0.05,0.2,-0.3,0.15,0.04,-0.25\n", theta,
                       rotating == 0 ? first + theta - 35 : first, rotating == 1 ? second + theta - 35 : second);
  };
  const auto check = [&](const models::MadeModel& model, const std::string& names, double first, double second, int rotating,
                         std::array<double, 2> expected) {
    REQUIRE(model);
    const auto d = displacements(*model, common + names + "\n" + row(35, first, second, rotating) + row(210, first, second, rotating));
    REQUIRE(d.size() == 2);
    CAPTURE(names, d[0], d[1]);
    CHECK(std::fabs(d[0] - expected[0]) < 1e-12);
    CHECK(std::fabs(d[1] - expected[1]) < 1e-12);
  };
  check(on(machine({{.name = "A", .point = point}, {.name = "C"}}, {{.name = "X"}, {.name = "Y"}, {.name = "Z"}})),
        "A (deg),C (deg),E_X0C (mm),E_Y0A (mm),E_Z0A (mm),E_A0A (mrad),E_B0A (mrad),E_C0A (mrad),E_Y0C_minus_E_Y0A "
        "(mm),E_B0C_minus_E_B0A (mrad)",
        3.5, -55, 1, {0.0890446809973592926, 0.0328121221125068741});
  check(on(machine({{.name = "Y"}}, {{.name = "X"}, {.name = "Z"}, {.name = "C"}, {.name = "B", .point = point}})),
        "C (deg),B (deg),E_X0C (mm),E_Y0C (mm),E_Z0B (mm),E_A0C (mrad),E_B0C (mrad),E_C0C (mrad),E_X0B_minus_E_X0C "
        "(mm),E_A0B_minus_E_A0C (mrad)",
        33, -3.5, 0, {-0.0419650766754866062, -0.0438140037051184139});
  check(on(machine({{.name = "C"}}, {{.name = "X"}, {.name = "Y"}, {.name = "Z"}, {.name = "B", .point = point}})),
        "C (deg),B (deg),E_X0C (mm),E_Y0C (mm),E_Z0B (mm),E_A0C (mrad),E_B0C (mrad),E_C0C (mrad),E_X0B (mm),E_A0B (mrad)", 33,
        -3.5, 0, {-0.0369234701798795763, -0.0194859454781097124});
}
