// Commands of the sphere calibration against independent values: sphere_cases.csv (40-digit homogeneous matrices, see
// sphere_reference.py), and the figures recomputed for Fang 2022, chapter 4.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/csv.h"
#include "laws/sphere_rows.h"
#include "places.h"
#include "propagation/point_table.h"

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

namespace {

constexpr double mm = 1e-3, um = 1e-6, deg = 3.14159265358979323846 / 180;

/// The rows of one evaluation, without the column of its name and the three results.
Csv inputs(const Csv& table, const std::string& evaluation) {
  Csv out{table.file, {table.header.begin() + 1, table.header.end() - 3}, {}};
  for (const auto& row : table.rows)
    if (row[0].text == evaluation) out.rows.emplace_back(row.begin() + 1, row.end() - 3);
  return out;
}

Vector3<double> probe(int variant, const std::vector<double>& q, double B, double C) {
  return sphere::probe_from_origin(variant, tests::links(q), B * deg, C * deg, B != 0);
}
std::vector<double> defaults() {
  std::vector<double> q;
  for (const auto& card : models::find("sphere_calibration")->card->quantities) q.push_back(card.default_value);
  return q;
}
struct Largest {
  double x = 0, y = 0, z = 0;
  void add(const Vector3<double>& a, const Vector3<double>& b) {
    x = std::max(x, std::fabs(a.x - b.x)), y = std::max(y, std::fabs(a.y - b.y)), z = std::max(z, std::fabs(a.z - b.z));
  }
};

} // namespace

TEST_CASE("commands match 40-digit references", "[references][sphere_calibration]") {
  // Sums and products of lengths up to 2 m: some 50 roundings of 2.2e-16 relative, in mm.
  constexpr double tolerance = 50 * 2.2e-16 * 2000;
  static_assert(tolerance < 1e-9);
  const Csv table = read_csv(GUMSHOE_SOURCE_DIR "/tests/references/sphere_cases.csv");
  for (const std::string evaluation : {"exact", "small_angle"}) {
    const Csv rows = inputs(table, evaluation);
    REQUIRE(rows.rows.size() == 87);
    const auto points = propagation::evaluate_points(*models::find("sphere_calibration"), rows, evaluation);
    REQUIRE(points.impossible.empty());
    std::size_t r = 0;
    for (const auto& row : table.rows) {
      if (row[0].text != evaluation) continue;
      CAPTURE(evaluation, r);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t column = points.columns.size() - 3 + k;
        REQUIRE(points.header[column] == table.header[table.header.size() - 3 + k].text);
        CHECK(std::fabs(points.columns[column][r] - table.number(row[row.size() - 3 + k])) < tolerance);
      }
      ++r;
    }
  }
}

TEST_CASE("what the approximations of the thesis cost at its values", "[references][sphere_calibration]") {
  const auto q = defaults();
  Largest small_I, small_II, closed_I, closed_II;
  for (int C = 0; C <= 90; C += 5) {
    const auto exact = probe(sphere::exact, q, 0, C);
    small_I.add(probe(sphere::small_angle, q, 0, C), exact);
    closed_I.add(probe(sphere::closed_form, q, 0, C), exact);
  }
  for (int B = -20; B <= 45; B += 5) {
    if (B == 0) continue;
    const auto exact = probe(sphere::exact, q, B, 90);
    small_II.add(probe(sphere::small_angle, q, B, 90), exact);
    closed_II.add(probe(sphere::closed_form, q, B, 90), exact);
  }
  // Recomputed with numpy from the matrices; the last digit shown.
  CHECK(std::fabs(small_I.x - 11.9 * um) < 0.05 * um);
  CHECK(std::fabs(small_I.y - 9.5 * um) < 0.05 * um);
  CHECK(std::fabs(small_I.z - 17.3 * um) < 0.05 * um);
  CHECK(std::fabs(small_II.x - 13.1 * um) < 0.05 * um);
  CHECK(std::fabs(small_II.z - 20.2 * um) < 0.05 * um);
  CHECK(std::fabs(closed_I.y - 0.28 * um) < 0.005 * um);
  CHECK(std::fabs(closed_II.x - 9.3 * um) < 0.05 * um);
}

TEST_CASE("closed forms are the exact chain to first order, eq 4.38 as printed is not",
          "[references][sphere_calibration]") {
  const auto worst = [](double scale) {
    auto q = defaults();
    for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j) q[static_cast<std::size_t>(j)] *= scale;
    Largest difference;
    for (int C = 0; C <= 90; C += 15)
      difference.add(probe(sphere::closed_form, q, 0, C), probe(sphere::exact, q, 0, C));
    for (int B = -20; B <= 45; B += 13)
      difference.add(probe(sphere::closed_form, q, B, 90), probe(sphere::exact, q, B, 90));
    return std::max({difference.x, difference.y, difference.z});
  };
  // Second order: a tenth of the angles, a hundredth of the difference; the third order is 0.5 % of it at most.
  CHECK(std::fabs(worst(1) / worst(0.1) - 100) < 1);
  CHECK(std::fabs(worst(0.1) / worst(0.01) - 100) < 0.1);

  const auto q = defaults();
  const auto l = tests::links(q);
  for (const double B : {-20.0, 0.0, 45.0}) {
    const auto right = sphere::closed_form_II(l.length, l.tilted, B * deg),
               printed = sphere::closed_form_II(l.length, l.tilted, B * deg, sphere::Equation438::printed);
    CHECK(std::fabs(right.y - printed.y - 2.1167 * mm) < 0.05 * um); // -probe_z E_A0B = 454.220 mm times 0.267 deg
    CHECK(right.x == printed.x);
    CHECK(right.z == printed.z);
  }
}
