/// The reverse question against closed forms of linear models.
#include "gum_models.h"

#include "analysis/target.h"

using namespace gum_models;

namespace {

struct Linear {
  static constexpr const char* inputs[] = {"a", "b", "c", "idle"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = 2.0 * x[0] + x[1] - x[2] + 0.0 * x[3]; }
};
struct Square {
  static constexpr const char* inputs[] = {"a", "b"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] + x[1] * x[1]; }
};

constexpr double k = 1.959964;
/// Relative standard error of U from 1e5 points of a normal distribution: of two quantiles' difference.
const double u_error = std::sqrt(0.025 * 0.95 / 2 / 1e5) / 0.058445 / k;

scenario::Scenario linear(double wanted, std::vector<std::pair<std::string, double>> costs = {}) {
  auto s = scenario_of<Linear>({{1, {normal(1)}}, {2, {normal(1)}}, {3, {normal(2)}}, {0, {normal(1)}}}, 100'000);
  scenario::Target t;
  t.measurand = "y";
  t.expanded_uncertainty = wanted;
  t.costs = std::move(costs);
  s.analysis.targets.push_back(t);
  return s;
}
analysis::TargetResult asked(const scenario::Scenario& s) { return analysed(s).targets.at(0); }

} // namespace

TEST_CASE("allowed standard uncertainties of a linear model", "[target]") {
  // u_c^2 = 4 + 1 + 4 = 9 at present.
  for (const double variance : {7.0, 12.0}) {
    const auto r = asked(linear(k * std::sqrt(variance)));
    INFO(r.statement);
    CHECK(r.present == Approx(3 * k).epsilon(4 * u_error));
    REQUIRE(r.rows.size() == 4);
    const double coefficient[] = {2, 1, 1}, own[] = {4, 1, 4};
    for (std::size_t i = 0; i < 3; ++i) {
      const double left = variance - 9 + own[i];
      INFO(r.rows[i].quantity);
      if (left < 0) {
        CHECK(std::isnan(r.rows[i].allowed));
        CHECK(std::isnan(r.rows[i].allowed_gum));
        continue;
      }
      const double exact = std::sqrt(left) / coefficient[i];
      // d ln u_i = (variance / left) d ln U: the others' fluctuation falls on the one that is free.
      CHECK(r.rows[i].allowed == Approx(exact).epsilon(4 * u_error * variance / left + 1e-3));
      CHECK(r.rows[i].allowed_gum == Approx(exact).epsilon(1.1e-3));
    }
    // What does not matter has no limit where the target is met, and no remedy where it is not.
    CHECK((variance > 9 ? std::isinf(r.rows[3].allowed) : std::isnan(r.rows[3].allowed)));
  }
}

TEST_CASE("a target below what the other quantities cause cannot be reached by one alone", "[target]") {
  const auto r = asked(linear(k * 2.0)); // rest without any one: 5, 8, 5 > 4
  for (const auto& row : r.rows) CHECK(std::isnan(row.allowed));
}

TEST_CASE("the cheapest combination", "[target]") {
  // Costs 1, 8, none for c: s ~ (cost / q)^(1/3), q = 4, 1: s_b / s_a = (8 * 4)^(1/3). Rest 4 of c.
  const double variance = 7;
  const auto r = asked(linear(k * std::sqrt(variance), {{"a", 1}, {"b", 8}}));
  INFO(r.statement);
  const double s_a = std::cbrt(1 / 4.0), s_b = 2;
  const double common = std::sqrt((variance - 4) / (4 * s_a * s_a + s_b * s_b));
  CHECK(r.rows[1].cheapest / r.rows[0].cheapest == Approx(s_b / s_a).epsilon(1e-9));
  CHECK(r.rows[0].cheapest == Approx(common * s_a).epsilon(4 * u_error * variance / 3 + 1e-3));
  CHECK(std::isnan(r.rows[2].cheapest));
  CHECK(r.reached <= r.wanted);
  CHECK(r.reached == Approx(r.wanted).epsilon(1.1e-3));
  const double cost = (1 / (common * s_a) + 8 / (common * s_b)) / 9;
  CHECK(r.cost_ratio == Approx(cost).epsilon(4 * u_error * variance / 3 + 1e-3));
  // No other split of the same variance is cheaper.
  for (double x = 0.05; x < 1; x += 0.05)
    CHECK(1 / std::sqrt(3 * x / 4) + 8 / std::sqrt(3 * (1 - x)) >= 9 * cost * (1 - 1e-9));
}

TEST_CASE("costs that cannot reach the target", "[target]") {
  const auto r = asked(linear(k * 1.5, {{"b", 1}}));
  CHECK(std::isnan(r.reached));
  CHECK(std::isnan(r.rows[1].cheapest));
  CHECK(r.statement.find("exceed the target") != std::string::npos);
}

TEST_CASE("a quantity without derivative: first order knows no limit, Monte Carlo does", "[target]") {
  auto s = scenario_of<Square>({{0, {normal(0.1)}}, {0, {normal(1)}}}, 100'000);
  scenario::Target t;
  t.measurand = "y", t.expanded_uncertainty = 1;
  t.costs = {{"b", 1}};
  s.analysis.targets.push_back(t);
  const auto r = asked(s);
  CHECK(std::isinf(r.rows[1].allowed_gum));
  // U of b^2 alone, about its mean u^2: the 95 % quantile of chi-square less 1, 2.841 u^2: u below sqrt(1 / 2.841) =
  // 0.593. Half of the symmetric interval, 2.511 u^2, would allow 0.631.
  CHECK(r.rows[1].allowed < 0.594);
  CHECK(r.rows[1].allowed > 0.55);
  CHECK(r.reached == Approx(1).epsilon(2.1e-3));
  CHECK(r.rows[1].cheapest == Approx(r.rows[1].allowed).epsilon(2.1e-3)); // only one to pay for
}

TEST_CASE("the U of a target is the one that the result states", "[target]") {
  // Asymmetric: y = a + b^2. With other draws than those of the trials, it is still one number.
  auto s = scenario_of<Square>({{0, {normal(0.1)}}, {0, {normal(1)}}}, 200'000);
  scenario::Target t;
  t.measurand = "y", t.expanded_uncertainty = 1;
  s.analysis.targets.push_back(t);
  const auto r = analysed(s);
  CHECK(r.targets.at(0).present == Approx(r.summaries[0].expanded_uncertainty).epsilon(1e-12));
  auto linear_one = linear(k);
  const auto l = analysed(linear_one);
  CHECK(l.targets.at(0).present == Approx(l.summaries[0].expanded_uncertainty).epsilon(1e-12));
}

TEST_CASE("correlated inputs: U may be least at an uncertainty above zero", "[target]") {
  // y = b - c, r = 0.9, u(c) = 2: variance u^2 + 4 - 3.6 u, least 0.76 at u = 1.8; at the present u = 4: 5.6.
  auto s = scenario_of<Linear>({{1, {}}, {2, {normal(4)}}, {3, {normal(2)}}, {0, {}}}, 100'000);
  s.correlations.push_back({quantities::Correlation::Kind::pearson, {"b", "c"}, {1, 0.9, 0.9, 1}});
  scenario::Target t;
  t.measurand = "y", t.expanded_uncertainty = k; // variance 1: u = 1.8 + sqrt(3.24 - 3) = 2.29
  s.analysis.targets.push_back(t);
  const auto r = asked(s);
  CHECK(r.rows[0].allowed_gum == Approx(1.8 + std::sqrt(0.24)).epsilon(2e-3));
  // d(variance)/du = 2 u - 3.6 = 0.98, so that du = 2 * variance * dU/U / 0.98.
  CHECK(r.rows[0].allowed == Approx(1.8 + std::sqrt(0.24)).margin(4 * u_error * 2 / 0.98 + 3e-3));
}

TEST_CASE("targets do not depend on threads", "[target]") {
  const auto s = linear(k * std::sqrt(7.0), {{"a", 1}, {"b", 8}});
  const propagation::Experiment e(s);
  const std::vector<analysis::Budget> budgets{analysis::budget(e, 0, 0.95)};
  const std::vector<analysis::Summary> summaries(1);
  const auto one = analysis::target_uncertainties(e, summaries, budgets, 1)[0],
             three = analysis::target_uncertainties(e, summaries, budgets, 3)[0];
  for (std::size_t i = 0; i < 3; ++i)
    CHECK((one.rows[i].allowed == three.rows[i].allowed || std::isnan(one.rows[i].allowed)));
  CHECK(one.reached == three.reached);
}
