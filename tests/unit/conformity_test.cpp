/// JCGM 106 against closed forms for normal distributions.
#include "gum_models.h"

#include <numbers>

#include "analysis/conformity.h"
#include "quantities/distribution.h"

using namespace gum_models;
using scenario::ConformityTest;

namespace {

constexpr std::size_t n = 100'000;
double Phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
double phi(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

/// The quantiles of a distribution at (k + 1/2) / n: its moments and probabilities to about 1 / n.
std::vector<double> stratified(const quantities::Distribution& d, double shift = 0) {
  std::vector<double> y;
  for (std::size_t k = 0; k < n; ++k) y.push_back(shift + d.quantile((static_cast<double>(k) + 0.5) / n));
  return y;
}
quantities::Distribution gauss(double mean, double u) { return {Family::normal, {mean, u}, nullptr, nullptr}; }

struct Risks {
  double consumer, producer;
};
/// The integrals of JCGM 106 over a normal process and a normal measurement, by the midpoint rule in eta.
Risks by_quadrature(double m0, double u0, double u, double low, double high, double w) {
  Risks r{0, 0};
  const int steps = 400'000;
  for (int i = 0; i < steps; ++i) {
    const double z = -9 + 18 * (i + 0.5) / steps, eta = m0 + u0 * z, weight = phi(z) * 18 / steps;
    const double accepted = Phi((high - w - eta) / u) - Phi((low + w - eta) / u);
    (eta < low || eta > high ? r.consumer : r.producer) += weight * (eta < low || eta > high ? accepted : 1 - accepted);
  }
  return r;
}

} // namespace

TEST_CASE("conformance probability of a normal measurement is a difference of normal probabilities", "[conformity]") {
  ConformityTest t;
  t.lower = 1.2, t.upper = 3.1;
  const auto r = analysis::assess(stratified(gauss(2.5, 0.4)), {2.5, 0.4, 0.8}, t);
  const double p = Phi((3.1 - 2.5) / 0.4) - Phi((1.2 - 2.5) / 0.4);
  CHECK(std::fabs(r.conformance_probability - p) < 2.0 / n);
  CHECK(r.conformance_probability_se == Approx(std::sqrt(p * (1 - p) / n)).epsilon(1e-2));
  CHECK(r.accepted);
  CHECK(r.specific_consumer_risk == Approx(1 - p).epsilon(1e-3));
  CHECK(std::isnan(r.specific_producer_risk));
  CHECK(std::isnan(r.global_consumer_risk));
}

TEST_CASE("an estimate on a one-sided limit conforms with probability one half", "[conformity]") {
  ConformityTest upper, lower;
  upper.upper = 7, lower.lower = 7;
  const auto y = stratified(gauss(7, 0.3));
  CHECK(analysis::assess(y, {7, 0.3, 0.6}, upper).conformance_probability == Approx(0.5).margin(2.0 / n));
  CHECK(analysis::assess(y, {7, 0.3, 0.6}, lower).conformance_probability == Approx(0.5).margin(2.0 / n));
  CHECK(std::isnan(analysis::assess(y, {7, 0.3, 0.6}, upper).acceptance_lower));
  CHECK(analysis::assess(y, {7, 0.3, 0.6}, upper).accepted); // the limit belongs to the tolerance
}

TEST_CASE("guard bands: positive inside, negative outside; a factor is of U", "[conformity]") {
  ConformityTest t;
  t.lower = 0, t.upper = 10, t.guard_factor = 1;
  const auto y = stratified(gauss(9.5, 0.5));
  const auto guarded = analysis::assess(y, {9.5, 0.5, 1.0}, t);
  CHECK(guarded.guard_band == 1.0);
  CHECK(guarded.acceptance_lower == 1.0);
  CHECK(guarded.acceptance_upper == 9.0);
  CHECK_FALSE(guarded.accepted);
  CHECK(guarded.specific_producer_risk == Approx(Phi(1)).margin(2.0 / n));
  CHECK(std::isnan(guarded.specific_consumer_risk));
  t.guard_factor = 0, t.guard_band = -0.2;
  const auto loose = analysis::assess(stratified(gauss(10.1, 0.5)), {10.1, 0.5, 1.0}, t);
  CHECK(loose.acceptance_upper == Approx(10.2));
  CHECK(loose.accepted);
}

TEST_CASE("global risks of a normal process measured with a normal error", "[conformity]") {
  for (const double w : {0.0, 0.08, -0.05})
    for (const double m0 : {1500.0, 1500.07}) {
      ConformityTest t;
      t.lower = 1499.8, t.upper = 1500.2, t.guard_band = w;
      t.process = gauss(0, 0.12);
      t.process_value = m0;
      const auto r = analysis::assess(stratified(gauss(1500.1, 0.04)), {1500.1, 0.04, 0.08}, t);
      const Risks exact = by_quadrature(m0, 0.12, 0.04, 1499.8, 1500.2, w);
      INFO("w = " << w << ", process mean " << m0);
      CHECK(r.global_consumer_risk == Approx(exact.consumer).epsilon(1e-3));
      CHECK(r.global_producer_risk == Approx(exact.producer).epsilon(1e-3));
      CHECK(r.process_conformance == Approx(Phi((1500.2 - m0) / 0.12) - Phi((1499.8 - m0) / 0.12)).epsilon(1e-9));
      CHECK(r.global_consumer_risk_se < 0.05 * r.global_consumer_risk);
      // Normal times normal: the posterior is normal with the weights of the precisions.
      const double v = 1 / (1 / (0.04 * 0.04) + 1 / (0.12 * 0.12));
      const double mean = v * (1500.1 / (0.04 * 0.04) + m0 / (0.12 * 0.12));
      const double p = Phi((1500.2 - mean) / std::sqrt(v)) - Phi((1499.8 - mean) / std::sqrt(v));
      CHECK(std::fabs(r.posterior_conformance - p) < 1e-4);
    }
}

TEST_CASE("a skew error: what is accepted is the true value minus the deviation", "[conformity]") {
  // Deviations exponential about the estimate, prior rectangular on [0, 10], limit 5 from above, no guard band.
  // Consumer: eta in (5, 10], eta - d <= 5, i.e. eta <= 5 + d: (1/10) E[max(0, d)] with d = x - 1, x exponential of
  // mean 1: E[max(0, x - 1)] = 1/e, less what would lie beyond 10, the share e^-5 of it. Producer: eta <= 5, eta > 5 +
  // d: (1/10) E[max(0, -d)] = 1/(10 e).
  ConformityTest t;
  t.upper = 5;
  t.process = quantities::Distribution{Family::rectangular, {0, 10}, nullptr, nullptr};
  const auto r = analysis::assess(stratified({Family::exponential, {1}, nullptr, nullptr}, 3.0), {4.0, 0.75, 1.5}, t);
  CHECK(r.global_consumer_risk == Approx(0.1 * std::exp(-1.0) * (1 - std::exp(-5.0))).epsilon(1e-3));
  CHECK(r.global_producer_risk == Approx(0.1 * std::exp(-1.0)).epsilon(1e-3));
}

TEST_CASE("without measurement uncertainty nobody bears a risk", "[conformity]") {
  ConformityTest t;
  t.lower = -1, t.upper = 1;
  t.process = gauss(0, 1);
  const auto r = analysis::assess(std::vector<double>(1000, 0.3), {0.3, 0, 0}, t);
  CHECK(r.conformance_probability == 1);
  CHECK(r.conformance_probability_se > 0); // none of a thousand is not none
  CHECK(r.global_consumer_risk == 0);
  CHECK(r.global_producer_risk == Approx(0).margin(1e-15));
}

TEST_CASE("symmetry: mirrored limits and process, the same risks", "[conformity]") {
  ConformityTest a, b;
  a.lower = -1, a.upper = 2, a.guard_band = 0.1, a.process = gauss(0.4, 0.9);
  b.lower = -2, b.upper = 1, b.guard_band = 0.1, b.process = gauss(-0.4, 0.9);
  const auto y = stratified(gauss(0, 0.3));
  const auto ra = analysis::assess(y, {0, 0.3, 0.6}, a), rb = analysis::assess(y, {0, 0.3, 0.6}, b);
  CHECK(ra.global_consumer_risk == Approx(rb.global_consumer_risk).epsilon(1e-9));
  CHECK(ra.global_producer_risk == Approx(rb.global_producer_risk).epsilon(1e-9));
  CHECK(ra.posterior_conformance == Approx(rb.posterior_conformance).epsilon(1e-9));
}

TEST_CASE("a process far from the measurement, or without density: no posterior, and no crash", "[conformity]") {
  ConformityTest t;
  t.upper = 1;
  t.process = gauss(100, 0.01);
  CHECK(std::isnan(analysis::assess(stratified(gauss(0, 1)), {0, 1, 2}, t).posterior_conformance));
  t.process = quantities::Distribution{Family::discrete,
                                       {},
                                       std::make_shared<std::vector<double>>(std::vector{0.0, 1.0, 2.0}),
                                       std::make_shared<std::vector<double>>(std::vector{0.25, 0.5, 0.25})};
  const auto r = analysis::assess(stratified(gauss(0.5, 0.1)), {0.5, 0.1, 0.2}, t);
  CHECK(std::isnan(r.posterior_conformance));
  CHECK(r.process_conformance == Approx(0.75));                     // the value on the limit conforms
  CHECK(r.global_producer_risk == Approx(0.5 * 0.5).epsilon(1e-3)); // of the items on the limit half are rejected
}

namespace {
struct Plain {
  static constexpr const char* inputs[] = {"x"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] + 0.0; }
};
} // namespace

TEST_CASE("numbers are accompanied by their definitions", "[conformity]") {
  auto s = scenario_of<Plain>({{1, {normal(0.1)}}}, 20'000);
  ConformityTest t;
  t.measurand = "y", t.upper = 1.1, t.guard_factor = 1, t.process = gauss(1, 0.05);
  s.analysis.conformity.push_back(t);
  const auto r = analysed(s);
  REQUIRE(r.conformity.size() == 1);
  const auto& c = r.conformity[0];
  CHECK(c.guard_band == Approx(0.196).epsilon(0.03)); // 1.96 u
  for (const char* word :
       {"guarded acceptance", "rejected", "Specific producer's risk", "global consumer's risk", "prior knowledge"})
    CHECK(c.statement.find(word) != std::string::npos);
}

TEST_CASE("the guard band follows from the U that the result states", "[conformity]") {
  // Exponential of mean 1: about the mean, U = ln 20 - 1 = 2.00; half the symmetric interval is (ln 40 - ln(40/39)) / 2
  // = 1.83.
  auto s = scenario_of<Plain>({{0, {component(Family::exponential, {1})}}}, 100'000);
  ConformityTest t;
  t.measurand = "y", t.upper = 4, t.rule = scenario::DecisionRule::ilac_g8;
  s.analysis.conformity.push_back(t);
  const auto r = analysed(s);
  REQUIRE(r.conformity.size() == 1);
  REQUIRE(r.validations[0].verdict == "not validated");
  CHECK(r.conformity[0].guard_band == r.summaries[0].expanded_uncertainty);
  CHECK(r.conformity[0].guard_band == Approx(std::log(20.0) - 1).epsilon(0.02));
}

TEST_CASE("a result without a standard uncertainty has a guard band of half the symmetric interval", "[conformity]") {
  auto s = scenario_of<Plain>({{0, {student(1, 1)}}}, 100'000);
  ConformityTest t;
  t.measurand = "y", t.upper = 100, t.guard_factor = 1;
  s.analysis.conformity.push_back(t);
  const auto r = analysed(s);
  REQUIRE(r.conformity.size() == 1);
  REQUIRE(std::isnan(r.summaries[0].expanded_uncertainty));
  const auto& symmetric = r.summaries[0].symmetric;
  CHECK(r.conformity[0].guard_band == 0.5 * (symmetric.high - symmetric.low));
  CHECK(r.conformity[0].accepted);
}
