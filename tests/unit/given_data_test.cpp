/// Given-data indices against closed forms and quadrature, and the coverage of their intervals.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>

#include "analysis/given_data.h"
#include "random/streams.h"
#include "screening_models.h"

using namespace gumshoe;
using namespace screening_models;

namespace {

analysis::GivenData indices(const scenario::Scenario& s) {
  const propagation::Experiment e(s);
  const auto values = run(e);
  const auto all = analysis::given_data_indices(
      e, [&](std::size_t) { return analysis::Column(values); }, s.run.samples, 0);
  REQUIRE(all.size() == 1);
  return all[0];
}

/// Four standard errors of a 95 % interval are twice its width, over 1.96.
void check_within(const analysis::Index& index, double truth, double allowed = 0) {
  INFO(index.input << ": " << index.value << " [" << index.low << ", " << index.high << "], truth " << truth);
  CHECK(std::fabs(index.value - truth) < 4 / 1.96 * 0.5 * (index.high - index.low) + allowed);
}

std::vector<double> uniforms(std::uint64_t key, std::size_t n) {
  std::vector<double> u(n);
  random::uniforms({key, 0, 0, 0}, 0, n, u.data());
  return u;
}

double phi(double x, double u) { return std::exp(-0.5 * x * x / (u * u)) / (u * std::sqrt(2 * pi)); }

/// delta of Y = X1 + X2 by X1, standard deviations a and b, by the trapezium rule.
double delta_of_normal_sum(double a, double b) {
  const double total = std::hypot(a, b), step = 0.02;
  double sum = 0;
  for (double x = -8 * a; x < 8 * a; x += step)
    for (double y = -9 * total; y < 9 * total; y += step)
      sum += phi(x, a) * std::fabs(phi(y, total) - phi(y - x, b)) * step * step;
  return 0.5 * sum;
}

} // namespace

TEST_CASE("rank index: Ishigami, g-function, x1 x2 + x3", "[given_data]") {
  const auto ishigami = indices(scenario_of<Ishigami>({uniform(-pi, pi), uniform(-pi, pi), uniform(-pi, pi)}));
  const double s[] = {0.3139051911, 0.4424111448, 0};
  const auto g = indices(scenario_of<GFunction>({uniform(0, 1), uniform(0, 1), uniform(0, 1)}));
  const double sg[] = {.986712, .009867, .000099};
  const auto p = indices(scenario_of<ProductAndSum>({uniform(0, 1), uniform(0, 1), uniform(0, 1)}));
  const double sp[] = {3.0 / 19, 3.0 / 19, 12.0 / 19};
  for (std::size_t i = 0; i < 3; ++i) {
    check_within(ishigami.first[i], s[i]);
    check_within(g.first[i], sg[i], 1e-5); // the truth is printed to six digits
    check_within(p.first[i], sp[i]);
    CHECK(ishigami.first[i].high - ishigami.first[i].low < 0.05);
  }
  CHECK(ishigami.first[2].verdict == "zero within its interval");
  CHECK(ishigami.delta[2].verdict == "resolved"); // x3 acts on more than the mean
}

TEST_CASE("Borgonovo's delta of a sum of normals is that of the quadrature", "[given_data]") {
  const auto g = indices(scenario_of<ProductAndSum>({uniform(0, 1), uniform(0, 1), uniform(0, 1)}));
  CHECK(g.delta[0].value == Approx(g.delta[1].value).margin(0.01)); // by symmetry
  CHECK(g.delta[2].value > g.delta[0].value);
  const auto sum = indices(scenario_of<Linear>({normal(1), normal(1), normal(1)}));
  // A table of 64 classes differs at the crossings of the densities only: a cell's width of 1/64 there.
  check_within(sum.delta[0], delta_of_normal_sum(2, 3), 1.0 / 64);
  check_within(sum.delta[1], delta_of_normal_sum(3, 2), 1.0 / 64);
  check_within(sum.delta[2], 0);
  CHECK(sum.delta[2].low <= 0);
  CHECK(sum.delta[2].high < 0.02);
}

TEST_CASE("ties: a discrete input's index is that of its classes", "[given_data]") {
  quantities::Distribution coin{quantities::Family::discrete,
                                {},
                                std::make_shared<std::vector<double>>(std::vector{-1.0, 1.0}),
                                std::make_shared<std::vector<double>>(std::vector{0.5, 0.5})};
  const auto g = indices(scenario_of<Linear>({coin, uniform(-1, 1), normal(1)}));
  check_within(g.first[0], 4.0 / 7); // variances 4 and 9 / 3
  check_within(g.first[1], 3.0 / 7);
  // y is uniform on 2 x1 -+ 3, density 1/6 each; the two overlap on [-1, 1]: half of 4 / 6 lies apart... delta = 1/3.
  check_within(g.delta[0], 1.0 / 3, 1.0 / 64);
}

TEST_CASE("dependent inputs: what one tells of the other counts", "[given_data]") {
  auto s = scenario_of<Linear>({normal(1), normal(1), normal(1)});
  s.correlations.push_back({quantities::Correlation::Kind::pearson, {"x1", "x3"}, {1, 0.6, 0.6, 1}});
  const auto g = indices(s);
  check_within(g.first[2], 0.36 * 4 / 13); // x3 does nothing, but tells of x1
}

TEST_CASE("95 % intervals of the rank index hold the truth in 95 % of 400 runs", "[given_data]") {
  const std::size_t n = 1000;
  int held[2] = {0, 0}, zero = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    std::vector<double> x[3], y(n);
    for (std::uint64_t i = 0; i < 3; ++i) {
      x[i] = uniforms(3 * k + i + 1, n);
      for (double& v : x[i]) v = pi * (2 * v - 1);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double at[] = {x[0][i], x[1][i], x[2][i]};
      y[i] = Ishigami::of(at);
    }
    const double s[] = {0.3139051911, 0.4424111448};
    for (int i = 0; i < 2; ++i) {
      const auto index = analysis::given_data_pair(x[i], y, k).first;
      held[i] += index.low <= s[i] && s[i] <= index.high;
    }
    const auto none = analysis::given_data_pair(x[2], y, k);
    zero += none.first.low <= 0 && 0 <= none.first.high;
  }
  // Binomial: 380 +- 4.4; four standard deviations.
  INFO(held[0] << ' ' << held[1] << ' ' << zero);
  CHECK(std::abs(held[0] - 380) < 18);
  CHECK(std::abs(held[1] - 380) < 18);
  CHECK(std::abs(zero - 380) < 18);
}

TEST_CASE("delta of an input that does nothing is zero within its interval", "[given_data]") {
  int held = 0;
  double sum = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto index = analysis::given_data_pair(uniforms(2 * k + 1, 4096), uniforms(2 * k + 2, 4096), k).delta;
    held += index.low <= 0;
    sum += index.value / 200;
  }
  CHECK(held >= 195 - 10); // one-sided 97.5 %: 195 +- 2.2, and the choice of the table takes a little
  CHECK(std::fabs(sum) < 0.01);
}

TEST_CASE("intervals of delta cover at their nominal 95 %", "[given_data][coverage]") {
  // y = a x + b e of normals: delta by quadrature. Four binomial standard deviations of 300 runs: 5 %; three of the
  // 4,800 from a fresh seed: 0.9 %, which tells 95 % from the 93 % where nothing stands for gains of finer classes
  // unseen.
  const char* fresh = std::getenv("GUMSHOE_LONG_SEED");
  const std::uint64_t first = fresh ? std::strtoull(fresh, nullptr, 10) : 1;
  const quantities::QuantileFunction normal({quantities::Family::normal, {0, 1}, nullptr, nullptr});
  constexpr std::uint64_t n = 16'384;
  const int runs = fresh ? 4'800 : 300;
  for (const double share : {0.3, 0.6, 0.9}) {
    const double a = std::sqrt(share), b = std::sqrt(1 - share), truth = delta_of_normal_sum(a, b);
    int held = 0;
    double width = 0, squares = 0, error = 0;
    for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(runs); ++k) {
      auto x = uniforms(2 * (first + k) + 1'000'001, n), y = uniforms(2 * (first + k) + 1'000'002, n);
      normal(x.data(), x.data(), n);
      normal(y.data(), y.data(), n);
      for (std::size_t i = 0; i < n; ++i) y[i] = a * x[i] + b * y[i];
      const auto index = analysis::given_data_pair(x, y, k).delta;
      held += index.low <= truth && truth <= index.high;
      width += (index.high - index.low) / runs;
      squares += (index.value - truth) * (index.value - truth) / runs;
      error += (index.value - truth) / runs;
    }
    INFO("share " << share << ": held " << held << " of " << runs << ", width " << width << ", rms error "
                  << std::sqrt(squares) << ", mean " << error);
    CHECK(held > (fresh ? 0.941 : 0.90) * runs);
    CHECK(width < 1.5 * 2 * 1.96 * std::sqrt(squares)); // not twice too wide
  }
}
