/// Probing a sphere on a described machine: the laws of every model, against the grinder's own model, published
/// transforms, and differences.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "asked.h"
#include "base/error.h"
#include "laws/sphere_rows.h"
#include "models/sphere_probing/sphere_probing.h"

using namespace gumshoe;
using models::Gradient;
namespace probing = models::probing;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

namespace {

constexpr double deg = 3.14159265358979323846 / 180;

struct Draw {
  std::mt19937_64 engine{841};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

using Axes = std::vector<chain::AxisDescription>;
/// A slide behind a rotary axis on either side, a second slide along Z, and axes that do not meet.
chain::MachineDescription odd() {
  return {"odd", Axes{{"Y", "", {0.1, 0.2, 0.3}}, {"C", "", {0.2, -0.1, 0.05}}, {"W"}},
          Axes{{"Z"}, {"A", "", {0, 0.1, 0.4}, -1}, {"X", "", {-0.3, 0, 0.1}}, {"B2", "", {0.05, 0, -0.2}}}};
}

struct Case {
  models::MadeModel model;
  std::vector<double> q, conditions;
  Case(const chain::MachineDescription& d, Draw& draw, double size) : model(probing::make(d)) {
    for (const auto& card : model->card->quantities)
      q.push_back(card.name.starts_with("E_") ? size * draw(-1, 1) : draw(-0.3, 0.3));
    for (const auto& card : model->card->conditions)
      conditions.push_back(card.unit == "deg" ? draw(-0.9, 0.9) : draw(-0.2, 0.2));
  }
  std::vector<Gradient> exact;
  propagation::ForwardModel forward() const { return propagation::ForwardModel(*model, {}, 0, {conditions}); }
  std::vector<Gradient> point(std::size_t variable, const std::array<double, 3>& read) const {
    std::vector<Gradient> g(q.begin(), q.end());
    g[variable] = Gradient::variable(q[variable], 0);
    g.insert(g.end(), read.begin(), read.end());
    return g;
  }
  std::array<double, 3> values() const { return {exact[0].v, exact[1].v, exact[2].v}; }
  std::array<double, 3> simulated(std::size_t variable = 0) {
    REQUIRE(forward().indications(0, point(variable, {}), exact).status == 0);
    return values();
  }
  std::array<double, 3> evaluated(const std::array<double, 3>& read, std::size_t variable = 0) {
    REQUIRE(forward().measurands(0, point(variable, read), exact).status == 0);
    return values();
  }
};

} // namespace

TEST_CASE("at the simulated commands the tip stands at the sphere, on any machine", "[laws][sphere_probing]") {
  Draw draw;
  std::vector<chain::MachineDescription> all(chain::machines().begin(), chain::machines().end());
  all.push_back(odd());
  for (const auto& d : all)
    for (const double size : {0.0, 1e-4, 0.05})
      for (int i = 0; i < 20; ++i) {
        CAPTURE(d.name, size, i);
        Case c(d, draw, size);
        // Coordinates of a metre through a dozen products; the odd machine's slides span half a unit volume or more.
        for (const double v : c.evaluated(c.simulated())) CHECK(std::fabs(v) < 5e-15);
      }
}

TEST_CASE("the grinder is that of sphere_calibration", "[laws][sphere_probing][sphere_calibration]") {
  Draw draw;
  for (int i = 0; i < 100; ++i) {
    double q[tests::quantities] = {};
    for (std::size_t j = Row::probe_x; j <= Row::probe_z; ++j) q[j] = draw(0.05, 0.5);
    for (std::size_t j = Row::E_X0B; j <= Row::E_Y0C; ++j) q[j] = draw(-1e-3, 1e-3);
    for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j) q[j] = draw(-0.5, 0.5) * deg;
    for (std::size_t j = Row::link_B_x; j <= Row::link_C_y; ++j) q[j] = draw(-0.2, 0.2);
    for (const std::size_t j : {Row::sphere_distance, Row::sphere_y, Row::sphere_z}) q[j] = draw(-0.2, 0.2);
    for (const std::size_t j : {Row::E_AA, Row::E_BB, Row::E_CC}) q[j] = draw(-0.1, 0.1) * deg;
    for (std::size_t j = Row::E_XX; j <= Row::E_ZZ; ++j) q[j] = draw(-1e-5, 1e-5);
    q[Row::sphere_radius] = 0.0125, q[Row::tip_radius] = 0.003;
    double condition[tests::conditions] = {draw(-2, 2), draw(-2, 2), draw(-2, 2)};
    const auto wanted = sphere::simulate(sphere::contact(tests::reading(sphere::exact, q, {condition, condition + tests::conditions})));

    auto d = *chain::find_machine("grinder");
    (*d.tool_side)[2].point = {q[Row::link_B_x], 0, -q[Row::link_B_z]};
    (*d.tool_side)[3].point = {q[Row::link_C_x], q[Row::link_C_y], 0};
    // There the errors of the slides add to the commands. By ISO those of X do so, too, as X carries the workpiece;
    // those of Y and Z, which carry the tool, count against them.
    const auto add = [&](const char* name, double value) { d.errors.emplace_back(name, value); };
    add("E_X0B", q[Row::E_X0B]), add("E_Z0B", -q[Row::E_Z0B]), add("E_X0C", q[Row::E_X0C]);
    add("E_Y0C", q[Row::E_Y0C]), add("E_A0B", q[Row::E_A0B]), add("E_C0B", q[Row::E_C0B]);
    add("E_A0C", q[Row::E_A0C]), add("E_B0C", q[Row::E_B0C]), add("E_AA", q[Row::E_AA]);
    add("E_BB", q[Row::E_BB]), add("E_CC", q[Row::E_CC]);
    for (const auto& [name, index, carried] :
         {std::tuple<const char*, std::size_t, bool>{"E_XX", Row::E_XX, true}, std::tuple<const char*, std::size_t, bool>{"E_YX", Row::E_YX, true},
          std::tuple<const char*, std::size_t, bool>{"E_ZX", Row::E_ZX, true}, std::tuple<const char*, std::size_t, bool>{"E_XY", Row::E_XY, false},
          std::tuple<const char*, std::size_t, bool>{"E_YY", Row::E_YY, false}, std::tuple<const char*, std::size_t, bool>{"E_ZY", Row::E_ZY, false},
          std::tuple<const char*, std::size_t, bool>{"E_XZ", Row::E_XZ, false}, std::tuple<const char*, std::size_t, bool>{"E_YZ", Row::E_YZ, false},
          std::tuple<const char*, std::size_t, bool>{"E_ZZ", Row::E_ZZ, false}})
      add(name, carried ? q[index] : -q[index]);
    Case c(d, draw, 0);
    for (std::size_t j = 0; j < c.q.size(); ++j) c.q[j] = c.model->card->quantities[j].default_value;
    const double points[] = {q[Row::probe_x],
                             -q[Row::probe_y],
                             -q[Row::probe_z],
                             -q[Row::sphere_distance],
                             q[Row::sphere_y],
                             q[Row::sphere_z],
                             0,
                             0,
                             0.0155};
    std::copy(std::begin(points), std::end(points), c.q.begin());
    c.conditions = {condition[Commanded::A], condition[Commanded::B], condition[Commanded::C]};
    const auto xyz = c.simulated();
    CHECK(std::fabs(xyz[0] - wanted.x) < 1e-14);
    CHECK(std::fabs(xyz[1] - wanted.y) < 1e-14);
    CHECK(std::fabs(xyz[2] - wanted.z) < 1e-14);
  }
}

TEST_CASE("commands of the published five-axis machines", "[laws][sphere_probing][references]") {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    const double x = draw(-1, 1), y = draw(-1, 1), z = draw(-1, 1), a = draw(-2, 2), b = draw(-2, 2);
    { // Wang 2013, RRTTT: the tip (0, 0, -r) at x + r sin b (-1), y + r sin a cos b, z - r cos a cos b
      Case c(*chain::find_machine("RRTTT"), draw, 0);
      const double points[] = {0, 0, -0.25, x, y, z, 0, 0, 0};
      std::copy(std::begin(points), std::end(points), c.q.begin());
      c.conditions = {a, b};
      const auto at = c.simulated();
      CHECK(std::fabs(at[0] - (x + 0.25 * std::sin(b))) < 2e-15);
      CHECK(std::fabs(at[1] - (y - 0.25 * std::sin(a) * std::cos(b))) < 2e-15);
      CHECK(std::fabs(at[2] - (z + 0.25 * std::cos(a) * std::cos(b))) < 2e-15);
    }
    { // TTTRR: the table turns a point by -a about X after -b about Z
      Case c(*chain::find_machine("TTTRR"), draw, 0);
      const double points[] = {0, 0, 0, x, y, z, 0, 0, 0};
      std::copy(std::begin(points), std::end(points), c.q.begin());
      c.conditions = {a, b};
      const auto at = c.simulated();
      const double u = x * std::cos(b) + y * std::sin(b), v = -x * std::sin(b) + y * std::cos(b);
      CHECK(std::fabs(at[0] - u) < 2e-15);
      CHECK(std::fabs(at[1] - (v * std::cos(a) + z * std::sin(a))) < 2e-15);
      CHECK(std::fabs(at[2] - (z * std::cos(a) - v * std::sin(a))) < 2e-15);
    }
  }
}

TEST_CASE("blocks give the bits of points", "[laws][sphere_probing]") {
  Draw draw;
  Case c(odd(), draw, 1e-3);
  constexpr std::size_t n = 16;
  std::vector<std::vector<double>> values;
  for (std::size_t j = 0; j < c.q.size(); ++j) { // every third quantity is drawn
    values.emplace_back(n, c.q[j]);
    for (double& v : values.back()) v = j % 3 == 0 ? c.q[j] * draw(0.5, 1.5) : c.q[j];
  }
  const auto forward = c.forward();
  auto columns = values;
  for (std::size_t j = 0; j < columns.size(); ++j)
    if (j % 3 != 0) columns[j].resize(1);
  columns.resize(columns.size() + 3, {0.0});
  const auto there = forward.simulate(tests::block_of(forward, n, columns));
  CHECK(there.measurands == std::vector<double>(3 * n, 0.0));
  const double* rows[3];
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k] = &there.indications[k * n];
    columns[c.q.size() + k].assign(rows[k], rows[k] + n);
  }
  const auto back = forward.evaluate(tests::block_of(forward, n, columns));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < c.q.size(); ++j) c.q[j] = values[j][i];
    const auto xyz = c.simulated(), off = c.evaluated({rows[0][i], rows[1][i], rows[2][i]});
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(rows[k][i] == xyz[k]);
      CHECK(back.measurands[k * n + i] == off[k]);
    }
    CHECK((there.status[i] == 0 && back.status[i] == 0));
  }
}

TEST_CASE("slides in one plane are out of reach", "[laws][sphere_probing]") {
  Draw draw;
  // X stands behind B: at 90 deg it moves along Z.
  Case c({"", Axes{}, Axes{{"Y"}, {"Z"}, {"B"}, {"X"}}}, draw, 0);
  c.conditions = {90 * deg};
  const auto point = tests::joined(c.q, std::vector<double>(3));
  CHECK(c.forward().check(0, point).find("B = 90 deg") != std::string::npos);
  CHECK(c.forward().indications({point}).status[0] == Status::out_of_domain);
  c.conditions = {30 * deg};
  CHECK(c.forward().check(0, point).empty());
  REQUIRE_THROWS_AS(probing::make({"", Axes{{"C"}}, Axes{{"X"}, {"Z"}}}), InputError);
}
