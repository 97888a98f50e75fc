/// Statistics of samples against JCGM 101's additive examples, exact quantiles and known standard errors.
#include <catch2/catch.hpp>

#include "analysis/rounding.h"
#include "analysis/summary.h"
#include "analysis/tails.h"
#include "quantities/sample_plan.h"

using namespace gumshoe;
using analysis::Summary;

namespace {

/// Sum of four quantities of the given distributions, sampled by the engine.
std::vector<double> sum_of(const std::vector<quantities::Distribution>& d, std::size_t n, std::uint64_t seed) {
  std::vector<quantities::InputQuantity> q;
  for (std::size_t i = 0; i < d.size(); ++i) {
    quantities::Component c;
    c.name = "c1";
    c.distribution = d[i];
    q.push_back({"x" + std::to_string(i + 1), "1", "1", {{{}, 0.0, {c}, ""}}});
  }
  const std::vector<quantities::Reading> readings(1);
  const auto plan = quantities::make_plan(q, {}, readings, seed);
  const quantities::Sampler sampler(plan, quantities::PointSet::monte_carlo, n);
  std::vector<double> x(d.size() * n), y(n, 0.0);
  sampler.draw(0, n, quantities::Purpose::sampling, x.data(), n);
  for (std::size_t v = 0; v < d.size(); ++v)
    for (std::size_t i = 0; i < n; ++i) y[i] += x[v * n + i];
  return y;
}

const propagation::Output output{"y", "y", 0, "1", "1"};
const double root3 = std::sqrt(3.0);
const quantities::Distribution normal{quantities::Family::normal, {0, 1}, nullptr, nullptr};
const quantities::Distribution rectangular{quantities::Family::rectangular, {-root3, root3}, nullptr, nullptr};
const quantities::Distribution wide{quantities::Family::rectangular, {-10 * root3, 10 * root3}, nullptr, nullptr};

} // namespace

TEST_CASE("JCGM 101 example 9.2: additive models", "[references][coverage]") {
  constexpr std::size_t n = 1'000'000;
  const double m = static_cast<double>(n);
  SECTION("9.2.2, four normal quantities") {
    const Summary s = analysis::summarise(output, sum_of({normal, normal, normal, normal}, n, 7), 0.95);
    CHECK(std::fabs(s.estimate) < 4 * 2 / std::sqrt(m));
    CHECK(std::fabs(s.standard_uncertainty / 2 - 1) < 4 * std::sqrt(0.5 / m));
    CHECK(std::fabs(s.symmetric.high - 3.9199) < 4 * s.symmetric.high_se + 1e-4);
    CHECK(std::fabs(s.symmetric.low + 3.9199) < 4 * s.symmetric.low_se + 1e-4);
  }
  SECTION("9.2.3, four rectangular quantities: not the normal approximation's 3.92") {
    const Summary s =
        analysis::summarise(output, sum_of({rectangular, rectangular, rectangular, rectangular}, n, 7), 0.95);
    const double exact = 2 * root3 * (2 - std::pow(0.6, 0.25));
    // Density of the sum at that point, from its cubic end: f = (4 a - y)^3 / (6 (2a)^4), a = sqrt 3.
    const double density = std::pow(4 * root3 - exact, 3) / (6 * std::pow(2 * root3, 4));
    const double tolerance = 4 * std::sqrt(0.025 * 0.975 / m) / density;
    REQUIRE(tolerance < (3.92 - exact) / 2);
    CHECK(std::fabs(s.symmetric.high - exact) < tolerance);
    CHECK(std::fabs(s.symmetric.low + exact) < tolerance);
    // The reported standard error is that formula's, estimated from the sample: within 20 %.
    CHECK(s.symmetric.high_se == Approx(tolerance / 4).epsilon(0.2));
    CHECK(s.kurtosis == Approx(3 - 1.2 / 4).epsilon(0.01));
  }
  SECTION("9.2.4, one dominant rectangular quantity") {
    const Summary s = analysis::summarise(output, sum_of({rectangular, rectangular, rectangular, wide}, n, 7), 0.95);
    CHECK(s.standard_uncertainty == Approx(std::sqrt(103.0)).epsilon(4 * std::sqrt(0.85 / (4 * m))));
    CHECK(std::fabs(s.symmetric.high - 17.01581) < 4 * std::sqrt(0.025 * 0.975 / m) * 20 * root3);
  }
}

TEST_CASE("a shortest interval does not leave a one-sided density", "[coverage]") {
  const quantities::Distribution exponential{quantities::Family::exponential, {1}, nullptr, nullptr};
  const Summary s = analysis::summarise(output, sum_of({exponential}, 200'000, 3), 0.95);
  CHECK(s.shortest.low >= 0);
  CHECK(s.shortest.low < 1e-3);
  CHECK(s.shortest.high == Approx(-std::log(0.05)).epsilon(0.02));
  CHECK(s.symmetric.low == Approx(-std::log(0.975)).epsilon(0.05));
  CHECK(s.skewness == Approx(2).epsilon(0.1));
}

TEST_CASE("standard errors cover the truth at their nominal rate", "[coverage][long-ish]") {
  // 200 independent runs: the true 97.5 % quantile lies within 2 standard errors in about 95.4 % of them.
  // Binomial standard deviation 1.5 %: 4 of them below is 89.5 %.
  int quantile = 0, mean = 0, u = 0;
  constexpr int runs = 200;
  for (int k = 0; k < runs; ++k) {
    const Summary s = analysis::summarise(output, sum_of({normal}, 20'000, 1000 + static_cast<std::uint64_t>(k)), 0.95);
    quantile += std::fabs(s.symmetric.high - 1.959964) < 2 * s.symmetric.high_se;
    mean += std::fabs(s.estimate) < 2 * s.estimate_se;
    u += std::fabs(s.standard_uncertainty - 1) < 2 * s.standard_uncertainty_se;
  }
  CHECK(quantile > 0.895 * runs);
  CHECK(mean > 0.895 * runs);
  CHECK(u > 0.895 * runs);
  CHECK(quantile < runs); // an error that never misses is too large
}

TEST_CASE("failed samples widen the rank bounds, never the estimate", "[failed]") {
  std::vector<double> y = sum_of({normal}, 10'000, 5);
  const Summary whole = analysis::summarise(output, y, 0.95);
  auto holed = y;
  for (std::size_t i = 0; i < 100; ++i) holed[i * 97] = std::nan("");
  const Summary s = analysis::summarise(output, holed, 0.95);
  CHECK(s.failed == 100);
  CHECK(s.valid == 9900);
  CHECK(s.symmetric.low_rank < s.symmetric.low);
  CHECK(s.symmetric.high_rank > s.symmetric.high);
  // Whatever the failed values were, the whole sample's ends lie within the bounds.
  CHECK(s.symmetric.low_rank <= whole.symmetric.low);
  CHECK(s.symmetric.high_rank >= whole.symmetric.high);
}

TEST_CASE("degenerate samples", "[coverage]") {
  CHECK(analysis::summarise(output, std::vector<double>(1000, 4.25), 0.95).estimate == 4.25);
  CHECK(analysis::summarise(output, std::vector<double>(1000, 4.25), 0.95).standard_uncertainty == 0);
  CHECK(std::isnan(analysis::summarise(output, std::vector<double>(10, std::nan("")), 0.95).estimate));
  CHECK(std::isnan(analysis::summarise(output, {}, 0.95).estimate));
}

TEST_CASE("two or three samples have no kurtosis", "[coverage]") {
  // It is 1 of any two values and 1.5 of any three, and the skewness of any two is 0: no property of what was drawn.
  const Summary two = analysis::summarise(output, std::vector{1.0, 7.0}, 0.95);
  CHECK(two.standard_uncertainty == Approx(std::sqrt(18.0)));
  CHECK(std::isnan(two.skewness));
  CHECK(std::isnan(two.kurtosis));
  const Summary three = analysis::summarise(output, std::vector{1.0, 2.0, 7.0}, 0.95);
  CHECK(three.skewness > 0);
  CHECK(std::isnan(three.kurtosis));
  CHECK(analysis::summarise(output, std::vector{1.0, 2.0, 4.0, 7.0}, 0.95).kurtosis > 1);
  CHECK(analysis::summarise(output, std::vector{4.0, 4.0}, 0.95).kurtosis == 0); // a constant, however few
}

TEST_CASE("values whose mean is not a number of double precision are no constant", "[coverage]") {
  for (const std::size_t n : {30u, 5000u}) { // below and above the number from which tails are looked at
    std::vector<double> y(n);
    for (std::size_t i = 0; i < n; ++i) y[i] = 1e308 * (static_cast<double>(i) / static_cast<double>(n)) - 1e307;
    Summary s = analysis::summarise(output, y, 0.9);
    analysis::join_rounded(s);
    analysis::check_tails(y, s);
    CHECK(std::isnan(s.standard_uncertainty));
    CHECK(s.estimate == Approx(4e307).epsilon(0.05)); // the median
    CHECK(s.shortest.high > s.shortest.low);
    CHECK_THAT(s.warning, Catch::Contains("no standard uncertainty: the values are too large for it in double precision"));
  }
  std::vector<double> y(5000);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = 1e-200 * static_cast<double>(i % 50);
  Summary s = analysis::summarise(output, y, 0.95); // squares of the deviations are 0
  analysis::join_rounded(s);
  analysis::check_tails(y, s);
  CHECK(std::isnan(s.standard_uncertainty));
  CHECK_THAT(s.warning, Catch::Contains("the values are too small for it in double precision"));
}

TEST_CASE("rounding by GUM 7.2.6", "[rounding]") {
  CHECK(analysis::decimals_for(0.00387) == 4);
  CHECK(analysis::decimals_for(0.0996) == 2); // 0.10
  CHECK(analysis::decimals_for(0.0994) == 3);
  CHECK(analysis::decimals_for(12.3) == 0);
  CHECK(analysis::fixed(51234.4, analysis::decimals_for(1234)) == "51200");
  CHECK(analysis::fixed(1234, analysis::decimals_for(1234)) == "1200");
  CHECK(analysis::fixed(-509.86594, 4) == "-509.8659");
  CHECK(analysis::fixed(1.987e304, -303) == "2.0e+304");
  CHECK(analysis::fixed(-1.987e300, -303) == "0e+00");
}

TEST_CASE("a share of a whole is never said to be nothing or all", "[rounding]") {
  CHECK(analysis::share_text(0.974) == "97 %");
  CHECK(analysis::share_text(0.0049) == "< 1 %");
  CHECK(analysis::share_text(-1e-9) == "< 1 %");
  CHECK(analysis::share_text(0.006) == "1 %");
  CHECK(analysis::share_text(0.9951) == "> 99 %");
  CHECK(analysis::share_text(-0.123) == "-12 %");
}

TEST_CASE("two or three samples do not say how well their spread is known", "[summary]") {
  for (const std::vector<double>& few : {std::vector<double>{1.0, 3.0}, {1.0, 3.0, 4.0}}) {
    const Summary s = analysis::summarise(output, few, 0.95);
    CHECK(s.standard_uncertainty > 0);
    CHECK(std::isnan(s.standard_uncertainty_se));
  }
  CHECK(analysis::summarise(output, std::vector<double>{1, 3, 4, 9}, 0.95).standard_uncertainty_se > 0);
  CHECK(analysis::summarise(output, std::vector<double>{2, 2}, 0.95).standard_uncertainty_se == 0); // a constant
}
