/// Noise as a coarse display shows it, against readings made one by one.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tracing/noise/coarse_steps.h"

using namespace gumshoe::tracing;

namespace {

constexpr double um = 1e-6;

/// Three targets, each read ten times, in steps of 1 um. Noise in units of a tenth of one.
Design axis() {
  Design d;
  constexpr Index rows = 30;
  d.fixed = Matrix::Ones(rows, 1);
  d.fixed_names = {"zero"};
  d.random.resize(rows, 0);
  d.reference = {0.1 * um};
  d.step = {um};
  d.coarse = {true};
  for (Index i = 0; i < rows; ++i) {
    d.reading.push_back(static_cast<std::size_t>(i));
    d.local.push_back(Matrix::Constant(1, 1, 0.1 * um));
  }
  return d;
}

std::vector<Index> all() {
  std::vector<Index> out;
  for (Index i = 0; i < 30; ++i) out.push_back(i);
  return out;
}

} // namespace

TEST_CASE("readings in steps scatter as the series says, and their noise is found again", "[tracing]") {
  const Matrix z = normals(400, 2000, 17, 0); // 400 places between two steps, 2,000 readings of each
  for (const double noise : {0.02, 0.1, 0.3, 0.6}) {
    double sum = 0;
    for (Index p = 0; p < z.rows(); ++p) {
      const double place = (static_cast<double>(p) + 0.5) / static_cast<double>(z.rows());
      const Vector read = (noise * z.row(p).transpose().array() + place).round();
      sum += (read.array() - read.mean()).square().mean();
    }
    INFO(noise);
    // Of 800,000 readings: 1 % and less, of the few that are off by a step where there is little noise.
    CHECK(scatter_read(noise, 1) == Approx(std::sqrt(sum / static_cast<double>(z.rows()))).epsilon(0.01));
    CHECK(scatter_read(3 * noise, 3) == Approx(3 * scatter_read(noise, 1)));
    CHECK(noise_before_steps(scatter_read(noise, 1), 1) == Approx(noise).epsilon(1e-6));
  }
  CHECK(scatter_read(2, 1) == Approx(std::sqrt(4 + 1.0 / 12))); // much noise: rounding is independent of it
  CHECK(scatter_read(1e-6, 1) == Approx(std::sqrt(1e-6 / std::sqrt(3.14159265358979))));
  CHECK(scatter_read(1e-3 / 6.28, 1) == Approx(scatter_read(1.001e-3 / 6.28, 1)).epsilon(1e-3)); // where the series ends
  CHECK(noise_before_steps(0, 1) == 0);
}

TEST_CASE("draws are read in the steps of the data, at places drawn anew", "[tracing]") {
  const Design d = axis();
  Vector predicted(30);
  for (Index i = 0; i < 30; ++i) predicted[i] = um * (0.37 * static_cast<double>(i % 3) + 5);
  const CoarseSteps steps(d, all(), predicted, Vector::Constant(1, 1), 1e9); // scatters by a tenth of a step, surely
  REQUIRE(steps.any());
  const double noise = noise_before_steps(0.1 * um, um);
  REQUIRE(steps.share(2).size() == 1);
  CHECK(steps.share(2)[0] == Approx(noise / (0.1 * um) / 2));
  NoiseShape shape;
  shape.own = steps.share(1);
  const Whitened w(d, all(), {0}, {});
  constexpr std::size_t sets = 400;
  const Matrix read = steps.read(w.draw(sets, 3, shape), Draws{0, sets, sets}, 3);
  double within = 0, largest = 0;
  for (Index j = 0; j < read.cols(); ++j)
    for (Index i = 0; i < 3; ++i) { // one target
      Vector of(10);
      for (Index k = 0; k < 10; ++k) of[k] = read(i + 3 * k, j) / um;
      for (Index k = 1; k < 10; ++k) CHECK(std::fabs(of[k] - of[0] - std::round(of[k] - of[0])) < 1e-6);
      within += (of.array() - of.mean()).square().sum() / 9;
      largest = std::max(largest, std::fabs(of.mean()));
    }
  CHECK(std::sqrt(within / (3 * sets)) == Approx(0.1).epsilon(0.1));
  CHECK(largest == Approx(0.5).epsilon(0.1)); // rounding that all readings of a target share
  // The same in parts.
  const Matrix late = steps.read(w.draw(Draws{200, 200, sets}, 3, shape), Draws{200, 200, sets}, 3);
  CHECK(late == read.rightCols(200));
}

TEST_CASE("of two indications one may be read in coarse steps", "[tracing]") {
  Design d = axis();
  d.indications = 2;
  d.reading.resize(15);
  d.local.assign(15, Matrix(0.1 * um * Matrix::Identity(2, 2)));
  d.reference = {0.1 * um, 0.1 * um};
  d.step = {um, 0.01 * um};
  d.coarse = {true, false};
  CHECK(hidden_squares(d, all()) == Approx(15 * 100.0 / 12)); // of every second row
  const CoarseSteps steps(d, all(), Vector::Zero(30), Vector::Constant(2, 1), 1e9);
  CHECK(steps.share(2)[0] == Approx(noise_before_steps(0.1 * um, um) / (0.1 * um) / 2));
  CHECK(steps.share(2)[1] == 1);
  const Matrix drawn = 0.1 * um * normals(30, 8, 5, 0);
  const Matrix read = steps.read(drawn, Draws{0, 8, 8}, 3);
  for (Index i = 0; i < 30; i += 2) {
    CHECK(read.row(i) != drawn.row(i));
    CHECK(read.row(i + 1) == drawn.row(i + 1));
  }
}

TEST_CASE("each readout of a mean is read by itself", "[tracing]") {
  Design d = axis();
  d.readouts.assign(30, 4);
  for (Matrix& one : d.local) one = Matrix::Constant(1, 1, 0.1 * um);
  CHECK(hidden_squares(d, all()) == Approx(30 * 100.0 / 12)); // rounding that all four share
  // Four readouts with noise of 0.3 steps: means scatter by half of what one does.
  const double scatter = scatter_read(0.3 * um, um) / 2;
  const CoarseSteps steps(d, all(), Vector::Zero(30), Vector::Constant(1, scatter / (0.1 * um)), 1e9);
  CHECK(steps.share(1)[0] == Approx(0.3 / 2 / 0.1).epsilon(1e-4));
  constexpr std::size_t sets = 2000;
  NoiseShape shape;
  shape.own = steps.share(1);
  const Matrix read = steps.read(Whitened(d, all(), {0}, {}).draw(sets, 3, shape), Draws{0, sets, sets}, 3);
  double within = 0;
  for (Index j = 0; j < read.cols(); ++j) {
    for (Index i = 1; i < 30; ++i) {
      const double quarters = 4 * (read(i, j) - read(0, j)) / um;
      CHECK(std::fabs(quarters - std::round(quarters)) < 1e-6);
    }
    within += (read.col(j).array() - read.col(j).mean()).square().sum() / 29;
  }
  CHECK(std::sqrt(within / sets) == Approx(scatter).epsilon(0.02)); // where the place lies changes it little
  // How readouts scatter is known better from themselves, unless their means surely scatter more.
  const auto noise_of_mean = [&](double between, double within) {
    const Vector means = Vector::Constant(1, scatter_read(between * um, um) / 2 / (0.1 * um));
    return CoarseSteps(d, all(), Vector::Zero(30), means, 50, {{scatter_read(within * um, um)}, 1e9}).share(1)[0] * 0.1;
  };
  CHECK(noise_of_mean(0.3, 0.2) == Approx(0.1).epsilon(1e-4)); // of four
  CHECK(noise_of_mean(0.6, 0.2) == Approx(0.3).epsilon(0.02));
  Design fine = d; // rounding is independent of so much noise
  fine.coarse.clear();
  CHECK(least_scale(fine, all()) == Approx(10 / std::sqrt(12.0) / 2));
}

TEST_CASE("equal readings do not show that they have no noise", "[tracing]") {
  const Design d = axis();
  const CoarseSteps steps(d, all(), Vector::Zero(30), Vector::Zero(1), 18);
  CHECK(steps.share(1)[0] * 0.1 == Approx(noise_before_steps(1 / std::sqrt(36.0), 1)));
  CHECK(hidden_squares(d, all()) == Approx(30 * 100.0 / 12)); // a step is ten times the noise
  Design fine = d;
  fine.coarse.clear();
  CHECK(hidden_squares(fine, all()) == 0);
  CHECK_FALSE(CoarseSteps(fine, all(), Vector::Zero(30), Vector::Zero(1), 18).any());
}
