/// Elementary effects, derivative-based measures and one-at-a-time tables against closed forms.
#include <catch2/catch.hpp>

#include <cmath>

#include "analysis/poincare.h"
#include "analysis/screening.h"
#include "analysis/summary.h"
#include "base/error.h"
#include "screening_models.h"

using namespace gumshoe;
using namespace screening_models;
using quantities::Family;

TEST_CASE("elementary effects of a linear model are its c_i u_i, without scatter", "[screening]") {
  const auto s = scenario_of<Linear>({normal(0.5), uniform(-1, 1), normal(1)});
  const propagation::Experiment e(s);
  const auto m = analysis::morris_screening(e, 40, 2);
  REQUIRE(m.size() == 1);
  REQUIRE(m[0].rows.size() == 3);
  const double truth[] = {2 * 0.5, -3 / std::sqrt(3.0), 0};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(m[0].rows[i].mean == Approx(truth[i]).margin(1e-12));
    CHECK(m[0].rows[i].mean_absolute == Approx(std::fabs(truth[i])).margin(1e-12));
    CHECK(m[0].rows[i].standard_deviation < 1e-10);
  }
  CHECK(m[0].dropped == 0);
  CHECK(analysis::morris_screening(e, 40, 1)[0].rows[0].mean == m[0].rows[0].mean);
}

TEST_CASE("Ishigami: x3 has no mean effect but interactions; correlated inputs are refused", "[screening]") {
  auto s = scenario_of<Ishigami>({uniform(-pi, pi), uniform(-pi, pi), uniform(-pi, pi)});
  {
    const propagation::Experiment e(s);
    const auto rows = analysis::morris_screening(e, 4000, 2)[0].rows;
    // x3 -> x3 +- pi: mean of sin x1 is zero; four standard errors.
    CHECK(std::fabs(rows[2].mean) < 4 * rows[2].standard_deviation / std::sqrt(4000.0));
    CHECK(rows[2].mean_absolute > 1);
    // sin^2 has period pi: a step of half the range does not see it, which is why the step is stated.
    CHECK(rows[1].mean_absolute < 1e-12);
    // sin x1 changes sign: mu* = E|2 sin x1 (1 + 0.1 x3^4)| / (pi / u) = 4 / pi (1 + 0.1 pi^4 / 5) / sqrt 3.
    const double truth = 4 / pi * (1 + 0.1 * std::pow(pi, 4) / 5) / std::sqrt(3.0);
    CHECK(std::fabs(rows[0].mean_absolute - truth) < 4 * rows[0].mean_absolute_se);
  }
  s.correlations.push_back({quantities::Correlation::Kind::copula, {"x1", "x2"}, {1, 0.5, 0.5, 1}});
  const propagation::Experiment tied(s);
  CHECK_THROWS_AS(analysis::morris_screening(tied, 10, 1), InputError);
}

TEST_CASE("derivative-based measures of Ishigami: closed forms, and bounds above the total indices", "[screening]") {
  const auto s = scenario_of<Ishigami>({uniform(-pi, pi), uniform(-pi, pi), uniform(-pi, pi)});
  const propagation::Experiment e(s);
  const auto values = run(e);
  const auto summary = analysis::summarise(e.outputs()[0], values, 0.95);
  const auto g = analysis::derivative_measures(e, 16384, {summary}, 2);
  REQUIRE(g[0].exact);
  const double p4 = std::pow(pi, 4), p8 = p4 * p4, p6 = std::pow(pi, 6);
  // E[cos^2 (1 + 0.1 x3^4)^2]; E[49 sin^2 2x2]; E[0.16 x3^6 sin^2 x1]; E x^{2k} = pi^{2k} / (2k + 1).
  const double nu[] = {0.5 * (1 + 0.2 * p4 / 5 + 0.01 * p8 / 9), 24.5, 0.16 * 0.5 * p6 / 7};
  const double total[] = {0.5575888552, 0.4424111448, 0.2436836641};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::fabs(g[0].rows[i].nu - nu[i]) < 4 * g[0].rows[i].nu_se);
    CHECK(g[0].rows[i].nu_se < 0.03 * nu[i]);
    CHECK(g[0].rows[i].bound == Approx(4 * nu[i] / 13.8445879407).epsilon(0.1));
    CHECK(g[0].rows[i].bound_low > total[i]);
  }
}

TEST_CASE("a linear model of normals attains the bound", "[screening]") {
  const auto s = scenario_of<Linear>({normal(0.5), normal(1), normal(1)});
  const propagation::Experiment e(s);
  analysis::Summary summary;
  summary.standard_uncertainty = std::sqrt(10.0); // 1 + 9
  const auto rows = analysis::derivative_measures(e, 64, {summary}, 1)[0].rows;
  CHECK(rows[0].bound == Approx(0.1).epsilon(1e-12));
  CHECK(rows[1].bound == Approx(0.9).epsilon(1e-12));
  CHECK(rows[2].bound == 0);
}

TEST_CASE("Poincare constants: closed forms and independent solutions", "[screening]") {
  const auto constant = [](Family f, std::array<double, 4> p) {
    return analysis::poincare_constant({f, p, nullptr, nullptr});
  };
  CHECK(constant(Family::rectangular, {-1, 1}) == Approx(4 / (pi * pi)).epsilon(1e-12));
  CHECK(constant(Family::normal, {3, 2}) == 4);
  CHECK(constant(Family::exponential, {2}) == 16);
  // Triangular: odd solutions J0(sqrt(lambda) s), s from the end, zero in the middle: j_{0,1}^2.
  CHECK(constant(Family::triangular, {-1, 1}) == Approx(1 / std::pow(2.404825557695773, 2)).epsilon(1e-5));
  // A trapezoid between triangle and rectangle; a normal cut far outside is a normal.
  CHECK(constant(Family::trapezoid, {-1, 1, 0.999999}) == Approx(4 / (pi * pi)).epsilon(1e-4));
  CHECK(constant(Family::truncated_normal, {0, 1, -7, 7}) == Approx(1).epsilon(1e-4));
  // Arcsine: g = -cos t: (g' / sin^2 t)' = -lambda g; shoot from t = 0 to the odd solution's zero at pi / 2.
  const auto end = [](double lambda) {
    double g = 1, flux = 0;
    const int steps = 4000;
    const double h = 0.5 * pi / steps;
    for (int i = 0; i < steps; ++i) { // the midpoint rule
      const double t = i * h, a = g + 0.5 * h * flux * std::pow(std::sin(t), 2), b = flux - 0.5 * h * lambda * g;
      g += h * b * std::pow(std::sin(t + 0.5 * h), 2);
      flux -= h * lambda * a;
    }
    return g;
  };
  double low = 0.1, high = 10;
  for (int i = 0; i < 60; ++i) (end(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  CHECK(constant(Family::arcsine, {-1, 1}) == Approx(1 / low).epsilon(1e-4));
  CHECK(std::isnan(constant(Family::t, {0, 1, 5})));
  CHECK(std::isnan(constant(Family::lognormal, {0, 1})));
}

TEST_CASE("one at a time: exact quantities move too, nothing else does", "[screening]") {
  auto s = scenario_of<ProductAndSum>({uniform(1, 3), uniform(4, 6), uniform(0, 2)});
  s.quantities[2].entries[0] = {{}, 1.0, {}, ""}; // exact
  s.analysis.one_at_a_time.push_back({"steps", {{"x1", 0.1}, {"x3", 0.25}}});
  const propagation::Experiment e(s);
  const auto t = analysis::one_at_a_time(e);
  REQUIRE(t.size() == 1);
  REQUIRE(t[0].rows.size() == 2);
  CHECK(t[0].rows[0].up[0] == Approx(0.5).epsilon(1e-12)); // x2 = 5
  CHECK(t[0].rows[0].down[0] == Approx(-0.5).epsilon(1e-12));
  CHECK(t[0].rows[1].up[0] == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("the design hash follows what fixes the samples, and nothing else", "[screening]") {
  const auto hash = [](const scenario::Scenario& s) { return propagation::design_hash(propagation::Experiment(s)); };
  const auto s = scenario_of<Linear>({normal(1), normal(1), normal(1)});
  const std::string base = hash(s);
  CHECK(base.size() == 16);
  auto t = s;
  t.analysis.sensitivity.morris = 10;
  t.analysis.coverage_probability = 0.9;
  t.run.samples *= 2;
  CHECK(hash(t) == base);
  t.run.design = scenario::Design::sobol;
  CHECK(hash(t) != base);
  t = s;
  t.run.seed = 2;
  CHECK(hash(t) != base);
  t = s;
  t.quantities[1].entries[0].value = 1e-9;
  CHECK(hash(t) != base);
  t = s;
  t.quantities[1].entries[0].components[0].distribution = normal(1.0000001);
  CHECK(hash(t) != base);
  t = s;
  t.correlations.push_back({quantities::Correlation::Kind::copula, {"x1", "x2"}, {1, 0.5, 0.5, 1}});
  CHECK(hash(t) != base);
}
