/// Heavy tails: no false alarm where the variance exists, and an alarm where it does not.
#include "gum_models.h"

#include <cstdlib>
#include <functional>

#include "analysis/tails.h"

using namespace gum_models;

namespace {

struct Identity {
  static constexpr const char* inputs[] = {"x"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] + 0.0; }
};

quantities::Distribution family(Family f, std::array<double, 4> p) { return {f, p, nullptr, nullptr}; }

std::vector<double> drawn(const quantities::Distribution& d, std::size_t n, std::uint64_t seed) {
  quantities::Component c;
  c.name = "c1";
  c.distribution = d;
  const std::vector<quantities::InputQuantity> q{{"x", "1", "1", {{{}, 0.0, {c}, ""}}}};
  const std::vector<quantities::Reading> readings(1);
  const auto plan = quantities::make_plan(q, {}, readings, seed);
  std::vector<double> x(n);
  quantities::Sampler(plan, quantities::PointSet::monte_carlo, n)
      .draw(0, n, quantities::Purpose::sampling, x.data(), n);
  return x;
}

analysis::Summary checked(const std::vector<double>& y) {
  const auto m = analysis::moments(y);
  analysis::Summary s;
  s.valid = y.size();
  s.standard_uncertainty = std::sqrt(m.variance);
  s.kurtosis = m.kurtosis;
  analysis::check_tails(y, s);
  return s;
}

int alarms(const quantities::Distribution& d, std::size_t n, int seeds, const std::function<double(double)>& f = {}) {
  const char* fresh = std::getenv("GUMSHOE_LONG_SEED");
  const std::uint64_t first = fresh ? std::strtoull(fresh, nullptr, 10) : 1;
  int count = 0;
  for (int k = 0; k < seeds; ++k) {
    auto y = drawn(d, n, first + static_cast<std::uint64_t>(k));
    if (f)
      for (double& v : y) v = f(v);
    count += std::isnan(checked(y).standard_uncertainty) ? 1 : 0;
  }
  return count;
}

} // namespace

TEST_CASE("no false alarm on distributions that have a variance", "[tails]") {
  const auto discrete = quantities::Distribution{Family::discrete,
                                                 {},
                                                 std::make_shared<std::vector<double>>(std::vector{0.0, 1.0, 50.0}),
                                                 std::make_shared<std::vector<double>>(std::vector{0.5, 0.49, 0.01})};
  const std::pair<const char*, quantities::Distribution> kinds[] = {
      {"normal", family(Family::normal, {0, 1})},       {"rectangular", family(Family::rectangular, {-1, 1})},
      {"arcsine", family(Family::arcsine, {-1, 1})},    {"exponential", family(Family::exponential, {1})},
      {"lognormal", family(Family::lognormal, {0, 1})}, {"t_5", family(Family::t, {0, 1, 5})},
      {"chi-square", family(Family::gamma, {0.5, 2})},  {"discrete", discrete}};
  for (const auto& [name, d] : kinds) {
    INFO(name);
    CHECK(alarms(d, 10'000, 100) == 0);
    CHECK(alarms(d, 100'000, 100) == 0);
    CHECK(alarms(d, 1'000'000, std::getenv("GUMSHOE_LONG_SEED") ? 100 : 2) == 0);
  }
  // One sample in a hundred displaced by fifty standard uncertainties: ugly, and of finite variance.
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    auto y = drawn(discrete, 10'000, seed);
    const auto blur = drawn(family(Family::rectangular, {-1, 1}), 10'000, seed + 1000);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += blur[i];
    REQUIRE_FALSE(std::isnan(checked(y).standard_uncertainty));
  }
}

TEST_CASE("an alarm where there is no variance", "[tails]") {
  constexpr std::size_t n = 100'000;
  constexpr int seeds = 25;
  const auto cauchy = family(Family::t, {0, 1, 1}), t_2 = family(Family::t, {0, 1, 2});
  CHECK(alarms(cauchy, n, seeds) == seeds);
  CHECK(alarms(family(Family::normal, {0, 1}), n, seeds, [](double x) { return 1 / x; }) == seeds);
  CHECK(alarms(family(Family::rectangular, {0, 1}), n, seeds, [](double x) { return std::pow(x, -1 / 1.5); }) == seeds);
  CHECK(alarms(t_2, n, seeds) == seeds);
}

TEST_CASE("Hill's index of a Pareto tail is its exponent", "[tails]") {
  constexpr std::size_t n = 1'000'000;
  for (const double a : {1.5, 3.0}) {
    auto y = drawn(family(Family::rectangular, {0, 1}), n, 5);
    for (double& v : y) v = std::pow(v, -1 / a);
    const auto s = checked(y);
    // k = n^0.6 = 3981 order statistics: standard error a / 63. About the median m = 2^(1/a) the tail is that of
    // 1 / (x + m)^a: over the threshold t = (n / k)^(1/a) the index falls by a share of m / t or less.
    const double bias = std::pow(2.0, 1 / a) / std::pow(1e6 / 3981, 1 / a);
    CHECK(s.hill_index < a * (1 + 4 / 63.0));
    CHECK(s.hill_index > a * (1 - 4 / 63.0 - bias));
    CHECK(std::isnan(s.standard_uncertainty) == (a < 2));
    CHECK(s.warning.starts_with("no standard uncertainty") == (a < 2));
  }
}

TEST_CASE("where the mean does not settle the estimate is the median, which is said", "[tails]") {
  constexpr std::size_t n = 100'000;
  const auto of = [](std::vector<double> y) {
    analysis::Summary s = analysis::summarise({}, y, 0.95);
    analysis::check_tails(y, s);
    return s;
  };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    // 1/b through zero, b normal about 0.5: P(1/b < m) = 1/2 at b = 1/m with Phi(1/m - 0.5) - Phi(-0.5) = 1/2.
    auto inverse = drawn(family(Family::normal, {0.5, 1}), n, seed);
    for (double& v : inverse) v = 1 / v;
    const auto s = of(inverse);
    CHECK(s.estimate_is_median);
    const double b = 0.5 + quantities::Distribution{Family::normal, {0, 1}, {}, {}}.quantile(0.5 + 0.3085375387);
    CHECK(std::fabs(s.estimate - 1 / b) < 4 * s.estimate_se);
    CHECK(s.estimate_se < 0.02);
    CHECK(s.warning.starts_with("the mean does not settle, and the estimate is the median; no standard uncertainty"));
    // Heavy tails with an expectation keep the mean.
    auto pareto = drawn(family(Family::rectangular, {0, 1}), n, seed);
    for (double& v : pareto) v = std::pow(v, -1 / 1.5);
    CHECK_FALSE(of(pareto).estimate_is_median);
    CHECK_FALSE(of(drawn(family(Family::t, {0, 1, 3}), n, seed)).estimate_is_median);
  }
}

TEST_CASE("two observations give a median, not a mean", "[tails]") {
  auto s = scenario_of<Identity>({{7, {student(0.3, 1)}}}, 200'000);
  const auto r = analysed(s);
  CHECK(r.summaries[0].estimate_is_median);
  CHECK(std::fabs(r.summaries[0].estimate - 7) < 4 * r.summaries[0].estimate_se);
  CHECK(r.summaries[0].estimate_se < 0.005); // 0.3 pi / 2 / sqrt(n): the mean of a Cauchy does not converge at all
  CHECK_THAT(r.summaries[0].statement, Catch::Contains("median, because the mean does not settle"));
  CHECK(std::isnan(r.summaries[0].standard_uncertainty));
  CHECK_FALSE(analysed(scenario_of<Identity>({{7, {student(0.3, 2)}}}, 200'000)).summaries[0].estimate_is_median);
  // Ten trials have no interval, and no mean either.
  const auto few = analysed(scenario_of<Identity>({{7, {student(0.3, 1)}}}, 10)).summaries[0];
  CHECK(few.estimate_is_median);
  CHECK(std::isnan(few.standard_uncertainty));
  CHECK_THAT(few.warning, Catch::Contains("no coverage interval") && Catch::Contains("no standard uncertainty"));
}

TEST_CASE("constant, tiny and failed samples", "[tails]") {
  CHECK(std::isnan(checked(std::vector<double>(5000, 3.0)).hill_index));
  auto y = drawn(family(Family::normal, {0, 1}), 5000, 1);
  auto s = checked(std::vector<double>(y.begin(), y.begin() + 80));
  CHECK(std::isnan(s.hill_index));
  const double index = checked(y).hill_index;
  y.push_back(std::nan(""));
  const auto m = analysis::moments(std::span(y).first(5000));
  s.valid = 5000;
  s.standard_uncertainty = std::sqrt(m.variance);
  s.kurtosis = m.kurtosis;
  analysis::check_tails(y, s);
  CHECK(s.hill_index == Approx(index).epsilon(0.2));
}
