/// Heavy tails: no false alarm where the variance exists, and an alarm where it does not.
#include "gum_models.h"

#include <cstdlib>
#include <functional>

#include "analysis/tails.h"

using namespace gum_models;

namespace {

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
