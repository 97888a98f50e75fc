/// Published examples of JCGM 100, 101 and 102 through toy models: the law of propagation, its traps, validation.
#include "gum_models.h"

using namespace gum_models;

namespace {

struct Sum4 {
  static constexpr const char* inputs[] = {"x1", "x2", "x3", "x4"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] + x[1] + x[2] + x[3]; }
};
struct Mass { // mg, kg/m3
  static constexpr const char* inputs[] = {"m_rc", "dm_rc", "a", "rho_w", "rho_r"};
  static constexpr const char* outputs[] = {"dm"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) {
    y[0] = (x[0] + x[1]) * (1.0 + (x[2] - 1.2) * (1.0 / x[3] - 1.0 / x[4])) - 1e5;
  }
};
struct Loss {
  static constexpr const char* inputs[] = {"x1", "x2"};
  static constexpr const char* outputs[] = {"dy"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] * x[0] + x[1] * x[1]; }
};
struct GaugeBlock { // nm, 1/K, K
  static constexpr const char* inputs[] = {"l_s", "d", "d1", "d2", "a_s", "th0", "delta", "da", "dt"};
  static constexpr const char* outputs[] = {"dl"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) {
    y[0] = x[0] + x[1] + x[2] + x[3] - x[0] * (x[7] * (x[5] + x[6]) + x[4] * x[8]) - 5e7;
  }
};
struct Impedance {
  static constexpr const char* inputs[] = {"v", "i", "phi"};
  static constexpr const char* outputs[] = {"r", "x", "z"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* q, T* y) {
    y[2] = q[0] / q[1];
    y[0] = y[2] * num::cos(q[2]);
    y[1] = y[2] * num::sin(q[2]);
  }
};

const double root3 = std::sqrt(3.0);
quantities::Component arcsine(double half) { return component(Family::arcsine, {-half, half}); }

/// |ours - reference| within 4 standard errors, and half the last digit of what is printed.
void near(double ours, double reference, double se, double half_digit = 0) {
  INFO(ours << " against " << reference << ", standard error " << se);
  CHECK(std::fabs(ours - reference) <= 4 * se + half_digit);
}

} // namespace

TEST_CASE("JCGM 101 9.2.3: validated to two digits, not to three", "[references][gum]") {
  const Input x{0, {rectangular(root3)}};
  auto s = scenario_of<Sum4>({x, x, x, x}, 2'000'000);
  const double exact = 2 * root3 * (2 - std::pow(0.6, 0.25)); // of the sum of four rectangulars, in closed form
  for (const int digits : {2, 3}) {
    s.analysis.validation_digits = digits;
    const auto r = analysed(s);
    CHECK(r.budgets[0].combined_standard_uncertainty == Approx(2).epsilon(1e-12));
    CHECK(r.budgets[0].expanded_uncertainty == Approx(3.919928).epsilon(1e-6));
    near(r.summaries[0].symmetric.high, exact, r.summaries[0].symmetric.high_se);
    CHECK(r.validations[0].delta == Approx(digits == 2 ? 0.05 : 0.005));
    // At three digits the Monte Carlo tolerance (0.005) is above delta / 5, but the ends differ by 0.041.
    CHECK(r.validations[0].verdict == (digits == 2 ? "validated" : "not validated"));
    if (digits == 3) CHECK(r.validations[0].monte_carlo_tolerance > r.validations[0].delta / 5);
  }
}

TEST_CASE("JCGM 101 9.3: mass calibration, first order misses what second order finds", "[references][gum]") {
  auto s = scenario_of<Mass>({{1e5, {normal(0.05)}},
                              {1.234, {normal(0.02)}},
                              {1.2, {rectangular(0.1)}},
                              {8000, {rectangular(1000)}},
                              {8000, {rectangular(50)}}},
                             1'000'000);
  s.analysis.validation_digits = 1; // u_c = 0.05: delta = 0.005
  const auto r = analysed(s);
  const auto& b = r.budgets[0];
  CHECK(b.combined_standard_uncertainty == Approx(0.053852).epsilon(1e-4));
  CHECK(b.second_order_uncertainty == Approx(0.0749635).epsilon(1e-4));
  near(r.summaries[0].standard_uncertainty, 0.0754797, r.summaries[0].standard_uncertainty_se);
  near(r.summaries[0].symmetric.low, 1.08449, r.summaries[0].symmetric.low_se, 5e-6);
  near(r.summaries[0].symmetric.high, 1.38351, r.summaries[0].symmetric.high_se, 5e-6);
  CHECK(r.validations[0].delta == Approx(0.005));
  CHECK(r.validations[0].verdict == "not validated");
}

TEST_CASE("JCGM 101 9.4: first order gives u = 0 at zero and is not validated; nothing lies below zero",
          "[references][gum]") {
  for (const double correlation : {0.0, 0.9})
    for (const double x1 : {0.0, 0.010, 0.050}) {
      auto s = scenario_of<Loss>({{x1, {normal(0.005)}}, {0, {normal(0.005)}}}, 400'000);
      if (correlation != 0)
        s.correlations.push_back(
            {quantities::Correlation::Kind::pearson, {"x1", "x2"}, {1, correlation, correlation, 1}});
      const auto r = analysed(s);
      const auto& m = r.summaries[0];
      const double u2 = 0.005 * 0.005;
      INFO("x1 = " << x1 << ", r = " << correlation);
      near(m.estimate, x1 * x1 + 2 * u2, m.estimate_se);
      near(m.standard_uncertainty, std::sqrt(4 * x1 * x1 * u2 + 4 * u2 * u2 * (1 + correlation * correlation)),
           m.standard_uncertainty_se);
      CHECK(r.budgets[0].combined_standard_uncertainty == Approx(2 * x1 * 0.005).margin(1e-18));
      CHECK(m.shortest.low >= 0);
      CHECK(m.warning.empty());
      if (x1 == 0) {
        CHECK(r.validations[0].verdict == "not validated");
        CHECK(r.validations[0].reason == "the framework's standard uncertainty is zero");
      }
      if (x1 == 0 && correlation == 0) {
        // Exponential of mean 2 u^2: shortest [0, 2 u^2 ln 20], symmetric by its quantiles.
        near(m.shortest.high, 2 * u2 * std::log(20.0), m.symmetric.high_se);
        near(m.symmetric.low, -2 * u2 * std::log(0.975), m.symmetric.low_se);
        near(m.symmetric.high, -2 * u2 * std::log(0.025), m.symmetric.high_se);
      }
    }
}

TEST_CASE("GUM H.1: end-gauge calibration by the law of propagation", "[references][gum]") {
  auto s = scenario_of<GaugeBlock>({{50'000'623, {normal(25, 18)}},
                                    {215, {normal(5.8, 24)}},
                                    {0, {normal(3.9, 5)}},
                                    {0, {normal(6.7, 8)}},
                                    {11.5e-6, {rectangular(2e-6)}},
                                    {-0.1, {normal(0.2)}},
                                    {0, {arcsine(0.5)}},
                                    {0, {component(Family::rectangular, {-1e-6, 1e-6}, 50)}},
                                    {0, {component(Family::rectangular, {-0.05, 0.05}, 2)}}},
                                   20'000);
  s.analysis.coverage_probability = 0.99;
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 0, 0.99);
  CHECK(b.estimate == Approx(838).margin(1e-6));
  CHECK(b.combined_standard_uncertainty == Approx(31.664).margin(5e-4));
  CHECK(b.effective_degrees_of_freedom == 16); // 16.75, truncated
  CHECK(b.coverage_factor == Approx(2.92).margin(0.005));
  CHECK(b.expanded_uncertainty == Approx(2.920782 * 31.664).margin(2e-3)); // printed 93 = 2.92 * 32, from a rounded u_c
  // 11.73 nm from da times the temperature, 1.667 nm from a_s times dt.
  CHECK(b.second_order_uncertainty == Approx(33.81).margin(0.005));
  CHECK(std::sqrt(std::pow(b.second_order_uncertainty, 2) - std::pow(b.combined_standard_uncertainty, 2)) ==
        Approx(std::hypot(11.73, 1.667)).margin(0.01));
}

TEST_CASE("JCGM 101 9.5: the gauge block by Monte Carlo", "[references][gum]") {
  const auto trapezoid = [](double half, double inexact) {
    return component(Family::curvilinear_trapezoid, {-half, half, inexact});
  };
  auto s = scenario_of<GaugeBlock>({{50'000'623, {student(25, 18)}},
                                    {215, {student(6, 24)}},
                                    {0, {student(4, 5)}},
                                    {0, {student(7, 8)}},
                                    {11.5e-6, {rectangular(2e-6)}},
                                    {-0.1, {normal(0.2)}},
                                    {0, {arcsine(0.5)}},
                                    {0, {trapezoid(1e-6, 1e-7)}},
                                    {0, {trapezoid(0.05, 0.025)}}},
                                   1'000'000);
  s.analysis.coverage_probability = 0.99;
  const auto m = analysed(s).summaries[0];
  near(m.estimate, 838, m.estimate_se);
  near(m.standard_uncertainty, 35.806, m.standard_uncertainty_se, 5e-4);
  near(m.symmetric.low, 744.39, m.symmetric.low_se, 5e-3);
  near(m.symmetric.high, 931.70, m.symmetric.high_se, 5e-3);
}

TEST_CASE("GUM H.2: three correlated outputs of inputs with the same degrees of freedom", "[references][gum]") {
  auto s = scenario_of<Impedance>({{4.9990, {normal(0.00320936, 4)}},
                                   {19.6610e-3, {normal(0.00947101e-3, 4)}},
                                   {1.04446, {normal(0.000752064, 4)}}},
                                  1'000'000);
  const double vi = -0.355311, vp = 0.857624, ip = -0.645111;
  s.correlations.push_back(
      {quantities::Correlation::Kind::pearson, {"v", "i", "phi"}, {1, vi, vp, vi, 1, ip, vp, ip, 1}});
  const auto r = analysed(s);
  const double value[] = {127.732170, 219.846512, 254.259702}, u[] = {0.0710714, 0.295582, 0.236336};
  for (std::size_t o = 0; o < 3; ++o) {
    const auto& b = r.budgets[o];
    CHECK(b.estimate == Approx(value[o]).margin(1e-6));
    CHECK(b.combined_standard_uncertainty == Approx(u[o]).epsilon(2e-5)); // inputs given to six digits
    // As in approach 2 of H.2.4, in which each output is the mean of five values: k = t_0.975(4).
    CHECK(b.effective_degrees_of_freedom == 4);
    CHECK(b.coverage_factor == Approx(2.776445).epsilon(1e-6));
    near(r.summaries[o].standard_uncertainty, u[o], r.summaries[o].standard_uncertainty_se, 1e-5 * u[o]);
  }
  REQUIRE(r.joint.size() == 1);
  const auto& j = r.joint[0];
  const auto coefficient = [&](std::size_t a, std::size_t b) {
    const auto& c = j.gum_covariance;
    return c[3 * a + b] / std::sqrt(c[4 * a] * c[4 * b]);
  };
  CHECK(coefficient(0, 1) == Approx(-0.588430).margin(1e-4));
  CHECK(coefficient(0, 2) == Approx(-0.485259).margin(1e-4));
  CHECK(coefficient(1, 2) == Approx(0.992512).margin(1e-5));
  // Fisher: the standard error of r is (1 - r^2) / sqrt(M).
  near(j.correlation[1], coefficient(0, 1), (1 - 0.588 * 0.588) / 1e3);
  near(j.correlation[5], coefficient(1, 2), (1 - 0.9925 * 0.9925) / 1e3);
}

TEST_CASE("t with two degrees of freedom: quantiles, and no standard uncertainty", "[references][gum]") {
  const Input exact{0, {}};
  const auto r = analysed(scenario_of<Sum4>({{0, {student(1, 2)}}, exact, exact, exact}, 400'000));
  const auto& m = r.summaries[0];
  CHECK(std::isnan(m.standard_uncertainty));
  CHECK_FALSE(m.warning.empty());
  near(m.symmetric.high, 4.302653, m.symmetric.high_se);
  near(m.symmetric.low, -4.302653, m.symmetric.low_se);
}
