/// Identification of probe and axes from all poses together: the truth comes back, what the data cannot see is left.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "asked.h"
#include "laws/sphere_rows.h"

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

namespace {

constexpr double deg = 3.14159265358979323846 / 180, um = 1e-6;
constexpr int methods[] = {sphere::sequential, sphere::joint, sphere::joint_weighted};

struct Draw {
  std::mt19937_64 engine{4502};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  double normal() { return std::sqrt(-2 * std::log(1 - (*this)(0, 1))) * std::cos(360 * deg * (*this)(0, 1)); }
};

using Quantities = std::vector<double>;
Quantities published() {
  Quantities q;
  for (const auto& card : models::find("sphere_calibration")->card->quantities) q.push_back(card.default_value);
  return q;
}
Quantities random_machine(Draw& draw) {
  Quantities q = published();
  for (int j = 0; j < 3; ++j) q[Row::probe_x + j] = draw(0.1, 0.5);
  for (std::size_t j = Row::E_X0B; j <= Row::E_Y0C; ++j) q[j] = draw(-1e-3, 1e-3);
  for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j) q[j] = draw(-1, 1) * deg;
  for (std::size_t j = Row::link_B_x; j <= Row::link_C_y; ++j) q[j] = draw(-0.3, 0.3);
  q[Row::sphere_y] = draw(-1e-3, 1e-3), q[Row::sphere_z] = draw(-1e-3, 1e-3);
  return q;
}

struct Place {
  double B, C, label;
};
std::vector<Place> pattern_I() {
  std::vector<Place> out;
  for (int C = 0; C <= 90; C += 5) out.push_back({0, 1.0 * C, 1});
  return out;
}
std::vector<Place> pattern_II() {
  std::vector<Place> out;
  for (int B = -20; B <= 45; B += 5) out.push_back({1.0 * B, 90, 2});
  return out;
}
std::vector<Place> both() {
  auto out = pattern_I();
  for (const Place& pose : pattern_II()) out.push_back(pose);
  return out;
}

/// Eight samples at many poses, through the model's own kernels.
struct Study {
  std::vector<Place> poses;
  std::vector<std::vector<double>> condition, x; ///< [reading][...], [3 reading + axis][8]
  models::Declared declared;

  explicit Study(std::vector<Place> p) : poses(std::move(p)), x(3 * poses.size(), std::vector<double>(8)) {
    for (const Place& pose : poses) {
      condition.emplace_back(tests::conditions, 0.0);
      condition.back()[Commanded::B] = pose.B * deg;
      condition.back()[Commanded::C] = pose.C * deg;
      condition.back()[Commanded::pattern] = pose.label;
    }
  }
  propagation::BlockValues ask(const std::vector<Quantities>& q, int evaluation, bool simulates) {
    propagation::ForwardModel forward(*models::find("sphere_calibration"), {}, static_cast<std::size_t>(evaluation),
                                      condition);
    forward.declare(declared);
    propagation::Block block;
    block.clear(8);
    std::vector<std::vector<std::vector<double>>> columns;
    for (std::size_t r = 0; r < poses.size(); ++r) {
      columns.push_back(tests::columns_of(q[q.size() == 1 ? 0 : r]));
      for (std::size_t k = 0; k < 3; ++k) columns[r].push_back(x[3 * r + k]);
      tests::add(block, forward, r, columns[r]);
    }
    return simulates ? forward.simulate(block) : forward.evaluate(block);
  }
  void measure(const std::vector<Quantities>& q) {
    const auto found = ask(q, sphere::joint, true);
    for (std::size_t i = 0; i < x.size(); ++i) std::copy_n(&found.indications[8 * i], 8, x[i].begin());
    take(found);
  }
  void identify(const Quantities& estimates, int evaluation) { take(ask({estimates}, evaluation, false)); }
  void take(const propagation::BlockValues& found) {
    results.clear();
    for (std::size_t row = 0; row < std::size(sphere::joint_cards); ++row)
      results.emplace_back(&found.measurands[8 * row], &found.measurands[8 * row] + 8);
    status = found.status;
  }
  /// Independent noise of every command, u in m, and of B and C, u in rad.
  void declare(const Quantities& estimates, double linear, double rotary = 0) {
    declared = {};
    for (std::size_t r = 0; r < poses.size(); ++r) {
      declared.estimates.insert(declared.estimates.end(), estimates.begin(), estimates.end());
      for (std::size_t k = 0; k < 3; ++k) declared.draws.push_back({linear, {{r, tests::quantities + k}}});
      if (rotary > 0)
        declared.draws.push_back(
            {rotary, {{r, static_cast<std::size_t>(poses[r].label == 1 ? Row::E_CC : Row::E_BB)}}});
    }
  }
  double found(int unknown, std::size_t i = 0) const {
    return results[tests::row_of(static_cast<std::size_t>(unknown))][i];
  }
  std::vector<std::vector<double>> results;
  std::vector<std::uint8_t> status;
};

} // namespace

TEST_CASE("noiseless commands give the machine back by every method", "[laws][sphere_calibration][identification]") {
  Draw draw;
  for (int n = 0; n < 20; ++n) {
    const auto truth = random_machine(draw);
    auto estimates = truth;
    // Links and artefact are known; the start is off by millimetres and a degree.
    for (std::size_t j = 0; j <= Row::E_Y0C; ++j) estimates[j] += draw(-5e-3, 5e-3);
    for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j) estimates[j] = draw(-1, 1) * deg;
    Study study(both());
    if (n % 2)
      for (auto& condition : study.condition) condition[Commanded::A] = draw(-3, 3);
    study.declare(estimates, 2 * um, 1e-4);
    study.measure({truth});
    for (const int method : methods) {
      study.identify(estimates, method);
      CAPTURE(n, method);
      for (int i = 0; i < 8; ++i) REQUIRE(study.status[i] == 0);
      // 2e-16 of a length of 1 m, some 10 of these, times the condition number of 34 to 200.
      for (int j = 0; j < sphere::unknowns; ++j) CHECK(std::fabs(study.found(j) - truth[j]) < 1e-12);
      CHECK(study.results[Found::residual_rms][0] < 1e-14);
      CHECK(study.results[Found::rank][0] == 11);
    }
  }
}

TEST_CASE("rank and condition of the published poses", "[laws][sphere_calibration][identification]") {
  const auto q = published();
  Study study(both());
  study.measure({q});
  study.identify(q, sphere::joint);
  CHECK(study.results[Found::rank][0] == 11);
  CHECK(std::fabs(study.results[Found::condition_number][0] - 34) <
        0.5); // by numpy's SVD: facts of the thesis' chapter
}

TEST_CASE("what the poses cannot see stays as declared", "[laws][sphere_calibration][identification]") {
  const auto truth = published();
  auto estimates = truth;
  estimates[Row::probe_x] += 1e-3, estimates[Row::E_A0B] = 0, estimates[Row::E_X0B] = 2e-3;
  struct Case {
    std::vector<Place> poses;
    int rank;
  };
  std::vector<Case> cases{{pattern_I(), 7}, {pattern_II(), 7}, {{{0, 90, 1}, {20, 90, 2}}, 0}, {both(), 11}};
  cases.back().poses.push_back(cases.back().poses.back()); // a pose repeated
  for (const auto& [poses, rank] : cases)
    for (const int method : methods) {
      Study study(poses);
      study.declare(estimates, 2 * um);
      study.measure({truth});
      study.identify(estimates, method);
      CAPTURE(poses.size(), method);
      REQUIRE(study.status[0] == 0);
      if (rank > 0) CHECK(study.results[Found::rank][0] == rank);
      if (rank == 0) CHECK(study.results[Found::rank][0] < 7); // two points, six numbers
      // Two poses are no planes: the wrong orientations declared stay in the sequential method.
      if (rank > 0 || method != sphere::sequential) CHECK(study.results[Found::residual_rms][0] < 1e-13);
      if (poses.size() == pattern_I().size()) { // at B = 0 nothing is seen of the B axis
        for (const std::size_t j : {Row::E_X0B, Row::E_Z0B, Row::E_A0B, Row::E_C0B})
          CHECK(study.found(static_cast<int>(j)) == estimates[j]);
        CHECK(std::fabs(study.found(Row::E_A0C) - truth[Row::E_A0C]) < 1e-12);
      }
    }
}

TEST_CASE("a constant shift of the artefact goes into probe and axes without a residual",
          "[laws][sphere_calibration][identification]") {
  const auto truth = published();
  auto estimates = truth;
  estimates[Row::sphere_distance] += 10 * um;
  for (const int method : methods) {
    Study study(both());
    study.declare(estimates, 2 * um);
    study.measure({truth});
    study.identify(estimates, method);
    for (int j = 0; j < sphere::unknowns; ++j) {
      const bool moves = j == Row::probe_x || j == Row::E_X0B || j == Row::E_X0C;
      CHECK(std::fabs(study.found(j) - truth[j] - (moves ? -10 * um : 0)) < 1e-12);
    }
    CHECK(study.results[Found::residual_rms][0] < 1e-14);
  }
}

TEST_CASE("planes are immune to the positioning of the axis that moves", "[laws][sphere_calibration][identification]") {
  const auto truth = published();
  Draw draw;
  Study study(both());
  std::vector<Quantities> each(study.poses.size(), truth);
  for (std::size_t r = 0; r < each.size(); ++r)
    each[r][study.poses[r].label == 1 ? Row::E_CC : Row::E_BB] = draw(-0.04, 0.04) * deg;
  study.measure(each);
  study.identify(truth, sphere::sequential);
  for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j)
    CHECK(std::fabs(study.found(static_cast<int>(j)) - truth[j]) < 1e-13);
  CHECK(std::fabs(study.found(Row::E_X0C) - truth[Row::E_X0C]) > 1 * um);
  study.identify(truth, sphere::joint); // here equal weights are worse
  CHECK(std::fabs(study.found(Row::E_B0C) - truth[Row::E_B0C]) > 1e-4 * deg);
}

TEST_CASE("known errors of the axis that a pattern holds are corrected for, reading by reading",
          "[laws][sphere_calibration][identification]") {
  Draw draw;
  for (int n = 0; n < 5; ++n) {
    const auto truth = random_machine(draw);
    auto estimates = truth; // known to a millimetre and to 0.05 deg
    for (std::size_t j = 0; j <= Row::E_Y0C; ++j) estimates[j] += draw(-1e-3, 1e-3);
    for (std::size_t j = Row::E_A0B; j <= Row::E_B0C; ++j) estimates[j] += draw(-0.05, 0.05) * deg;
    Study study(both());
    std::vector<Quantities> each(study.poses.size(), truth), known(study.poses.size(), estimates);
    for (std::size_t r = 0; r < each.size(); ++r)
      for (const auto e : {Row::E_BB, Row::E_CC}) each[r][e] = known[r][e] = draw(-0.02, 0.02) * deg;
    study.declare(estimates, 2 * um, 1e-4);
    study.measure(each);
    study.take(study.ask(known, sphere::sequential, false));
    CAPTURE(n);
    REQUIRE(study.status[0] == 0);
    // An error E of 3.5e-4 rad is corrected with the machine found without that: its own error is E times 1 mm times
    // what the planes make of that, some 10 rad/m; once more makes (10 E)^2 of 1 mm.
    for (int j = 0; j < sphere::unknowns; ++j) CHECK(std::fabs(study.found(j) - truth[j]) < 1e-7);
  }
}

TEST_CASE("weights know which draws are correlated", "[laws][sphere_calibration][identification]") {
  // Gauss and Markov's estimate from the model's own derivatives, without its code for weights.
  const auto truth = published();
  Draw draw;
  Study study(both());
  const auto n = static_cast<Eigen::Index>(3 * study.poses.size());
  Eigen::MatrixXd J(n, sphere::unknowns), V = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    auto up = truth, down = truth;
    constexpr double step = 1e-6;
    up[static_cast<std::size_t>(j)] += step, down[static_cast<std::size_t>(j)] -= step;
    study.measure({up});
    const auto above = study.x;
    study.measure({down});
    for (Eigen::Index i = 0; i < n; ++i)
      J(i, j) = (above[static_cast<std::size_t>(i)][0] - study.x[static_cast<std::size_t>(i)][0]) / (2 * step);
  }
  // X and Z of a reading share most of their noise; Y is four times as good.
  constexpr double u[] = {2 * um, 0.5 * um, 2 * um}, shared = -0.95;
  study.declare(truth, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    study.declared.draws[static_cast<std::size_t>(i)].u = u[i % 3];
    V(i, i) = u[i % 3] * u[i % 3];
    if (i % 3 != 0) continue;
    V(i, i + 2) = V(i + 2, i) = shared * u[0] * u[2];
    study.declared.ties.push_back({static_cast<std::size_t>(i + 2), static_cast<std::size_t>(i), shared});
  }
  study.measure({truth});
  Eigen::VectorXd noise(n);
  for (Eigen::Index i = 0; i < n; ++i) noise[i] = u[i % 3] * draw.normal();
  for (Eigen::Index i = 0; i < n; ++i)
    for (double& x : study.x[static_cast<std::size_t>(i)]) x += noise[i];
  const auto expected = [&](const Eigen::MatrixXd& covariance) -> Eigen::VectorXd {
    const Eigen::MatrixXd weighted = covariance.llt().solve(J);
    return (J.transpose() * weighted).ldlt().solve(weighted.transpose() * noise);
  };
  study.identify(truth, sphere::joint_weighted);
  const Eigen::VectorXd with = expected(V), without = expected(V.diagonal().asDiagonal());
  // Second order of changes below 1e-5 (in m, rad) with derivatives of order 1.
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    CHECK(std::fabs(study.found(static_cast<int>(j)) - truth[static_cast<std::size_t>(j)] - with[j]) < 1e-9);
  CHECK((with - without).cwiseAbs().maxCoeff() > 1e-7); // the case tells them apart
}
