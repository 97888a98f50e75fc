// Laser ball bars against independent values: ball_bar_cases.csv and ball_bar_contours.csv (ball_bar_reference.py), and
// the figures of Schmitz and Ziegert 1999.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/csv.h"
#include "chain/contour.h"
#include "places.h"
#include "propagation/point_table.h"

using namespace gumshoe;

namespace {

constexpr double mm = 1e-3, um = 1e-6, minute = 60, pi = std::numbers::pi;

Csv reference(const char* file) { return read_csv(std::string(GUMSHOE_SOURCE_DIR "/tests/references/") + file); }

/// The first columns of a table.
Csv first(const Csv& table, std::size_t columns) {
  const auto n = static_cast<std::ptrdiff_t>(columns);
  Csv out{table.file, {table.header.begin(), table.header.begin() + n}, {}};
  for (const auto& row : table.rows) out.rows.emplace_back(row.begin(), row.begin() + n);
  return out;
}
const std::string& text(const std::string& name) { return name; }
const std::string& text(const CsvCell& cell) { return cell.text; }
std::size_t column(const auto& header, const std::string& name) {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (text(header[i]) == name) return i;
  FAIL("no column " << name);
  return 0;
}

const chain::ContourPlane flat(0, 0), at_45(pi / 4, 0);
chain::Contour line(double feed) {
  return {chain::ContourKind::line, {}, at_45, 150 * mm, 1, feed, 0.98, 0};
}
chain::Contour circle(double feed) {
  return {chain::ContourKind::circle, {}, flat, 50 * mm, 1, feed, 0.98, 0};
}
/// Slides with loop gains of 30 1/s in X and Z, 33 1/s in Y.
struct Machine {
  chain::Servo<double> servos[3];
  explicit Machine(int order) : servos{{order, 30.0, 0.7}, {order, 33.0, 0.7}, {order, 30.0, 0.7}} {}
  double error(const chain::Contour& contour, double t) const {
    return contour.deviation(contour.follow(servos, t).position, t).normal;
  }
};

} // namespace

TEST_CASE("trilateration matches 50-digit references, also near flat bases and low tools", "[references][laser_ball_bar]") {
  const Csv table = reference("ball_bar_cases.csv");
  const std::size_t inputs = column(table.header, "tool_x (mm)");
  const auto points = propagation::evaluate_points(*models::find("laser_ball_bar"), first(table, inputs), "full");
  const std::size_t tool = column(points.header, "tool_x (mm)");
  std::size_t refused = 0, to_a_picometre = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    CAPTURE(r);
    if (table.rows[r].back().text != "ok") {
      CHECK(std::isnan(points.columns[tool][r]));
      ++refused;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double tolerance = table.number(table.rows[r][inputs + 3 + k]);
      CHECK(std::fabs(points.columns[tool + k][r] - table.number(table.rows[r][inputs + k])) <= tolerance);
      to_a_picometre += tolerance < 1e-9;
    }
  }
  CHECK(refused == 3);
  CHECK(to_a_picometre > 120); // elsewhere the geometry does not allow it
}

TEST_CASE("lengths read on a contour match integrated servos", "[references][laser_ball_bar]") {
  // Lengths below 1 m: a hundred roundings.
  constexpr double tolerance = 100 * 1.2e-13;
  const Csv table = reference("ball_bar_contours.csv");
  const std::size_t inputs = column(table.header, "length_1 (mm)");
  const auto points = propagation::evaluate_points(*models::find("laser_ball_bar"), first(table, inputs), "full");
  REQUIRE(points.impossible.empty());
  const std::size_t read = column(points.header, "length_1 (mm)");
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(r, k);
      CHECK(std::fabs(points.columns[read + k][r] - table.number(table.rows[r][inputs + k])) < tolerance);
    }
}

TEST_CASE("unequal loop gains offset a line and make an ellipse of a circle", "[references][laser_ball_bar]") {
  const double mismatch = 1 / 30.0 - 1 / 33.0;
  for (const int order : {1, 2}) {
    const Machine machine(order);
    for (const auto& [feed, offset] : {std::pair{889 * mm / minute, 22.45 * um}, {1778 * mm / minute, 44.90 * um}}) {
      // Closed form v sin a cos a (1/Kx - 1/Ky); the transient is gone to 1e-12 after a second.
      CHECK(std::fabs(machine.error(line(feed), 3) - feed / 2 * mismatch) < 1e-13);
      CHECK(std::fabs(machine.error(line(feed), 3) - offset) < 0.005 * um);
      double low = 1, high = -1, at = 0;
      for (double t = 2; t < 2 + 2 * pi * 50 * mm / feed / 2; t += 0.01) {
        const double e = machine.error(circle(feed), t);
        if (e > high) high = e, at = circle(feed).angle(t);
        low = std::fmin(low, e);
      }
      // v abs(1/Kx - 1/Ky) to first order in omega/K = 0.02; for K_x < K_y the major axis lies 45 deg past +X, and
      // 45 deg past +Y for K_x > K_y as printed.
      CHECK(std::fabs(high - low - feed * mismatch) < 0.004 * feed * mismatch);
      CHECK(std::fabs(std::remainder(at - pi / 4, pi)) < 0.05);
    }
  }
}
