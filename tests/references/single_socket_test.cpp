// Position and orientation errors of the single socket method against independent values (40 digits,
// single_socket_reference.py), and both tables of Wang et al. 2013.
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/csv.h"
#include "places.h"
#include "propagation/point_table.h"

using namespace gumshoe;

namespace {

/// 50 roundings of lengths up to 1 m, in mm, amplified by 3 at most; 1e-9 mm over a lever of 50 mm, in deg.
constexpr double of_lengths = 50 * 2.2e-16 * 1000 * 3, of_angles = of_lengths / 50 * 57.3;
static_assert(of_lengths < 1e-9 && of_angles < 1e-12 * 57.3);

std::size_t column(const Csv& table, const std::string& name) { return static_cast<std::size_t>(table.find(name)); }
/// Some rows, with the columns from `first` to `last`, that one excluded.
Csv part(const Csv& table, std::size_t first, std::size_t last, const std::vector<std::size_t>& rows) {
  const auto cut = [&](const std::vector<CsvCell>& cells) {
    return std::vector<CsvCell>(cells.begin() + static_cast<std::ptrdiff_t>(first),
                                cells.begin() + static_cast<std::ptrdiff_t>(last));
  };
  Csv out{table.file, cut(table.header), {}};
  for (const std::size_t r : rows) out.rows.push_back(cut(table.rows[r]));
  return out;
}
/// Rows with equal text in a column, by that text.
std::map<std::string, std::vector<std::size_t>> grouped(const Csv& table, std::size_t by) {
  std::map<std::string, std::vector<std::size_t>> out;
  for (std::size_t r = 0; r < table.rows.size(); ++r) out[table.rows[r][by].text].push_back(r);
  return out;
}
double found(const propagation::PointTable& points, const std::string& name, std::size_t row) {
  for (std::size_t i = 0; i < points.header.size(); ++i)
    if (points.header[i] == name) return points.columns[i].at(row);
  FAIL(name << " is no result");
  return 0;
}
double allowed(const std::string& name) { return name.ends_with("(deg)") ? of_angles : of_lengths; }

} // namespace

TEST_CASE("orientation errors match 40-digit references", "[references][single_socket]") {
  const Csv table = read_csv(GUMSHOE_SOURCE_DIR "/tests/references/single_socket_rotations.csv");
  const std::size_t results = column(table, "d_alpha (deg)");
  const auto evaluations = grouped(table, 0);
  CHECK(evaluations.size() == 8);
  for (const auto& [evaluation, rows] : evaluations) {
    const auto points = propagation::evaluate_points(*models::find("single_socket_rotation"),
                                                     part(table, 1, results, rows), evaluation);
    REQUIRE(points.impossible.empty());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = results; c < table.header.size(); ++c) {
        const std::string& name = table.header[c].text;
        CAPTURE(evaluation, r, name);
        CHECK(std::fabs(found(points, name, r) - table.number(table.rows[rows[r]][c])) < allowed(name));
      }
  }
}

TEST_CASE("position errors, and orientation errors from bars, match 40-digit references",
          "[references][single_socket]") {
  const Csv table = read_csv(GUMSHOE_SOURCE_DIR "/tests/references/single_socket_stations.csv");
  const std::size_t results = column(table, "before_x (mm)");
  const auto tables = grouped(table, 0);
  CHECK(tables.size() == 40);
  for (const auto& [number, rows] : tables) {
    const std::string evaluation = table.rows[rows[0]][1].text;
    const bool one_step = evaluation.starts_with("position");
    const auto points =
        propagation::evaluate_points(*models::find("single_socket"), part(table, 2, results, rows), evaluation);
    REQUIRE(points.impossible.empty());
    for (std::size_t c = results; c < table.header.size(); ++c) {
      std::string name = table.header[c].text;
      const CsvCell& cell = table.rows[rows[0]][c];
      if (cell.text.empty()) continue;
      if (one_step) name = "position_error" + name.substr(std::string("before").size());
      CAPTURE(number, evaluation, name);
      CHECK(std::fabs(found(points, name, 0) - table.number(cell)) < allowed(name));
    }
  }
}

TEST_CASE("Table 1 of Wang et al. 2013 comes out to the last digit", "[references][single_socket]") {
  struct Movement {
    double alpha, beta, d_alpha, d_beta, x, y, z, after_x, after_y, after_z, printed_alpha, printed_beta;
  };
  constexpr Movement movements[] = {
      {30, 0, .1, 0, -50, 110, 283.494, 0, .378, .218, .1, 0},
      {0, 40, 0, .08, -210.697, -15, 308.489, -.267, 0, .225, 0, .07995},
      {45, 60, .12, .1, -266.506, 73.388, 411.612, -.218, -.083, .452, .12, .09985},
      {60, 50, .15, .09, -241.511, 124.168, 419.652, -.252, -.051, .514, .15, .08992},
      {30, 60, .1, .1, -266.506, 47.5, 391.747, -.218, -.001, .436, .1, .09985},
  };
  const models::Model& model = *models::find("single_socket_rotation");
  const auto table = [](std::vector<std::pair<std::string, double>> columns) {
    Csv out;
    out.rows.resize(1);
    for (const auto& [name, value] : columns) {
      out.header.push_back({name, 1, 1});
      out.rows[0].push_back({fmt::format("{:.17g}", value), 2, 1});
    }
    return out;
  };
  for (const Movement& m : movements) {
    CAPTURE(m.alpha, m.beta);
    // The machine that is asked for, then both evaluations of what it shows.
    std::vector<std::pair<std::string, double>> at{{"alpha (deg)", m.alpha}, {"beta (deg)", m.beta}};
    auto truth = at;
    truth.insert(truth.end(), {{"d_alpha (deg)", m.d_alpha}, {"d_beta (deg)", m.d_beta}});
    const auto shown = propagation::evaluate_points(model, table(truth), "rrttt");
    const double x[] = {found(shown, "after_x (mm)", 0), found(shown, "after_y (mm)", 0),
                        found(shown, "after_z (mm)", 0)};
    CHECK(std::fabs(x[0] - m.after_x) < 0.00051);
    CHECK(std::fabs(x[1] - m.after_y) < 0.00051);
    CHECK(std::fabs(x[2] - m.after_z) < 0.00051);
    at.insert(at.end(), {{"after_x (mm)", x[0]}, {"after_y (mm)", x[1]}, {"after_z (mm)", x[2]}});
    const auto exact = propagation::evaluate_points(model, table(at), "rrttt");
    CHECK(std::fabs(found(exact, "d_alpha (deg)", 0) - m.d_alpha) < of_angles);
    CHECK(std::fabs(found(exact, "d_beta (deg)", 0) - m.d_beta) < of_angles);
    const auto linear = propagation::evaluate_points(model, table(at), "rrttt_linear");
    CHECK(std::fabs(found(linear, "d_alpha (deg)", 0) - m.printed_alpha) < 0.0000051);
    CHECK(std::fabs(found(linear, "d_beta (deg)", 0) - m.printed_beta) < 0.0000051);
    // The printed nominal places are those of pivot (-50, -15, 500) mm and a tool of -250 mm: stated, they change
    // nothing beyond their rounding; over 1 mm off they would be refused.
    at.insert(at.end(), {{"pivot_x (mm)", -50},
                         {"pivot_y (mm)", -15},
                         {"pivot_z (mm)", 500},
                         {"nominal_x (mm)", m.x},
                         {"nominal_y (mm)", m.y},
                         {"nominal_z (mm)", m.z}});
    const auto stated = propagation::evaluate_points(model, table(at), "rrttt");
    CHECK(stated.impossible.empty());
    CHECK(std::fabs(found(stated, "d_alpha (deg)", 0) - m.d_alpha) < 0.0005 / 125 * 57.3);
  }
}

TEST_CASE("Table 2 of Wang et al. 2013: the angles that its position errors give", "[references][single_socket]") {
  // The position errors before the rotation turn with the table. Printed angles need the sign of z reversed, and then
  // have the sign of d_alpha reversed; with z as printed d_alpha is another (recomputed with scipy, 4 digits).
  const Csv rows = read_csv(GUMSHOE_SOURCE_DIR "/scenarios/data/single_socket.csv");
  constexpr double printed_alpha[] = {-.0426, -.0161, -.0128, -.0396}, printed_gamma[] = {.0684, .4514, -.2403, -.2513},
                   consistent_alpha[] = {.0426, .0212, .0060, .0329};
  for (const double sign : {1.0, -1.0}) {
    Csv table;
    for (const char* name :
         {"alpha (deg)", "gamma (deg)", "seating_x (mm)", "seating_y (mm)", "seating_z (mm)", "after_x (mm)",
          "after_y (mm)", "after_z (mm)", "point_x (mm)", "point_y (mm)", "point_z (mm)"})
      table.header.push_back({name, 1, 1});
    for (const auto& row : rows.rows) {
      table.rows.emplace_back(row.begin() + 2, row.end());
      for (const std::size_t z : {4, 7})
        table.rows.back()[z].text = fmt::format("{:.17g}", sign * rows.number(row[z + 2]));
      for (const char* coordinate : {"-49.275", "-14.312", "-177.777"}) table.rows.back().push_back({coordinate, 2, 1});
    }
    const auto points = propagation::evaluate_points(*models::find("single_socket_rotation"), table, "tttrr");
    for (std::size_t r = 0; r < 4; ++r) {
      CAPTURE(sign, r);
      CHECK(std::fabs(found(points, "d_gamma (deg)", r) - printed_gamma[r]) < 1.1e-4);
      if (sign > 0)
        CHECK(std::fabs(found(points, "d_alpha (deg)", r) - consistent_alpha[r]) < 0.51e-4);
      else
        CHECK(std::fabs(-found(points, "d_alpha (deg)", r) - printed_alpha[r]) < 1.1e-4);
    }
  }
}
