/// Declared degrees of freedom: t distributions, alone and jointly, in both columns of a budget.
#include "gum_models.h"

#include <Eigen/Dense>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "analysis/conditional_draws.h"
#include "calibration/estimated_scenario.h"
#include "unit/estimate_case.h"

using namespace gum_models;
using estimate_case::Case;
using quantities::Correlation;

namespace {

double t_quantile(double freedom, double p = 0.975) {
  return quantile(boost::math::students_t_distribution<double>(freedom), p);
}

std::string sum_of(const std::string& quantities, const std::string& more = "") {
  return "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"a + b\"\n" + quantities +
         "[run]\nsamples = 1_000_000\n" + more;
}

constexpr double scale_of[] = {1, 3, 0.5};
constexpr double matrix_of[] = {1, 0.6, -0.3, 0.6, 1, 0.2, -0.3, 0.2, 1};

/// Three estimates of one fit, jointly t with `freedom` degrees of freedom.
quantities::SamplePlan jointly_t(double freedom) {
  std::vector<quantities::InputQuantity> q;
  for (std::size_t i = 0; i < 3; ++i)
    q.push_back({"q" + std::to_string(i), "1", "1", {{{}, 0, {student(scale_of[i], freedom)}, ""}}});
  const Correlation tie{Correlation::Kind::multivariate_t, {"q0", "q1", "q2"}, {matrix_of, matrix_of + 9}};
  const std::vector<quantities::Reading> readings(1);
  return quantities::make_plan(q, {&tie, 1}, readings, 3);
}

/// d^2 / 3 of standardised rows, d Mahalanobis' distance: F(3, freedom), whatever the correlation.
std::vector<double> distances(const double* rows, std::size_t n, std::size_t stride) {
  Eigen::Matrix3d r;
  for (int i = 0; i < 9; ++i) r(i / 3, i % 3) = matrix_of[i];
  const Eigen::Matrix3d inverse = r.inverse();
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d x(rows[i] / scale_of[0], rows[stride + i] / scale_of[1], rows[2 * stride + i] / scale_of[2]);
    out.push_back(x.dot(inverse * x) / 3);
  }
  return out;
}

void check_f_law(std::vector<double> d, double freedom) {
  std::sort(d.begin(), d.end());
  const boost::math::fisher_f_distribution<double> f(3, freedom);
  const double n = static_cast<double>(d.size());
  for (const double p : {0.1, 0.5, 0.9, 0.99}) { // the share below a quantile, by 4 binomial standard deviations
    const double below = static_cast<double>(std::lower_bound(d.begin(), d.end(), quantile(f, p)) - d.begin()) / n;
    INFO(freedom << " degrees of freedom, p = " << p);
    CHECK(std::fabs(below - p) < 4 * std::sqrt(p * (1 - p) / n));
  }
}

} // namespace

TEST_CASE("u with degrees of freedom is a t in Monte Carlo and in the framework", "[freedom]") {
  // Alone: y = a, so that both intervals are exactly t. A normal would give +-1.96 u.
  for (const char* stated : {"u = 0.57\ndegrees_of_freedom = 9\n", "U = 1.14\nk = 2\ndegrees_of_freedom = 9\n",
                             "distribution = \"normal\"\nu = 0.57\ndegrees_of_freedom = 9\n"}) {
    const Case c(sum_of(std::string("[quantities.a]\nvalue = 0\n") + stated + "[quantities.b]\nvalue = 0\n"));
    const auto r = analysed(c.scenario);
    const double end = 0.57 * t_quantile(9);
    INFO(stated);
    CHECK(std::fabs(r.summaries[0].symmetric.high - end) < 4 * r.summaries[0].symmetric.high_se);
    CHECK(std::fabs(r.summaries[0].symmetric.low + end) < 4 * r.summaries[0].symmetric.low_se);
    CHECK(r.summaries[0].symmetric.high_se < (end - 1.96 * 0.57) / 10); // tells t from normal
    CHECK(r.budgets[0].expanded_uncertainty == Approx(end).epsilon(1e-9));
    CHECK(r.budgets[0].effective_degrees_of_freedom == 9);
    CHECK(r.validations[0].verdict != "not validated");
  }
}

TEST_CASE("degrees of freedom of other families enter the framework only", "[freedom]") {
  // GUM G.4.2: the reliability of the half-width of a rectangular distribution.
  const Case c(sum_of("[quantities.a]\nvalue = 0\ndistribution = \"rectangular\"\nhalf_width = 1\ndegrees_of_freedom = "
                      "8\n[quantities.b]\nvalue = 0\n"));
  const auto r = analysed(c.scenario);
  CHECK(r.budgets[0].effective_degrees_of_freedom == 8);
  CHECK(r.summaries[0].symmetric.high == Approx(0.95).epsilon(2e-3));
}

TEST_CASE("a joint t distribution has t margins and the F law of its distances", "[freedom][sampler]") {
  constexpr std::size_t n = 1 << 17;
  for (const double freedom : {1.0, 4.0, 12.5}) {
    const auto plan = jointly_t(freedom);
    std::vector<double> rows(3 * n);
    for (const auto design : {quantities::PointSet::monte_carlo, quantities::PointSet::sobol}) {
      quantities::Sampler(plan, design, n).draw(0, n, quantities::Purpose::sampling, rows.data(), n);
      check_f_law(distances(rows.data(), n, n), freedom);
      for (std::size_t i = 0; i < 3; ++i) {
        const double end = scale_of[i] * t_quantile(freedom, 0.9);
        const auto beyond = std::count_if(&rows[i * n], &rows[i * n] + n, [&](double x) { return x > end; });
        CHECK(std::fabs(static_cast<double>(beyond) / n - 0.1) < 4 * std::sqrt(0.09 / n));
      }
    }
  }
}

TEST_CASE("what is left free of a joint t follows its conditional distribution", "[freedom][shapley]") {
  // A mixture of frozen and conditionally drawn members is distributed as the whole; free members that ignored the
  // scale shared with the frozen ones would not follow the F law.
  constexpr std::size_t n = 1 << 16;
  for (const double freedom : {3.0, 10.0}) {
    const auto plan = jointly_t(freedom);
    const analysis::ConditionalDraws draws(plan);
    for (const std::vector<bool>& frozen : {std::vector<bool>{true, false, false}, {false, true, true}, {false, false, false}}) {
      auto block = draws.draw(0, n);
      draws.mix(block, frozen, 0, n);
      check_f_law(distances(block.mixed.data(), n, n), freedom);
      for (std::size_t v = 0; v < 3; ++v)
        CHECK(std::equal(&block.a[v * n], &block.a[v * n] + n, &block.mixed[v * n]) == frozen[v]);
    }
  }
}

TEST_CASE("inputs of one fit have its degrees of freedom, correlated or not", "[freedom]") {
  const std::string pair = "[quantities.a]\nvalue = 0\nu = 1\ndegrees_of_freedom = 4\n[quantities.b]\nvalue = 0\nu = "
                           "2\ndegrees_of_freedom = 4\n";
  const double u = std::sqrt(1 + 4 - 2 * 0.7 * 2), end = u * t_quantile(4);
  const auto tied = [&](const std::string& kind) {
    return "[[correlations]]\nquantities = [\"a\", \"b\"]\nkind = \"" + kind + "\"\ncoefficient = -0.7\n";
  };
  {
    const Case c(sum_of(pair, tied("multivariate_t")));
    const auto r = analysed(c.scenario);
    CHECK(r.budgets[0].combined_standard_uncertainty == Approx(u).epsilon(1e-12));
    CHECK(r.budgets[0].effective_degrees_of_freedom == 4);
    CHECK(r.budgets[0].expanded_uncertainty == Approx(end).epsilon(1e-12));
    CHECK(r.budgets[0].remark.empty());
    // A sum of members of a multivariate t is a t again: the Monte Carlo interval is the framework's.
    CHECK(std::fabs(r.summaries[0].symmetric.high - end) < 4 * r.summaries[0].symmetric.high_se);
    CHECK(r.summaries[0].symmetric.high_se < end / 200);
  }
  // A third, independent input: G.4.1 over the fit as one term, (5 - 2.8)^2 / 4 of it.
  {
    auto text = sum_of(pair + "[quantities.d]\nvalue = 0\nu = 1\ndegrees_of_freedom = 10\n", tied("multivariate_t"));
    text.replace(text.find("a + b"), 5, "a + b + d");
    const auto b = analysed(Case(text).scenario).budgets[0];
    CHECK(b.effective_degrees_of_freedom == std::floor(std::pow(u * u + 1, 2) / (std::pow(u, 4) / 4 + 1.0 / 10)));
  }
  CHECK(analysed(Case(sum_of(pair, tied("copula"))).scenario).budgets[0].effective_degrees_of_freedom == 4);
  auto unequal = pair;
  unequal.replace(unequal.rfind("4"), 1, "9");
  const auto b = analysed(Case(sum_of(unequal, tied("copula"))).scenario).budgets[0];
  CHECK(std::isnan(b.effective_degrees_of_freedom));
  CHECK_THAT(b.remark, Catch::Contains("different degrees of freedom"));
  CHECK_THROWS_WITH(Case(sum_of(unequal, tied("multivariate_t"))),
                    Catch::Contains("has 9 degrees of freedom") && Catch::Contains("share the degrees of freedom"));
}

TEST_CASE("a straight line through six points: the estimate, run, gives +-t_4 u in both columns", "[freedom][calibration]") {
  const std::vector<double> x{0, 1, 2, 3, 4, 5}, y{1.02, 2.9, 5.3, 6.8, 9.1, 10.9};
  const Case fit(estimate_case::line(x, y, estimate_case::free_line));
  const auto estimate = calibration::estimate(fit.experiment);
  REQUIRE(estimate.degrees_of_freedom == 4);
  std::string text = calibration::estimated_scenario(fit.experiment, estimate, fit.folder.path());
  const Case written(text);
  auto s = written.scenario;
  s.run.samples = 400'000;
  const auto r = analysed(s);
  // y_2 = a + 2 b: its variance from the covariance of the fit.
  const auto& c = estimate.covariance;
  const double u = std::sqrt(c[0] + 4 * c[1] + 4 * c[3]), end = u * t_quantile(4);
  const auto& summary = r.summaries[0];
  INFO(text);
  CHECK(r.budgets[0].combined_standard_uncertainty == Approx(u).epsilon(1e-6));
  CHECK(r.budgets[0].expanded_uncertainty == Approx(end).epsilon(1e-6));
  CHECK(std::fabs(summary.symmetric.high - r.budgets[0].estimate - end) < 4 * summary.symmetric.high_se);
  CHECK(std::fabs(summary.symmetric.low - r.budgets[0].estimate + end) < 4 * summary.symmetric.low_se);
  CHECK(summary.symmetric.high_se < 0.05 * (t_quantile(4) - 1.96) * u);
}
