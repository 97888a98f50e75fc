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
  d.coarse = true;
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
  const CoarseSteps steps(d, predicted, 1, 1e9); // scatters by a tenth of a step, surely
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

TEST_CASE("equal readings do not show that they have no noise", "[tracing]") {
  const Design d = axis();
  const CoarseSteps steps(d, Vector::Zero(30), 0, 18);
  CHECK(steps.share(1)[0] * 0.1 == Approx(noise_before_steps(1 / std::sqrt(36.0), 1)));
  CHECK(hidden_squares(d, all()) == Approx(30 * 100.0 / 12)); // a step is ten times the noise
  Design fine = d;
  fine.coarse = false;
  CHECK(hidden_squares(fine, all()) == 0);
  CHECK_FALSE(CoarseSteps(fine, Vector::Zero(30), 0, 18).any());
}
