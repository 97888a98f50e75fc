#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tracing/noise/by_label.h"
#include "tracing/noise/growth.h"
#include "tracing/noise/step.h"
#include "tracing/noise/whitened.h"

using namespace gumshoe;
using namespace gumshoe::tracing;

TEST_CASE("the step of readings is the largest of which all their differences are multiples", "[tracing]") {
  const double um = 1e-6;
  CHECK(recorded_step(std::vector{3 * um, 9 * um, 15 * um, 0.0}) == Approx(3 * um));
  CHECK(recorded_step(std::vector{0.0251, 0.0253, 0.0259}) == Approx(2e-4));
  CHECK(recorded_step(std::vector{0.0, 6 * um, 10 * um, 15 * um}) == Approx(um)); // no pair alone shows it
  // Displays count from anywhere: a metre and a bit.
  CHECK(recorded_step(std::vector{1.0 + 7 * um, 1.0 + 9 * um, 1.0 + 12 * um}) == Approx(um).epsilon(1e-6));
  CHECK(recorded_step(std::vector{-0.3, -0.1, 0.2}) == Approx(0.1));
  CHECK(recorded_step(std::vector{2.5, 2.5}) == 0);
  CHECK(recorded_step(std::vector<double>{}) == 0);
  // Where the step of the display is stated.
  CHECK(recorded_step(std::vector{0.0, 10 * um}, 1, um) == um);
  CHECK(recorded_step(std::vector{2.5, 2.5}, 1, um) == um);
  CHECK(recorded_step(std::vector{0.0, um / 3, um}, 1, um) == Approx(um / 3));
  CHECK(recorded_step(std::vector{0.0, um / 3, um}, 3, um) == um); // means of three
  CHECK(recorded_step(std::vector{0.0, um / 3, um}, 3, 0) == Approx(um));
  CHECK(recorded_step(std::vector{0.0, 10 * um}, 1, 3 * um) == Approx(10 * um));
  // No step is claimed of what fills the digits of a double.
  std::vector<double> fine;
  for (int i = 1; i < 50; ++i) fine.push_back(std::sqrt(i));
  CHECK(recorded_step(fine) == 0);
}

TEST_CASE("a step of a decimal is found whatever the number of readings", "[tracing]") {
  const Matrix noise = normals(2000, 1, 7, 0);
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    std::vector<double> values;
    for (Index i = 0; i < noise.rows(); ++i) values.push_back(0.25 + step * std::round(1e-6 * noise(i, 0) / step));
    INFO(step);
    CHECK(recorded_step(values) == Approx(step).epsilon(1e-6));
  }
}

namespace {

/// Eight passes over ten levels of a condition, with noise of sizes given by level.
struct Passes {
  Observations o;
  Replicates replicates;
  std::vector<Index> rows;
  Vector about;

  template <class F> Passes(const F& noise, std::uint64_t seed) {
    o.readings = 80;
    o.indications = 1;
    const Matrix z = normals(80, 1, seed, 0);
    about.resize(80);
    Covariate load{"load", "N", "N", {}, {}, false, true, false};
    for (std::size_t r = 0; r < 80; ++r) {
      const double x = static_cast<double>(r % 10) + 1;
      load.value.push_back(x);
      about[index(r)] = noise(x) * z(index(r), 0);
      o.measured.push_back(about[index(r)]);
      o.sequence.push_back(r);
      replicates.pass.push_back(r / 10);
      rows.push_back(index(r));
    }
    for (int x = 1; x <= 10; ++x) load.levels.push_back(x);
    o.covariates = {load};
  }
  std::optional<NoiseGrowth> grows() const { return noise_growth(o, replicates, rows, about); }
};

} // namespace

TEST_CASE("noise that grows with a condition is told from noise that does not", "[tracing]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    INFO(seed);
    CHECK_FALSE(Passes([](double) { return 1; }, seed).grows());
  }
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    if (const auto grows = Passes([](double x) { return std::hypot(0.05, 0.1 * x); }, seed).grows()) {
      ++found;
      CHECK(grows->largest == 10);
      // The noise at the last level is nine times that at the first. Each has seven degrees of freedom, so that the
      // logarithm of their ratio is known to about 0.4; a factor of three is 2.7 of these.
      const double ratio = std::sqrt(grows->variance[9] / grows->variance[0]);
      CHECK(ratio > 9 / 3.0);
      CHECK(ratio < 9 * 3.0);
    }
  CHECK(found > 25); // eight readings of a level: more often than not
}

TEST_CASE("a gain that differs from pass to pass, one bad reading and levels without scatter are no growing noise",
          "[tracing]") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    INFO(seed);
    Passes gains([](double) { return 1; }, seed), bad = gains, zeroed = gains;
    for (Index i = 0; i < 80; ++i)
      gains.about[i] += 20 * std::sin(static_cast<double>(i / 10 * 7)) * static_cast<double>(i % 10 + 1);
    CHECK_FALSE(gains.grows());
    bad.about[39] += 30;
    CHECK_FALSE(bad.grows());
    for (Index i = 0; i < 80; i += 10) zeroed.about[i] = zeroed.o.measured[index(i)] = 0;
    CHECK_FALSE(zeroed.grows());
  }
}

TEST_CASE("noise that differs by a label is told with its size, and equal noise is not", "[tracing]") {
  // Twelve passes, each of one operator in turn, over ten levels: their cells hold readings of all three.
  const auto passes = [](double noise, std::uint64_t seed) {
    Passes out([&](double) { return 1; }, seed);
    Grouping label{"operator", {"operator"}, {}, {"operator A", "operator B", "operator C"}, {{"A"}, {"B"}, {"C"}}};
    const Matrix z = normals(120, 1, seed, 1);
    out.o.readings = 120;
    out.o.sequence.clear(), out.rows.clear(), out.replicates.pass.clear();
    out.about.resize(120);
    for (std::size_t r = 0; r < 120; ++r) {
      const std::size_t pass = r / 10, who = pass % 3;
      label.group.push_back(who);
      out.about[index(r)] = (who == 1 ? noise : 1) * z(index(r), 0);
      out.o.sequence.push_back(r);
      out.replicates.pass.push_back(pass);
      out.replicates.cell.push_back(r % 10);
      out.rows.push_back(index(r));
    }
    out.o.labels = {label};
    return out;
  };
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Passes equal = passes(1, seed);
    for (const auto& one : noise_by_labels(equal.o, equal.replicates, equal.rows, equal.about))
      alarms += refined(one, equal.o, equal.replicates, equal.rows, equal.about).plain;
  }
  CHECK(alarms <= 3); // 0.4 of 200 expected
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO(seed);
    const Passes unequal = passes(4, seed);
    const auto found = noise_by_labels(unequal.o, unequal.replicates, unequal.rows, unequal.about);
    REQUIRE(found.size() == 1);
    CHECK(found[0].ratio[0][1] > found[0].ratio[0][0]);
    // 32 degrees of freedom for the one and 64 for the others tell the logarithm of their ratio to 0.15; three of
    // these.
    CHECK(std::fabs(std::log(found[0].ratio[0][1] / found[0].ratio[0][0] / 4)) < 0.45);
  }
}
