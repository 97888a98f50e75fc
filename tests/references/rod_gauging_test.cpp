// The engine's rod-gauging solve against independent values: rod_cases.csv (30-digit quadrature, see
// rod_reference.py), the brute-force twin (rod_brute_force.h), and the recomputed tables of Fang 2022.
#include "models/rod_gauging/shadow/shadow.h"
#include "references/rod_brute_force.h"
#include "places.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace {

using gumshoe::models::laser_setter::Beam;
using gumshoe::models::rod_gauging::Rod;
using gumshoe::Status;
using gumshoe::references::brute_force_bottom_height;
using gumshoe::references::Construction;
using gumshoe::references::RodCase;

constexpr double mm = 1e-3, degree = std::numbers::pi / 180;
// Demanded of the engine: 1e-9 mm for every valid input. The references are good to 1e-12 mm, and angles
// in double precision move a bottom 100 mm high by less than 1e-16 m.
constexpr double tolerance = 1e-12;

struct ReferenceRow {
  std::string text; ///< as in the file, for failure messages
  RodCase rod;      ///< SI
  double height;    ///< m; not a number where never covered
  bool covered;
};

std::vector<ReferenceRow> reference_rows() {
  std::ifstream file(GUMSHOE_SOURCE_DIR "/tests/references/rod_cases.csv");
  REQUIRE(file);
  std::string line;
  std::getline(file, line);
  REQUIRE(line == "rod_radius (mm),fillet_radius (mm),bottom_elevation (deg),bottom_azimuth (deg),holder_angle (deg),"
                  "beam_yaw (deg),beam_pitch (deg),beam_radius (mm),trigger_fraction (1),rod_length (mm),"
                  "bottom_height (mm),status");
  std::vector<ReferenceRow> rows;
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    REQUIRE(cells.size() == 12);
    const auto number = [&cells](int i) { return std::stod(cells[static_cast<std::size_t>(i)]); };
    const bool covered = cells[11] == "ok";
    if (!covered) REQUIRE(cells[11] == "never_covered");
    const RodCase rod{number(0) * mm,     number(1) * mm,     number(2) * degree,
                      number(3) * degree, number(4) * degree, number(5) * degree,
                      number(6) * degree, number(7) * mm,     number(8)};
    rows.push_back({line, rod, covered ? number(10) * mm : std::nan(""), covered});
  }
  return rows;
}

auto engine_height(const RodCase& c) {
  const Rod<double> rod{c.rod_radius, c.fillet_radius, c.bottom_elevation, c.bottom_azimuth + c.holder_angle};
  const Beam<double> beam{c.beam_yaw, c.beam_pitch, c.beam_radius, c.fraction};
  return gumshoe::models::rod_gauging::trigger_height(rod, beam);
}

} // namespace

TEST_CASE("trigger heights match 30-digit references", "[references][rod_gauging]") {
  const auto rows = reference_rows();
  std::size_t covered = 0;
  for (const auto& row : rows) {
    CAPTURE(row.text);
    const auto solved = engine_height(row.rod);
    if (!row.covered) {
      CHECK(solved.status == Status::never_covered);
      continue;
    }
    ++covered;
    CHECK(solved.status == Status::ok);
    CHECK(std::abs(solved.value - row.height) < tolerance);
  }
  CHECK(covered >= 150);
  CHECK(rows.size() - covered >= 10);
}

TEST_CASE("trigger heights match the brute-force twin", "[references][rod_gauging]") {
  // The twin's polygon lies inside the shadow: it is never above the truth by more than rounding, and below
  // it by no more than its own bound. A missing fillet shows (0.15 um), and so does a wrong sign of a tilt.
  constexpr int samples = 8192;
  constexpr double rounding = 1e-13;
  const auto rows = reference_rows();
  for (std::size_t i = 0; i < rows.size(); i += 8) {
    const auto& row = rows[i];
    CAPTURE(row.text);
    const auto twin = brute_force_bottom_height(row.rod, samples);
    const auto solved = engine_height(row.rod);
    CHECK(std::isnan(twin.height) == !row.covered);
    CHECK((solved.status == Status::never_covered) == !row.covered);
    if (!row.covered) continue;
    CHECK(twin.error < 3e-8);
    CHECK(twin.height - solved.value < rounding);
    CHECK(solved.value - twin.height < twin.error + rounding);
  }
}

TEST_CASE("the twin converges to the references with the square of its spacing", "[references][rod_gauging]") {
  // Rod 2 on the misaligned beam of Table 2.5, and a ball end.
  for (const RodCase& rod :
       {RodCase{5 * mm, 0.03 * mm, 88.041 * degree, 144.086 * degree, 0, 0.6241 * degree, 0.2836 * degree, 0.2 * mm,
                0.5},
        RodCase{0.5 * mm, 0.5 * mm, 70 * degree, 10 * degree, 0, 5 * degree, -12 * degree, 0.2 * mm, 0.3}}) {
    const double truth = engine_height(rod).value;
    const double coarse = truth - brute_force_bottom_height(rod, 1024).height;
    const double fine = truth - brute_force_bottom_height(rod, 16384).height;
    REQUIRE(coarse > 1e-11);
    // 256 in the limit; where the beam cuts the polygon's sides matters in between.
    CHECK(coarse / fine > 100);
    CHECK(coarse / fine < 600);
  }
}

TEST_CASE("a rolling ball sweeps the fillet surface of the thesis", "[references][rod_gauging]") {
  // Points of eqs 2.12 to 2.17 directly, without the dilation that both the engine and the fine twin use.
  const auto rows = reference_rows();
  for (std::size_t i = 1; i < rows.size(); i += 11) {
    const auto& row = rows[i];
    if (!row.covered) continue;
    CAPTURE(row.text);
    const auto surface = brute_force_bottom_height(row.rod, 400, Construction::fillet_surface);
    CHECK(surface.height - row.height < 1e-13);
    CHECK(row.height - surface.height < surface.error + 1e-13);
    CHECK(row.height - surface.height < 1e-6); // its error in fact: 0.5 um at worst, on bottoms tilted by 70 deg
  }
}

TEST_CASE("tables 2.2 to 2.7 as recomputed", "[references][rod_gauging]") {
  // Fang 2022; printed values that differ are explained in reports/errata.md#fang-2.
  struct Table {
    double yaw, pitch;             // deg
    double standard, rod_1, rod_2; // mm
  };
  const double half_a_digit = 0.5e-6 * mm;
  const auto height = [](double fillet, double elevation, double azimuth, const Table& t) {
    return engine_height({5 * mm, fillet * mm, elevation * degree, azimuth * degree, 0, t.yaw * degree,
                          t.pitch * degree, 0.2 * mm, 0.5})
        .value;
  };
  for (const Table& t :
       {Table{0, 0, 0, .004137, .137630}, Table{.6241, .2836, .024742, .020515, .111943},
        Table{.6240, .5729, .049983, .045606, .086855}, Table{.9424, .0911, .007948, .003851, .128072}}) {
    CAPTURE(t.yaw, t.pitch);
    CHECK(std::abs(height(0, 90, 0, t) - t.standard * mm) < half_a_digit);
    CHECK(std::abs(height(0.03, 89.922, 127.710, t) - t.rod_1 * mm) < half_a_digit);
    CHECK(std::abs(height(0.03, 88.041, 144.086, t) - t.rod_2 * mm) < half_a_digit);
  }
}
