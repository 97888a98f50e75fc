/// Each effect of the sphere calibration against what it means.
#include "chain/machine.h"
#include "laws/sphere_effects_case.h"

using namespace sphere_effects_case;

TEST_CASE("error motions of B and C are those of the general chain", "[effects][sphere_calibration][machine]") {
  Draw draw;
  for (int n = 0; n < 100; ++n) {
    Grinder g = Grinder::random(draw);
    for (std::size_t j = Row::E_XX; j <= Row::S_YZ; ++j) g.q[static_cast<std::size_t>(j)] = 0;
    g.condition[Commanded::direction] = -1;
    const double B = g.condition[Commanded::B], C = g.condition[Commanded::C], sag = draw(-1, 1) * 1e-4;
    std::vector<double> a;
    for (int i = 0; i < 20; ++i) a.push_back(draw(-1, 1) * 1e-4);
    const auto pair = [&](std::size_t i, double angle) { return a[i] * std::cos(angle) + a[i + 1] * std::sin(angle); };
    g = g.with("c_encoder_eccentricity", {a[0], a[1]}).with("b_encoder_eccentricity", {a[2], a[3]});
    g = g.with("c_encoder_ovality", {a[4], a[5]}).with("b_encoder_ovality", {a[6], a[7]});
    g = g.with("c_radial_motion", {a[8], a[9], a[10], a[11]}).with("c_axial_motion", {a[12], a[13]});
    g = g.with("c_tilt_motion", {a[14], a[15], a[16], a[17]}).with("gravity_sag", {sag});
    g = g.with("b_axis_reversal", {a[18]}).with("c_brake_shift", {a[19]});

    const auto at = [&](int j) { return g.q[static_cast<std::size_t>(j)]; };
    auto grinder = *chain::find_machine("grinder");
    (*grinder.tool_side)[2].point = {at(Row::link_B_x), 0, -at(Row::link_B_z)};
    (*grinder.tool_side)[3].point = {at(Row::link_C_x), at(Row::link_C_y), 0};
    const double reversal = -g.condition[Commanded::B_direction] * a[18] / 2,
                 brake = g.condition[Commanded::C_clamped] * a[19];
    grinder.errors = {{"E_X0B", at(Row::E_X0B)},
                      {"E_Z0B", -at(Row::E_Z0B)}, // ISO's offset is along +Z
                      {"E_X0C", at(Row::E_X0C)},
                      {"E_Y0C", at(Row::E_Y0C)},
                      {"E_A0B", at(Row::E_A0B)},
                      {"E_C0B", at(Row::E_C0B)},
                      {"E_A0C", at(Row::E_A0C)},
                      {"E_B0C", at(Row::E_B0C)},
                      {"E_AA", at(Row::E_AA)},
                      {"E_BB", at(Row::E_BB) + pair(2, B) + pair(6, 2 * B) + reversal},
                      {"E_CC", at(Row::E_CC) + pair(0, C) + pair(4, 2 * C) + brake},
                      {"E_XC", pair(8, 2 * C)},
                      {"E_YC", pair(10, 2 * C)},
                      {"E_ZC", pair(12, 2 * C)},
                      {"E_AC", pair(14, 2 * C)},
                      {"E_BC", pair(16, 2 * C)},
                      {"E_ZB", -sag * std::sin(B)}};
    const chain::Machine machine(grinder);
    const auto xyz = g.commands();
    const double commands[] = {xyz.x, g.condition[Commanded::A], xyz.y, xyz.z, B, C};
    const Vector3<double> probe{at(Row::probe_x), -at(Row::probe_y), -at(Row::probe_z)};
    const auto tip = machine.bed_from_tool(commands, machine.errors().data()) * probe;
    auto top = machine.bed_from_workpiece(commands, machine.errors().data()) *
               Vector3<double>{-at(Row::sphere_distance), at(Row::sphere_y), at(Row::sphere_z)};
    top.z += at(Row::sphere_radius) + at(Row::tip_radius);
    REQUIRE(distance(tip, top) < 5e-15);
    // The approach, turned into the probe's frame by the same chain without errors.
    grinder.errors = {};
    const chain::Machine ideal(grinder);
    const auto turn = ideal.bed_from_tool(commands, ideal.errors().data()).turn;
    REQUIRE(distance(transposed(turn) * Vector3<double>{0, 0, -1}, chain::approach_in_probe(-1.0, B, C)) < 1e-15);
  }
}

TEST_CASE("a slide that goes too far reads less", "[effects][sphere_calibration]") {
  const Grinder g = Grinder().under({{Commanded::B, 20 * deg}, {Commanded::C, 50 * deg}, {Commanded::time, 3600}});
  const auto read = g.commands();
  const auto shift = [&](std::string_view name, const std::vector<double>& values) {
    return g.with(name, values).commands() - read;
  };
  const auto near = [](const Vector3<double>& a, const Vector3<double>& b) { return distance(a, b) < 1e-15; };
  REQUIRE(near(shift("x_scale", {1e-5}), {read.x / (1 + 1e-5) - read.x, 0, 0}));
  REQUIRE(near(shift("y_scale", {1e-5}), {0, read.y / (1 + 1e-5) - read.y, 0}));
  REQUIRE(near(shift("z_scale", {1e-5}), {0, 0, read.z / (1 + 1e-5) - read.z}));
  REQUIRE(near(shift("x_straightness", {1e-4, 2e-4}), {0, -1e-4 * read.x * read.x, -2e-4 * read.x * read.x}));
  REQUIRE(near(shift("y_straightness", {1e-4, 2e-4}), {-1e-4 * read.y * read.y, 0, -2e-4 * read.y * read.y}));
  REQUIRE(near(shift("z_straightness", {1e-4, 2e-4}), {-1e-4 * read.z * read.z, -2e-4 * read.z * read.z, 0}));
  // An hour of 10 um/h, and 1 - 1/e of 20 um.
  const double rise = 20 * um * (1 - std::exp(-1.0));
  REQUIRE(near(shift("thermal_drift", {10 * um / 3600, -5 * um / 3600, 0, 0, 3600}), {-10 * um, 5 * um, 0}));
  REQUIRE(near(shift("thermal_drift", {0, 0, 0, 20 * um, 3600}), {0, -rise, 0}));
  REQUIRE(near(shift("thermal_growth", {10 * um / 3600, 0, 1800}), {0, 0, 10 * um}));
  REQUIRE(near(shift("z_reversal", {4 * um}), {0, 0, -2 * um}));
}

TEST_CASE("an axis that lags is an axis at another angle", "[effects][sphere_calibration]") {
  const Grinder g = Grinder().under({{Commanded::B, 20 * deg}, {Commanded::C, 50 * deg}});
  const auto turned = [&](double by_B, double by_C) {
    return g.where(Row::E_BB, by_B).where(Row::E_CC, by_C).commands();
  };
  const auto up = g.with("c_axis_reversal", {6 * arcsec}), down = up.under({{Commanded::C_direction, -1}});
  REQUIRE(distance(up.commands(), turned(0, -3 * arcsec)) < 1e-15);
  REQUIRE(distance(down.commands(), turned(0, 3 * arcsec)) < 1e-15);
  REQUIRE(same(up.under({{Commanded::C_direction, 0}}).commands(), g.commands()));
  const auto held = g.with("b_brake_shift", {4 * arcsec});
  REQUIRE(same(held.commands(), g.commands()));
  REQUIRE(distance(held.under({{Commanded::B_clamped, 1}}).commands(), turned(4 * arcsec, 0)) < 1e-15);
  // 5 um of eccentricity on 100 mm: 412 * 5 / 100 arcsec, 20.6.
  const double e = 5 * um / (100e-3 / 2);
  REQUIRE(e / arcsec == Approx(412.0 * 5 / 100).epsilon(2e-3));
  REQUIRE(distance(g.with("c_encoder_eccentricity", {0, e}).commands(), turned(0, e * std::sin(50 * deg))) < 1e-15);
  // A tenth of a thousandth of the angle, and a load whose lever is longest at 90 deg.
  REQUIRE(distance(g.with("b_scale", {1e-4}).commands(), turned(20e-4 * deg, 0)) < 1e-15);
  REQUIRE(distance(g.with("c_scale", {1e-4}).commands(), turned(0, 50e-4 * deg)) < 1e-15);
  REQUIRE(distance(g.with("b_gravity_torque", {0, 9 * arcsec}).commands(), turned(9 * arcsec * std::sin(20 * deg), 0)) <
          1e-15);
}

/// Middles of touches from opposite sides, each a pretravel too far along its approach.
TEST_CASE("three lobes move a centre that four touches find", "[effects][sphere_calibration]") {
  for (const double B : {-20.0, 0.0, 45.0})
    for (const double C : {0.0, 50.0, 170.0}) {
      const Grinder g = Grinder().under({{Commanded::B, B * deg}, {Commanded::C, C * deg}});
      const auto turn = rotation(0.0, B * deg, 0.0) * rotation(0.0, 0.0, C * deg);
      const auto pretravel = [&](const Vector3<double>& approach) {
        const auto u = transposed(turn) * approach;
        const double azimuth = std::atan2(u.y, u.x), off = std::hypot(u.x, u.y);
        return off * off * off * (5 * um * std::cos(3 * azimuth) + 2 * um * std::sin(3 * azimuth));
      };
      const double x = (pretravel({1, 0, 0}) - pretravel({-1, 0, 0})) / 2,
                   y = (pretravel({0, 1, 0}) - pretravel({0, -1, 0})) / 2;
      const auto moved = g.with("centre_lobing", {5 * um, 2 * um}).commands() - g.commands();
      REQUIRE(distance(moved, {x, y, 0}) < 1e-15);
    }
}

TEST_CASE("the probe triggers late", "[effects][sphere_calibration]") {
  const auto at = [](double B, double C) { return Grinder().under({{Commanded::B, B * deg}, {Commanded::C, C * deg}}); };
  const auto lower = [](const Grinder& g, std::string_view name, const std::vector<double>& values) {
    const auto moved = g.with(name, values).commands() - g.commands();
    REQUIRE(moved.x == 0);
    REQUIRE(moved.y == 0);
    return -moved.z;
  };
  const double rounding = 1e-15;
  for (const double C : {0.0, 50.0, 170.0})
    for (const double B : {-20.0, 0.0, 45.0}) {
      const double s = std::sin(B * deg);
      REQUIRE(std::fabs(lower(at(B, C), "pretravel", {7 * um}) - 7 * um) < rounding);
      REQUIRE(std::fabs(lower(at(B, C), "pretravel_bending", {7 * um}) - 7 * um * s * s) < rounding);
      REQUIRE(std::fabs(lower(at(B, C).under({{Commanded::feed, 0.5e-3}}), "trigger_latency", {2e-3}) - 1 * um) <
              rounding);
      // Three lobes over the azimuth of the approach, which is that of -C, or opposite.
      REQUIRE(std::fabs(lower(at(B, C), "pretravel_lobing", {5 * um, 0}) - 5 * um * s * s * s * std::cos(3 * C * deg)) <
              rounding);
      REQUIRE(std::fabs(lower(at(B, C), "pretravel_lobing", {0, 5 * um}) + 5 * um * s * s * s * std::sin(3 * C * deg)) <
              rounding);
    }
}
