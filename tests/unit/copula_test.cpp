#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "quantities/copula.h"
#include "unit/sampling.h"

using namespace gumshoe;
using namespace gumshoe::fixture;

TEST_CASE("a Gaussian copula keeps margins and gives Pearson's coefficient (6/pi) asin(rho/2)", "[sampler][copula]") {
  constexpr std::size_t n = 1'000'000;
  const std::vector<InputQuantity> quantities = {simple("a", rectangular), simple("b", rectangular)};
  for (const auto& [rho, expected] : {std::pair{0.3, 0.287564}, {0.6, 0.581920}, {0.9, 0.891456}, {-0.6, -0.581920}}) {
    const Correlation correlation{Correlation::Kind::copula, {"a", "b"}, {1, rho, rho, 1}};
    const auto rows = draw(make_plan(quantities, {&correlation, 1}, one_reading, 11), n);
    // The standard error of r is at most (1 - r^2) / sqrt(n) times about 1.2 for these margins.
    const double tolerance = 5 * (1 - expected * expected) / std::sqrt(double(n));
    CHECK(std::abs(expected - rho) > 1.5 * tolerance); // tells the copula's from Pearson's coefficient
    CHECK(std::abs(pearson(rows[0], rows[1]) - expected) < tolerance);
    for (const auto& row : rows) {
      double mean = 0, square = 0;
      for (const double x : row) mean += x / n, square += x * x / n;
      CHECK(std::abs(mean - 0.5) < 4.5 / std::sqrt(12.0 * n));
      CHECK(std::abs(square - 1.0 / 3) < 4.5 * std::sqrt(4.0 / 45 / n));
    }
  }
}

TEST_CASE("a stated Pearson or Spearman coefficient is what the draws have", "[sampler][copula]") {
  constexpr std::size_t n = 1'000'000;
  Distribution steps = make(Family::discrete, {});
  steps.values = std::make_shared<const std::vector<double>>(std::vector<double>{-1, 0, 2});
  steps.probabilities = std::make_shared<const std::vector<double>>(std::vector<double>{0.25, 0.25, 0.5});
  const std::vector<InputQuantity> quantities = {
      simple("normal", standard), simple("lognormal", make(Family::lognormal, {0, 0.8})),
      simple("rectangular", rectangular), simple("exponential", make(Family::exponential, {1})),
      simple("steps", steps)};
  using Pair = std::pair<std::vector<std::string>, double>;
  for (const auto& [names, r] : {Pair{{"normal", "lognormal"}, 0.7}, Pair{{"rectangular", "exponential"}, -0.6},
                                 Pair{{"normal", "rectangular"}, 0.8}, Pair{{"rectangular", "steps"}, 0.5}}) {
    INFO(names[0] << " " << names[1]);
    const Correlation correlation{Correlation::Kind::pearson, names, {1, r, r, 1}};
    const SamplePlan plan = make_plan(quantities, {&correlation, 1}, one_reading, 2);
    const auto rows = draw(plan, n);
    const auto& group = plan.copulas.at(0).variates;
    CHECK(std::abs(pearson(rows[group[0]], rows[group[1]]) - r) < 6.0 / std::sqrt(double(n))); // lognormal: heavier
  }
  // normal with rectangular: r = rho sqrt(3/pi); normal with lognormal: r = rho s / sqrt(e^(s s) - 1)
  const auto coefficient = [&](const char* other, double r) {
    const Correlation c{Correlation::Kind::pearson, {"normal", other}, {1, r, r, 1}};
    return make_plan(quantities, {&c, 1}, one_reading, 2).copulas.at(0).matrix[1];
  };
  CHECK(coefficient("rectangular", 0.8) == Approx(0.8 / std::sqrt(3 / std::numbers::pi)).epsilon(1e-7));
  CHECK(coefficient("lognormal", 0.7) == Approx(0.7 * std::sqrt(std::expm1(0.64)) / 0.8).epsilon(1e-6));
  const Correlation spearman{Correlation::Kind::spearman, {"normal", "exponential"}, {1, 0.5, 0.5, 1}};
  CHECK(make_plan(quantities, {&spearman, 1}, one_reading, 2).copulas.at(0).matrix[1] ==
        Approx(2 * std::sin(std::numbers::pi / 12)));
}

TEST_CASE("coefficients of +1 and -1 are drawn exactly, whatever the distributions", "[sampler][copula]") {
  Distribution wide = make(Family::t, {0, 3, 4}), steps = make(Family::discrete, {});
  steps.values = std::make_shared<const std::vector<double>>(std::vector<double>{-1, 0, 1});
  steps.probabilities = std::make_shared<const std::vector<double>>(std::vector<double>{0.3, 0.4, 0.3});
  const std::vector<InputQuantity> quantities = {
      simple("n1", standard),       simple("n2", make(Family::normal, {2, 3})), simple("t1", make(Family::t, {0, 1, 4})),
      simple("t2", wide),           simple("r1", rectangular),                  simple("r2", make(Family::rectangular, {-4, 0})),
      simple("tri1", make(Family::triangular, {0, 1})), simple("tri2", make(Family::triangular, {0, 2})),
      simple("e1", make(Family::exponential, {1})),     simple("e2", make(Family::exponential, {5})),
      simple("s1", steps),          simple("s2", steps)};
  using enum Correlation::Kind;
  for (std::size_t i = 0; i < quantities.size(); i += 2)
    for (const double r : {1.0, -1.0})
      for (const auto kind : {copula, pearson, spearman}) {
        const bool stepped = i == 10, mirrored = i != 8 || r > 0; // no linear relation of opposite exponentials
        if ((kind == spearman && stepped) || (kind == pearson && !mirrored)) continue;
        const std::vector<InputQuantity> two(quantities.begin() + std::ptrdiff_t(i), quantities.begin() + std::ptrdiff_t(i) + 2);
        INFO(two[0].name << " " << r << " " << int(kind));
        const Correlation c{kind, {two[0].name, two[1].name}, {1, r, r, 1}};
        const SamplePlan plan = make_plan(two, {&c, 1}, one_reading, 3);
        const auto rows = draw(plan, 4096);
        const auto& a = plan.variates[0].distribution;
        const auto& b = plan.variates[1].distribution;
        for (std::size_t k = 0; k < 4096; k += 41) {
          if (mirrored) { // a straight line through the means, to the rounding of the quantile functions
            const double line = b.mean() + r * std::sqrt(b.variance() / a.variance()) * (rows[0][k] - a.mean());
            REQUIRE(std::abs(rows[1][k] - line) < 1e-9 * std::sqrt(b.variance()));
          } else {
            REQUIRE(std::abs(a.probability(rows[0][k]) + b.probability(rows[1][k]) - 1) < 1e-9);
          }
        }
        // and the framework's coefficient is the same
        if (mirrored) CHECK(pearson_coefficient(plan.copulas[0].matrix[1], a, b) == r);
      }
}

TEST_CASE("a coefficient just below 1 is not 1: the difference has its uncertainty", "[sampler][copula]") {
  const std::vector<InputQuantity> quantities = {simple("a", standard), simple("b", standard)};
  constexpr std::size_t n = 1 << 16;
  for (const double missing : {1e-6, 1e-12, 1e-14}) {
    for (const auto kind : {Correlation::Kind::pearson, Correlation::Kind::spearman}) {
      const double r = 1 - missing;
      const Correlation c{kind, {"a", "b"}, {1, r, r, 1}};
      const SamplePlan plan = make_plan(quantities, {&c, 1}, one_reading, 3);
      CHECK_FALSE(plan.copulas.at(0).singular());
      const auto rows = draw(plan, n);
      double variance = 0;
      for (std::size_t k = 0; k < n; ++k) variance += std::pow(rows[0][k] - rows[1][k], 2) / double(n);
      // 2 (1 - rho), where the rounding of rho to 1.1e-16 is 1 % of 1e-14.
      const double expected = 2 * (1 - plan.copulas.at(0).matrix[1]);
      CHECK(expected > 1.7 * missing);
      CHECK(std::abs(variance / expected - 1) < 5 * std::sqrt(2.0 / double(n)) + 0.02);
    }
  }
  // What rounding leaves of 1 is 1.
  for (const double r : {1.0, std::nextafter(1.0, 0.0), -1.0}) {
    const Correlation c{Correlation::Kind::pearson, {"a", "b"}, {1, r, r, 1}};
    CHECK(make_plan(quantities, {&c, 1}, one_reading, 3).copulas.at(0).singular());
  }
}

TEST_CASE("a singular matrix is drawn exactly: quantities that determine another", "[sampler][copula]") {
  // c = 0.6 a + 0.8 b; the same with c named first, and with a fourth that is opposite to a.
  const std::vector<InputQuantity> quantities = {simple("a", standard), simple("b", standard), simple("c", standard),
                                                 simple("d", standard)};
  for (const auto& [names, matrix] :
       {std::pair<std::vector<std::string>, std::vector<double>>{
            {"a", "b", "c", "d"}, {1, 0, .6, -1, 0, 1, .8, 0, .6, .8, 1, -.6, -1, 0, -.6, 1}},
        {{"d", "a", "c", "b"}, {1, -1, -.6, 0, -1, 1, .6, 0, -.6, .6, 1, .8, 0, 0, .8, 1}}}) {
    const Correlation c{Correlation::Kind::pearson, names, matrix};
    const SamplePlan plan = make_plan(quantities, {&c, 1}, one_reading, 3);
    CHECK(plan.copulas.at(0).singular());
    const auto rows = draw(plan, 1 << 16);
    double variance = 0;
    for (std::size_t k = 0; k < rows[0].size(); ++k) {
      REQUIRE(std::abs(0.6 * rows[0][k] + 0.8 * rows[1][k] - rows[2][k]) < 1e-12);
      REQUIRE(rows[3][k] == -rows[0][k]);
      variance += rows[2][k] * rows[2][k] / double(rows[0].size());
    }
    CHECK(std::abs(variance - 1) < 5 * std::sqrt(2.0 / double(rows[0].size())));
  }
}
