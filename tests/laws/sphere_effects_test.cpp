/// Effects of the sphere calibration: laws that hold for every one of them, and each against what it means.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "chain/machine.h"
#include "models/sphere_calibration/procedures.h"

using namespace gumshoe;
namespace sphere = gumshoe::models::sphere;

namespace {

constexpr double pi = 3.14159265358979323846, deg = pi / 180, um = 1e-6, arcsec = deg / 3600;

struct Draw {
  std::mt19937_64 engine{4511};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  double sign() { return (*this)(0, 1) < 0.5 ? -1 : 1; }
};

std::vector<const EffectCard*> applicable() {
  std::vector<const EffectCard*> found;
  for (const EffectCard* card : effects::cards())
    if (effects::applies(*models::find("sphere_calibration")->card, *card)) found.push_back(card);
  return found;
}

/// Ten times what machines have.
std::vector<double> some(const EffectCard& card, Draw& draw) {
  std::vector<double> values;
  for (const QuantityCard& q : card.quantities) {
    const std::string_view unit = q.si_unit;
    const double size = unit == "m"     ? 1e-4
                        : unit == "rad" ? 5e-4
                        : unit == "1"   ? 2e-4
                        : unit == "m/s" ? 5e-8
                        : unit == "1/m" ? 1e-3
                        : unit == "s"   ? 5e-3
                                        : 0;
    REQUIRE(size > 0);
    values.push_back(q.role == Role::shape ? draw(300, 3000) : draw(-size, size));
    REQUIRE(q.limits.contain(values.back()));
  }
  return values;
}

/// One reading of one machine.
struct Grinder {
  std::vector<double> q, condition, e;
  std::vector<effects::Active> active;

  Grinder() : condition(sphere::conditions, 0.0) {
    for (const auto& card : models::find("sphere_calibration")->card->quantities) q.push_back(card.default_value);
    for (int j = 0; j < sphere::conditions; ++j)
      condition[static_cast<std::size_t>(j)] =
          models::find("sphere_calibration")->card->conditions[static_cast<std::size_t>(j)].default_value;
  }
  static Grinder random(Draw& draw) {
    Grinder g;
    const auto fill = [&](int from, int to, double size) {
      for (int j = from; j <= to; ++j) g.q[static_cast<std::size_t>(j)] = draw(-size, size);
    };
    fill(sphere::probe_x, sphere::probe_z, 0.5), fill(sphere::E_X0B, sphere::E_Y0C, 1e-3);
    fill(sphere::E_A0B, sphere::E_B0C, 1 * deg), fill(sphere::link_B_x, sphere::link_C_y, 0.3);
    fill(sphere::sphere_distance, sphere::sphere_z, 0.2), fill(sphere::E_AA, sphere::E_CC, 0.05 * deg);
    fill(sphere::E_XX, sphere::E_ZZ, 5e-6), fill(sphere::S_XY, sphere::S_YZ, 5e-5);
    return g.under({{sphere::A, draw(-pi, pi)},
                    {sphere::B, draw(-2, 2)},
                    {sphere::C, draw(-pi, pi)},
                    {sphere::direction, draw.sign()},
                    {sphere::time, draw(0, 7200)},
                    {sphere::feed, draw(1e-4, 1e-3)},
                    {sphere::B_direction, draw.sign()},
                    {sphere::C_direction, draw.sign()},
                    {sphere::B_clamped, draw(0, 1) < 0.5},
                    {sphere::C_clamped, draw(0, 1) < 0.5}});
  }
  Grinder under(std::initializer_list<std::pair<sphere::Condition, double>> values) const {
    Grinder g = *this;
    for (const auto& [which, value] : values) g.condition[which] = value;
    return g;
  }
  Grinder where(sphere::Quantity which, double value) const {
    Grinder g = *this;
    g.q[which] = value;
    return g;
  }
  /// Without values: at null.
  Grinder with(std::string_view name, std::vector<double> values = {}) const {
    Grinder g = *this;
    std::size_t index = 0;
    while (effects::cards()[index]->name != name) ++index;
    g.active.push_back({index, g.e.size()});
    for (const QuantityCard& card : effects::cards()[index]->quantities) {
      const auto i = static_cast<std::size_t>(&card - effects::cards()[index]->quantities.data());
      g.e.push_back(values.empty() ? card.default_value : values.at(i));
    }
    return g;
  }
  Grinder with_all(Draw& draw) const {
    Grinder g = *this;
    for (const EffectCard* card : applicable()) g = g.with(card->name, some(*card, draw));
    return g;
  }

  template <class T> sphere::Contact<T> contact(const std::vector<T>& values, int variant = sphere::exact) const {
    const std::vector<T> x(condition.begin(), condition.end());
    return sphere::contact(variant, values.data(), sphere::links(values.data()), x.data(),
                           sphere::is_pattern_II(condition.data()), true,
                           sphere::Freed<T>{active, values.data() + q.size()});
  }
  std::vector<double> values() const {
    auto v = q;
    v.insert(v.end(), e.begin(), e.end());
    return v;
  }
  Vector3<double> commands(int variant = sphere::exact) const {
    return sphere::simulate(contact<double>(values(), variant));
  }
};

double distance(const Vector3<double>& a, const Vector3<double>& b) { return std::sqrt(dot(a - b, a - b)); }
bool same(const Vector3<double>& a, const Vector3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Both patterns of the thesis, at every pose other times and directions, eight equal samples.
struct Study {
  std::vector<Grinder> poses;
  std::vector<std::vector<double>> x;

  explicit Study(const Grinder& machine) {
    const auto add = [&](double B, double C, double pattern) {
      const double n = static_cast<double>(poses.size());
      poses.push_back(machine.under({{sphere::B, B * deg},
                                     {sphere::C, C * deg},
                                     {sphere::pattern, pattern},
                                     {sphere::time, 60 * n},
                                     {sphere::B_direction, std::fmod(n, 2) == 0 ? 1.0 : -1.0},
                                     {sphere::C_direction, std::fmod(n, 3) == 0 ? 1.0 : -1.0},
                                     {sphere::B_clamped, pattern == 1},
                                     {sphere::C_clamped, pattern == 2}}));
      const auto c = poses.back().commands();
      for (const double command : {c.x, c.y, c.z}) x.emplace_back(8, command);
    };
    for (int C = 0; C <= 90; C += 5) add(0, C, 1);
    for (int B = -20; B <= 45; B += 5) add(B, 90, 2);
  }
  /// The eleven by a joint evaluation that starts from `declared`, in the order of the model's quantities.
  std::vector<double> found(const Grinder& declared, int evaluation) const {
    std::vector<models::Column> quantities, effect_columns, conditions, read;
    for (const Grinder& g : poses) {
      for (const double& v : declared.q) quantities.push_back({&v, 0});
      for (const double& v : declared.e) effect_columns.push_back({&v, 0});
      for (const double& v : g.condition) conditions.push_back({&v, 0});
    }
    for (const auto& row : x) read.push_back({row.data(), 1});
    std::vector<std::vector<double>> out(sphere::joint_rows, std::vector<double>(8));
    std::vector<double*> rows;
    for (auto& row : out) rows.push_back(row.data());
    std::vector<std::uint8_t> status(8, 0);
    models::BlockCall call;
    call.samples = 8;
    call.readings = poses.size();
    call.quantities = quantities.data();
    call.effects = effect_columns.data();
    call.effect_quantities = declared.e.size();
    call.active = declared.active;
    call.conditions = conditions.data();
    call.indications = read.data();
    call.measurands = rows.data();
    call.status = status.data();
    call.evaluation = evaluation;
    models::find("sphere_calibration")->kernels()->evaluate(call);
    std::vector<double> theta;
    for (int j = 0; j < sphere::unknowns; ++j) {
      REQUIRE(status[0] == 0);
      theta.push_back(out[static_cast<std::size_t>(sphere::row_of[j])][0]);
    }
    return theta;
  }
};

} // namespace

TEST_CASE("effects of the sphere at null change nothing, bit for bit", "[laws][effects][sphere_calibration]") {
  Draw draw;
  REQUIRE(applicable().size() == 25);
  for (int n = 0; n < 100; ++n) {
    const Grinder plain = Grinder::random(draw);
    Grinder all = plain;
    for (const int variant : {sphere::exact, sphere::small_angle}) {
      const auto there = plain.commands(variant);
      const Vector3<double> read{0.1, 0.2, 0.3};
      const auto back = sphere::evaluate(read, plain.contact<double>(plain.values(), variant));
      const auto compare = [&](const Grinder& g) {
        REQUIRE(same(g.commands(variant), there));
        REQUIRE(same(sphere::evaluate(read, g.contact<double>(g.values(), variant)), back));
      };
      all = plain;
      for (const EffectCard* card : applicable()) {
        INFO(card->name);
        compare(plain.with(card->name));
        all = all.with(card->name);
      }
      compare(all);
    }
  }
}

TEST_CASE("the sphere's evaluation undoes its simulation, each effect alone and all together",
          "[laws][effects][sphere_calibration]") {
  Draw draw;
  const auto check = [&](const Grinder& g, const Grinder& plain) {
    for (const int variant : {sphere::exact, sphere::small_angle}) {
      const auto at = g.contact<double>(g.values(), variant);
      // Lengths below 2 m, a few roundings more than without effects.
      REQUIRE(distance(sphere::evaluate(sphere::simulate(at), at), at.tip) < 5e-15);
    }
    REQUIRE(distance(g.commands(), plain.commands()) > 1e-9); // not for nothing
  };
  for (int n = 0; n < 50; ++n) {
    const Grinder plain = Grinder::random(draw).under({{sphere::B_clamped, 1}, {sphere::C_clamped, 1}});
    for (const EffectCard* card : applicable()) {
      INFO(card->name);
      check(plain.with(card->name, some(*card, draw)), plain);
    }
    check(plain.with_all(draw), plain);
  }
}

TEST_CASE("joint evaluations find the machine behind any effect", "[laws][effects][sphere_calibration]") {
  Draw draw;
  const auto check = [&](const Grinder& truth) {
    const Study study(truth);
    Grinder declared = truth;
    for (int j = 0; j < sphere::unknowns; ++j)
      declared.q[static_cast<std::size_t>(j)] += (j < sphere::E_A0B ? 1e-3 : 0.2 * deg) * draw(-1, 1);
    const auto joint = study.found(declared, sphere::joint), sequential = study.found(declared, sphere::sequential);
    for (std::size_t j = 0; j < sphere::unknowns; ++j) {
      CAPTURE(j);
      // What ends the steps, 1e-13 m, times the condition number 34.
      REQUIRE(std::fabs(joint[j] - truth.q[j]) < 4e-12);
      // Planes are cleared of the effects by the declared machine: 0.4 % off of 1e-4 rad and 1e-4 m.
      REQUIRE(std::fabs(sequential[j] - truth.q[j]) < 34 * 0.004 * 1e-4);
    }
  };
  for (const EffectCard* card : applicable()) {
    INFO(card->name);
    check(Grinder().with(card->name, some(*card, draw)));
  }
  Grinder square = Grinder();
  for (const auto s : {sphere::S_XY, sphere::S_XZ, sphere::S_YZ}) square.q[s] = draw(-5e-5, 5e-5);
  check(square.with_all(draw));
}

TEST_CASE("derivatives by the sphere's effects agree with differences", "[laws][effects][sphere_calibration]") {
  const auto* model = models::find("sphere_calibration");
  Draw draw;
  for (int n = 0; n < 10; ++n) {
    const Grinder g = Grinder::random(draw).with_all(draw);
    const auto v = g.values();
    for (std::size_t j = 0; j < v.size(); ++j) {
      std::vector<models::Gradient> x(v.begin(), v.end());
      x[j] = models::Gradient::variable(v[j], 0);
      models::Gradient out[3];
      models::PointCall<models::Gradient> call;
      call.quantities = x.data(), call.effects = x.data() + g.q.size(), call.active = g.active;
      call.conditions = g.condition.data(), call.simulated = out;
      REQUIRE(model->simulate_gradient(call).status == 0);
      const auto at = [&](double value) {
        auto moved = v;
        moved[j] = value;
        return sphere::simulate(g.contact<double>(moved));
      };
      // 1e-15 of rounding and h^2 of curvature; a rate or a time constant is measured in thousands of seconds.
      const bool rate = j >= g.q.size() && std::fabs(v[j])<1e-7, time = std::fabs(v[j])> 100;
      const double h = rate ? 1e-9 : time ? 0.1 : 1e-5;
      const auto difference = 1 / (2 * h) * (at(v[j] + h) - at(v[j] - h));
      CAPTURE(j, j - g.q.size());
      const double tolerance = rate ? 1e-5 : 2e-9;
      REQUIRE(std::fabs(out[0].d[0] - difference.x) < tolerance);
      REQUIRE(std::fabs(out[1].d[0] - difference.y) < tolerance);
      REQUIRE(std::fabs(out[2].d[0] - difference.z) < tolerance);
    }
  }
}

TEST_CASE("lanes and scalars give the same bits with every effect", "[laws][effects][sphere_calibration]") {
  Draw draw;
  for (int n = 0; n < 20; ++n) {
    const Grinder g = Grinder::random(draw).with_all(draw);
    const auto v = g.values();
    const std::vector<Lanes> x(v.begin(), v.end());
    const auto lanes = sphere::simulate(g.contact<Lanes>(x));
    const auto plain = g.commands();
    REQUIRE(lanes.x.get(0) == plain.x);
    REQUIRE(lanes.y.get(0) == plain.y);
    REQUIRE(lanes.z.get(0) == plain.z);
  }
}

TEST_CASE("error motions of B and C are those of the general chain", "[effects][sphere_calibration][machine]") {
  Draw draw;
  for (int n = 0; n < 100; ++n) {
    Grinder g = Grinder::random(draw);
    for (int j = sphere::E_XX; j <= sphere::S_YZ; ++j) g.q[static_cast<std::size_t>(j)] = 0;
    g.condition[sphere::direction] = -1;
    const double B = g.condition[sphere::B], C = g.condition[sphere::C], sag = draw(-1, 1) * 1e-4;
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
    (*grinder.tool_side)[2].point = {at(sphere::link_B_x), 0, -at(sphere::link_B_z)};
    (*grinder.tool_side)[3].point = {at(sphere::link_C_x), at(sphere::link_C_y), 0};
    const double reversal = -g.condition[sphere::B_direction] * a[18] / 2,
                 brake = g.condition[sphere::C_clamped] * a[19];
    grinder.errors = {{"E_X0B", at(sphere::E_X0B)},
                      {"E_Z0B", -at(sphere::E_Z0B)}, // ISO's offset is along +Z
                      {"E_X0C", at(sphere::E_X0C)},
                      {"E_Y0C", at(sphere::E_Y0C)},
                      {"E_A0B", at(sphere::E_A0B)},
                      {"E_C0B", at(sphere::E_C0B)},
                      {"E_A0C", at(sphere::E_A0C)},
                      {"E_B0C", at(sphere::E_B0C)},
                      {"E_AA", at(sphere::E_AA)},
                      {"E_BB", at(sphere::E_BB) + pair(2, B) + pair(6, 2 * B) + reversal},
                      {"E_CC", at(sphere::E_CC) + pair(0, C) + pair(4, 2 * C) + brake},
                      {"E_XC", pair(8, 2 * C)},
                      {"E_YC", pair(10, 2 * C)},
                      {"E_ZC", pair(12, 2 * C)},
                      {"E_AC", pair(14, 2 * C)},
                      {"E_BC", pair(16, 2 * C)},
                      {"E_ZB", -sag * std::sin(B)}};
    const chain::Machine machine(grinder);
    const auto xyz = g.commands();
    const double commands[] = {xyz.x, g.condition[sphere::A], xyz.y, xyz.z, B, C};
    const Vector3<double> probe{at(sphere::probe_x), -at(sphere::probe_y), -at(sphere::probe_z)};
    const auto tip = machine.bed_from_tool(commands, machine.errors().data()) * probe;
    auto top = machine.bed_from_workpiece(commands, machine.errors().data()) *
               Vector3<double>{-at(sphere::sphere_distance), at(sphere::sphere_y), at(sphere::sphere_z)};
    top.z += at(sphere::sphere_radius) + at(sphere::tip_radius);
    REQUIRE(distance(tip, top) < 5e-15);
    // The approach, turned into the probe's frame by the same chain without errors.
    grinder.errors = {};
    const chain::Machine ideal(grinder);
    const auto turn = ideal.bed_from_tool(commands, ideal.errors().data()).turn;
    REQUIRE(distance(transposed(turn) * Vector3<double>{0, 0, -1}, chain::approach_in_probe(-1.0, B, C)) < 1e-15);
  }
}

TEST_CASE("a slide that goes too far reads less", "[effects][sphere_calibration]") {
  const Grinder g = Grinder().under({{sphere::B, 20 * deg}, {sphere::C, 50 * deg}, {sphere::time, 3600}});
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
  const Grinder g = Grinder().under({{sphere::B, 20 * deg}, {sphere::C, 50 * deg}});
  const auto turned = [&](double by_B, double by_C) {
    return g.where(sphere::E_BB, by_B).where(sphere::E_CC, by_C).commands();
  };
  const auto up = g.with("c_axis_reversal", {6 * arcsec}), down = up.under({{sphere::C_direction, -1}});
  REQUIRE(distance(up.commands(), turned(0, -3 * arcsec)) < 1e-15);
  REQUIRE(distance(down.commands(), turned(0, 3 * arcsec)) < 1e-15);
  REQUIRE(same(up.under({{sphere::C_direction, 0}}).commands(), g.commands()));
  const auto held = g.with("b_brake_shift", {4 * arcsec});
  REQUIRE(same(held.commands(), g.commands()));
  REQUIRE(distance(held.under({{sphere::B_clamped, 1}}).commands(), turned(4 * arcsec, 0)) < 1e-15);
  // 5 um of eccentricity on 100 mm: 412 * 5 / 100 arcsec, 20.6.
  const double e = 5 * um / (100e-3 / 2);
  REQUIRE(e / arcsec == Approx(412.0 * 5 / 100).epsilon(2e-3));
  REQUIRE(distance(g.with("c_encoder_eccentricity", {0, e}).commands(), turned(0, e * std::sin(50 * deg))) < 1e-15);
}

TEST_CASE("the probe triggers late", "[effects][sphere_calibration]") {
  const auto at = [](double B, double C) { return Grinder().under({{sphere::B, B * deg}, {sphere::C, C * deg}}); };
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
      REQUIRE(std::fabs(lower(at(B, C).under({{sphere::feed, 0.5e-3}}), "trigger_latency", {2e-3}) - 1 * um) <
              rounding);
      // Three lobes over the azimuth of the approach, which is that of -C, or opposite.
      REQUIRE(std::fabs(lower(at(B, C), "pretravel_lobing", {5 * um, 0}) - 5 * um * s * s * s * std::cos(3 * C * deg)) <
              rounding);
      REQUIRE(std::fabs(lower(at(B, C), "pretravel_lobing", {0, 5 * um}) + 5 * um * s * s * s * std::sin(3 * C * deg)) <
              rounding);
    }
}
