/// Effects of the sphere calibration: laws that hold for every one of them.
#include "asked.h"
#include "laws/sphere_effects_case.h"

using namespace sphere_effects_case;

namespace {

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
    std::vector<std::vector<double>> conditions;
    for (const Grinder& g : poses) conditions.push_back(g.condition);
    const propagation::ForwardModel forward(*models::find("sphere_calibration"), tests::cards_of(declared.active),
                                            static_cast<std::size_t>(evaluation), conditions);
    propagation::Block block;
    block.clear(8);
    std::vector<std::vector<std::vector<double>>> columns;
    columns.reserve(poses.size());
    for (std::size_t r = 0; r < poses.size(); ++r) {
      columns.push_back(tests::columns_of(declared.values()));
      for (std::size_t k = 0; k < 3; ++k) columns[r].emplace_back(x[3 * r + k].begin(), x[3 * r + k].end());
      tests::add(block, forward, r, columns[r]);
    }
    const auto found = forward.evaluate(block);
    std::vector<double> theta;
    for (int j = 0; j < sphere::unknowns; ++j) {
      REQUIRE(found.status[0] == 0);
      theta.push_back(found.measurands[8 * static_cast<std::size_t>(sphere::row_of[j])]);
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
  Draw draw;
  for (int n = 0; n < 10; ++n) {
    const Grinder g = Grinder::random(draw).with_all(draw);
    const propagation::ForwardModel forward(*models::find("sphere_calibration"), tests::cards_of(g.active), 0,
                                            {g.condition});
    const auto v = g.values();
    for (std::size_t j = 0; j < v.size(); ++j) {
      std::vector<models::Gradient> x(v.begin(), v.end());
      x[j] = models::Gradient::variable(v[j], 0);
      x.resize(forward.layout().size());
      std::vector<models::Gradient> out;
      REQUIRE(forward.indications(0, x, out).status == 0);
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
