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
      poses.push_back(machine.under({{Commanded::B, B * deg},
                                     {Commanded::C, C * deg},
                                     {Commanded::pattern, pattern},
                                     {Commanded::time, 60 * n},
                                     {Commanded::B_direction, std::fmod(n, 2) == 0 ? 1.0 : -1.0},
                                     {Commanded::C_direction, std::fmod(n, 3) == 0 ? 1.0 : -1.0},
                                     {Commanded::B_clamped, pattern == 1},
                                     {Commanded::C_clamped, pattern == 2}}));
      const auto c = poses.back().commands();
      for (const double command : {c.x, c.y, c.z}) x.emplace_back(8, command);
    };
    for (int C = 0; C <= 90; C += 5) add(0, C, 1);
    for (int B = -20; B <= 45; B += 5) add(B, 90, 2);
  }
  /// Largest change of the commands by the effects, m.
  double moved() const {
    double most = 0;
    for (const Grinder& pose : poses) {
      Grinder plain = pose;
      plain.active.clear();
      most = std::max(most, distance(pose.commands(), plain.commands()));
    }
    return most;
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
      theta.push_back(found.measurands[8 * tests::row_of(static_cast<std::size_t>(j))]);
    }
    return theta;
  }
};

} // namespace

TEST_CASE("joint evaluations find the machine behind any effect", "[laws][effects][sphere_calibration]") {
  Draw draw;
  const auto check = [&](const Grinder& truth) {
    const Study study(truth);
    Grinder declared = truth;
    for (int j = 0; j < sphere::unknowns; ++j)
      declared.q[static_cast<std::size_t>(j)] += (static_cast<std::size_t>(j) < Row::E_A0B ? 1e-3 : 0.2 * deg) * draw(-1, 1);
    const auto joint = study.found(declared, sphere::joint), sequential = study.found(declared, sphere::sequential);
    for (std::size_t j = 0; j < sphere::unknowns; ++j) {
      CAPTURE(j);
      // What ends the steps, 1e-13 m, times the condition number 34.
      REQUIRE(std::fabs(joint[j] - truth.q[j]) < 4e-12);
      // Planes are cleared of the effects by the declared machine: 0.4 % off of 1e-4 rad, and of what they move.
      REQUIRE(std::fabs(sequential[j] - truth.q[j]) < 34 * 0.004 * std::max(1e-4, study.moved()));
    }
  };
  for (const EffectCard* card : applicable()) {
    INFO(card->name);
    check(Grinder().with(card->name, some(*card, draw)));
  }
  Grinder square = Grinder();
  for (const auto s : {Row::S_XY, Row::S_XZ, Row::S_YZ}) square.q[s] = draw(-5e-5, 5e-5);
  check(square.with_all(draw));
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
