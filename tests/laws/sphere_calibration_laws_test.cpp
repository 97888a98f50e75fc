/// Laws of the sphere calibration that hold whatever the numbers are.
#include <catch2/catch.hpp>

#include <random>

#include "asked.h"
#include "chain/machine.h"
#include "laws/sphere_rows.h"

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

namespace {

constexpr double deg = 3.14159265358979323846 / 180;
constexpr std::size_t samples = 512;

struct Draw {
  std::mt19937_64 engine{4430};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

/// Any machine: links and probe up to 0.5 m, location errors up to a degree, all other errors at once.
std::vector<double> random_quantities(Draw& draw) {
  std::vector<double> q(tests::quantities);
  const auto fill = [&](std::size_t from, std::size_t to, double size) {
    for (std::size_t j = from; j <= to; ++j) q[j] = draw(-size, size);
  };
  fill(Row::probe_x, Row::probe_z, 0.5), fill(Row::E_X0B, Row::E_Y0C, 1e-3);
  fill(Row::E_A0B, Row::E_B0C, 1 * deg), fill(Row::link_B_x, Row::link_C_y, 0.3);
  fill(Row::sphere_distance, Row::sphere_z, 0.2);
  for (const auto radius : {Row::sphere_radius, Row::tip_radius}) q[radius] = std::fabs(q[radius]);
  fill(Row::E_AA, Row::E_CC, 0.05 * deg);
  fill(Row::E_XX, Row::E_ZZ, 5e-6), fill(Row::S_XY, Row::S_YZ, 5e-5);
  return q;
}
std::vector<double> random_condition(Draw& draw) {
  return {draw(-180, 180) * deg, draw(-120, 120) * deg, draw(-180, 180) * deg, 0, 0, -1, 0, 0.5e-3, 1, 1, 0, 0};
}

/// Two readings of many samples through the block kernels.
struct Run {
  std::vector<double> simulated, tip;
  std::vector<std::uint8_t> status;
  Run(const std::vector<std::vector<double>>& q, const std::vector<std::vector<double>>& condition, int variant,
      const std::vector<double>* read = nullptr) {
    const propagation::ForwardModel forward(*models::find("sphere_calibration"), {}, static_cast<std::size_t>(variant),
                                            condition);
    propagation::Block block;
    block.clear(samples);
    std::vector<std::vector<double>> columns[2];
    for (std::size_t r = 0; r < 2; ++r) {
      columns[r] = q;
      for (std::size_t k = 0; k < 3; ++k)
        columns[r].push_back(read ? std::vector<double>(read->begin() + static_cast<std::ptrdiff_t>((3 * r + k) * samples),
                                                        read->begin() +
                                                            static_cast<std::ptrdiff_t>((3 * r + k + 1) * samples))
                                  : std::vector<double>{0.0});
      tests::add(block, forward, r, columns[r]);
    }
    auto found = read ? forward.evaluate(block) : forward.simulate(block);
    simulated = std::move(found.indications), tip = std::move(found.measurands), status = std::move(found.status);
  }
};

std::vector<std::vector<double>> random_columns(Draw& draw) {
  std::vector<std::vector<double>> columns(tests::quantities, std::vector<double>(samples));
  for (std::size_t i = 0; i < samples; ++i) {
    const auto q = random_quantities(draw);
    for (std::size_t j = 0; j < q.size(); ++j) columns[j][i] = q[j];
  }
  return columns;
}

template <class T>
std::vector<T> simulated(const std::vector<T>& q, const std::vector<double>& condition, int variant) {
  const auto v = sphere::simulate(sphere::contact(tests::reading(variant, q.data(), condition)));
  return {v.x, v.y, v.z};
}

} // namespace

TEST_CASE("evaluate undoes simulate: the tip stands above the sphere", "[laws][sphere_calibration]") {
  Draw draw;
  const auto q = random_columns(draw);
  for (const int variant : {sphere::exact, sphere::small_angle, sphere::closed_form}) {
    std::vector<std::vector<double>> condition{random_condition(draw), random_condition(draw)};
    if (variant == sphere::closed_form) condition[0][Commanded::B] = 0, condition[1][Commanded::C] = 90 * deg;
    const Run there(q, condition, variant), back(q, condition, variant, &there.simulated);
    for (std::size_t i = 0; i < samples; ++i) {
      REQUIRE(there.status[i] == 0);
      const auto column = [&](int j) { return q[static_cast<std::size_t>(j)][i]; };
      for (std::size_t r = 0; r < 2; ++r) {
        const double A = condition[r][Commanded::A] + column(Row::E_AA);
        const double y = column(Row::sphere_y) * std::cos(A) - column(Row::sphere_z) * std::sin(A);
        const double z = column(Row::sphere_y) * std::sin(A) + column(Row::sphere_z) * std::cos(A) +
                         column(Row::sphere_radius) + column(Row::tip_radius);
        const double expected[] = {-column(Row::sphere_distance), y, z};
        for (std::size_t k = 0; k < 3; ++k) // lengths below 2 m, a few roundings
          REQUIRE(std::fabs(back.tip[(3 * r + k) * samples + i] - expected[k]) < 3e-15);
      }
    }
  }
}

TEST_CASE("lanes, scalars and dual numbers give the same bits", "[laws][sphere_calibration]") {
  Draw draw;
  const auto q = random_columns(draw);
  const std::vector<std::vector<double>> condition{random_condition(draw), random_condition(draw)};
  for (const int variant : {sphere::exact, sphere::small_angle}) {
    const Run run(q, condition, variant);
    for (std::size_t i = 0; i < samples; i += 7)
      for (std::size_t r = 0; r < 2; ++r) {
        std::vector<double> plain;
        for (const auto& column : q) plain.push_back(column[i]);
        const auto one = simulated(plain, condition[r], variant);
        std::vector<models::Gradient> x(plain.begin(), plain.end());
        for (int j = 0; j < 8; ++j)
          x[static_cast<std::size_t>(j)] = models::Gradient::variable(plain[static_cast<std::size_t>(j)], j);
        const auto dual = simulated(x, condition[r], variant);
        for (std::size_t k = 0; k < 3; ++k) {
          REQUIRE(one[k] == run.simulated[(3 * r + k) * samples + i]);
          REQUIRE(dual[k].v == one[k]);
        }
      }
  }
}

TEST_CASE("the probe is linear in the seven lengths by the stated matrix", "[laws][sphere_calibration]") {
  Draw draw;
  for (int i = 0; i < 50; ++i) {
    const auto q = random_quantities(draw);
    const auto l = tests::links(q);
    const double B = draw(-2, 2), C = draw(-3, 3);
    for (const auto& turns : {sphere::exact_turns(l.lines, B, C), sphere::small_angle_turns(l.tilted, B, C)}) {
      const auto columns = sphere::probe_by_lengths(turns);
      Vector3<double> sum;
      for (std::size_t j = 0; j < sphere::lengths; ++j) sum = sum + l.length[j] * columns[j];
      const auto r = sphere::probe_from_origin(l.length, turns);
      // Sums of 14 products below 1 m.
      REQUIRE(std::fabs(sum.x - r.x) < 3e-15);
      REQUIRE(std::fabs(sum.y - r.y) < 3e-15);
      REQUIRE(std::fabs(sum.z - r.z) < 3e-15);
    }
    const sphere::Directions<Lanes> lines{{Lanes(l.lines.b.x), Lanes(l.lines.b.y), Lanes(l.lines.b.z)},
                                          {Lanes(l.lines.c.x), Lanes(l.lines.c.y), Lanes(l.lines.c.z)}};
    const auto lanes = sphere::probe_by_lengths(sphere::exact_turns(lines, Lanes(B), Lanes(C)));
    const auto plain = sphere::probe_by_lengths(sphere::exact_turns(l.lines, B, C));
    for (std::size_t j = 0; j < sphere::lengths; ++j) REQUIRE(lanes[j].y.get(0) == plain[j].y);
  }
}

TEST_CASE("the grinder's probe is that of the general chain", "[laws][sphere_calibration][machine]") {
  Draw draw;
  for (int i = 0; i < 100; ++i) {
    auto q = random_quantities(draw);
    for (std::size_t j = Row::E_XX; j <= Row::S_YZ; ++j) q[static_cast<std::size_t>(j)] = 0;
    const auto at = [&](int j) { return q[static_cast<std::size_t>(j)]; };
    auto grinder = *chain::find_machine("grinder");
    (*grinder.tool_side)[2].point = {at(Row::link_B_x), 0, -at(Row::link_B_z)};
    (*grinder.tool_side)[3].point = {at(Row::link_C_x), at(Row::link_C_y), 0};
    grinder.errors = {{"E_X0B", at(Row::E_X0B)}, {"E_Z0B", -at(Row::E_Z0B)}, // ISO's offset is along +Z
                      {"E_X0C", at(Row::E_X0C)}, {"E_Y0C", at(Row::E_Y0C)},  {"E_A0B", at(Row::E_A0B)},
                      {"E_C0B", at(Row::E_C0B)}, {"E_A0C", at(Row::E_A0C)},  {"E_B0C", at(Row::E_B0C)},
                      {"E_AA", at(Row::E_AA)},   {"E_BB", at(Row::E_BB)},    {"E_CC", at(Row::E_CC)}};
    const chain::Machine machine(grinder);
    const auto condition = random_condition(draw);
    const auto xyz = simulated(q, condition, sphere::exact);
    const double commands[] = {xyz[0], condition[Commanded::A], xyz[1],
                               xyz[2], condition[Commanded::B], condition[Commanded::C]};
    const Vector3<double> probe{at(Row::probe_x), -at(Row::probe_y), -at(Row::probe_z)};
    const auto tip = machine.bed_from_tool(commands, machine.errors().data()) * probe;
    const auto centre = machine.bed_from_workpiece(commands, machine.errors().data()) *
                        Vector3<double>{-at(Row::sphere_distance), at(Row::sphere_y), at(Row::sphere_z)};
    // The tip stands above the sphere's centre, by both radii.
    REQUIRE(std::fabs(tip.x - centre.x) < 3e-15);
    REQUIRE(std::fabs(tip.y - centre.y) < 3e-15);
    REQUIRE(std::fabs(tip.z - centre.z - at(Row::sphere_radius) - at(Row::tip_radius)) < 3e-15);
  }
}

TEST_CASE("commands of one pattern lie on a circle about the actual axis", "[laws][sphere_calibration]") {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    auto q = random_quantities(draw);
    for (std::size_t j = Row::E_AA; j <= Row::S_YZ; ++j) q[static_cast<std::size_t>(j)] = 0;
    const auto l = tests::links(q);
    for (const bool turns_C : {true, false}) {
      std::vector<Vector3<double>> at;
      for (int step = 0; step < 8; ++step) {
        std::vector<double> condition(tests::conditions, 0.0);
        condition[turns_C ? Commanded::C : Commanded::B] = 0.4 * step;
        if (!turns_C) condition[Commanded::C] = 0.9;
        const auto v = simulated(q, condition, sphere::exact);
        at.push_back({v[0], v[1], v[2]});
      }
      // C's line at B = 0 is c itself, B's is b: commands differ by rotations about it.
      const auto axis = turns_C ? l.lines.c : l.lines.b;
      const double chord = std::sqrt(dot(at[1] - at[0], at[1] - at[0]));
      for (std::size_t s = 1; s < at.size(); ++s) {
        const auto step = at[s] - at[s - 1];
        REQUIRE(std::fabs(dot(step, axis)) < 3e-15);
        REQUIRE(std::fabs(std::sqrt(dot(step, step)) - chord) < 5e-15);
      }
    }
  }
}

TEST_CASE("a shift of the artefact along X is the probe and both axes, shifted back", "[laws][sphere_calibration]") {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    const auto q = random_quantities(draw);
    auto shifted = q;
    shifted[Row::sphere_distance] += 1e-5;
    for (const std::size_t j : {Row::probe_x, Row::E_X0B, Row::E_X0C}) shifted[static_cast<std::size_t>(j)] -= 1e-5;
    const auto condition = random_condition(draw);
    const auto a = simulated(q, condition, sphere::exact), b = simulated(shifted, condition, sphere::exact);
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::fabs(a[k] - b[k]) < 3e-15);
  }
}

TEST_CASE("a reading of neither pattern has no closed form", "[laws][sphere_calibration]") {
  Draw draw;
  const auto q = random_columns(draw);
  auto condition = std::vector<std::vector<double>>(2, std::vector<double>(tests::conditions, 0.0));
  condition[1][Commanded::B] = 0.2, condition[1][Commanded::C] = 1.0;
  const Run run(q, condition, sphere::closed_form);
  for (const auto status : run.status) REQUIRE(status == 3); // out_of_domain
  condition[1][Commanded::C] = 90 * deg;
  const Run fine(q, condition, sphere::closed_form);
  for (const auto status : fine.status) REQUIRE(status == 0);
}
