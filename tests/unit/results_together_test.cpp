/// Results of several files taken together, against closed forms: the weighted mean and the difference of two.
#include <catch2/catch.hpp>

#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "analysis/agreement.h"
#include "analysis/weighted_mean.h"
#include "base/special_values.h"
#include "tracing/noise/whitened.h"

using namespace gumshoe;
using namespace gumshoe::analysis;

namespace {

/// A component, with its contribution c u.
Contribution component(const std::string& name, double contribution, double degrees_of_freedom = infinity) {
  Contribution c;
  c.name = c.quantity = name;
  c.estimate = 1;
  c.standard_uncertainty = std::fabs(contribution);
  c.distribution = "normal";
  c.degrees_of_freedom = degrees_of_freedom;
  c.sensitivity = contribution < 0 ? -1 : 1;
  c.contribution = std::fabs(contribution);
  return c;
}

/// A result of y whose u is that of its components, in samples and budget; k is that of its degrees of freedom.
Results result(double y, const std::vector<Contribution>& components, double degrees_of_freedom = infinity) {
  Results out;
  Summary s;
  s.output = {.name = "y", .measurand = "y", .unit = "mm", .si_unit = "m"};
  s.estimate = y;
  double square = 0;
  for (const Contribution& c : components) square += c.contribution * c.contribution;
  s.standard_uncertainty = std::sqrt(square);
  s.degrees_of_freedom = degrees_of_freedom;
  s.coverage_factor = std::isfinite(degrees_of_freedom) ? quantile(boost::math::students_t(degrees_of_freedom), 0.975)
                                                        : 1.959963984540054;
  s.expanded_uncertainty = s.coverage_factor * s.standard_uncertainty;
  out.summaries.push_back(s);
  Budget budget;
  budget.output = s.output;
  budget.contributions = components;
  for (Contribution& c : budget.contributions) c.share = c.contribution * c.contribution / square;
  budget.combined_standard_uncertainty = s.standard_uncertainty;
  budget.effective_degrees_of_freedom = degrees_of_freedom;
  out.budgets.push_back(budget);
  return out;
}

std::vector<NamedResult> named(const std::vector<Results>& results) {
  std::vector<NamedResult> out;
  for (const Results& r : results) out.push_back({"result " + std::to_string(out.size() + 1), r});
  return out;
}

WeightedMean mean_of(const std::vector<Results>& results, const std::vector<std::string>& same = {}) {
  const WeightedMeans means = weighted_means(named(results), same, "");
  REQUIRE(means.rows.size() == 1);
  return means.rows[0];
}

} // namespace

TEST_CASE("independent results are weighted by their variances", "[combine]") {
  const WeightedMean m = mean_of({result(0, {component("a", 1, 4)}, 4), result(3, {component("b", 2, 9)}, 9),
                                  result(0, {component("c", -2, 16)}, 16)});
  const double square = 1 / (1 + 0.25 + 0.25);
  CHECK(m.mean.estimate == Approx(0.5));
  // Weights 2/3, 1/6, 1/6 from u with 4, 9 and 16 degrees of freedom; Meier 1953, with two fewer.
  const double weighing = 4 * (2.0 / 9 / 2 + 5.0 / 36 / 7 + 5.0 / 36 / 14) * square;
  CHECK(m.weighing == Approx(std::sqrt(weighing)));
  CHECK(m.mean.standard_uncertainty == Approx(std::sqrt(square + weighing)));
  for (const auto& [part, weight, difference] :
       {std::tuple{0, 2.0 / 3, -0.5}, std::tuple{1, 1.0 / 6, 2.5}, std::tuple{2, 1.0 / 6, -0.5}}) {
    const WeightedPart& p = m.parts[static_cast<std::size_t>(part)];
    CHECK(p.weight == Approx(weight));
    CHECK(p.difference == Approx(difference));
    const double u = p.summary.standard_uncertainty;
    CHECK(p.own == Approx(u));
    CHECK(p.normalised_error == Approx(difference / (m.mean.coverage_factor * std::sqrt(u * u - square))));
  }
  CHECK(m.chi_squared == Approx(0.25 + 2.5 * 2.5 / 4 + 0.25 / 4));
  // Welch 1951, by hand for three results: sum (1 - w)^2 / nu, and 2 (3 - 2) / (3^2 - 1) of it.
  const double estimated = 1.0 / 9 / 4 + 25.0 / 36 / 9 + 25.0 / 36 / 16;
  CHECK(m.ratio == Approx(m.chi_squared / 2 / (1 + estimated / 4)));
  CHECK(m.ratio_degrees_of_freedom == Approx(8 / (3 * estimated)));
  CHECK(m.probability ==
        Approx(std::pow(1 + 2 * m.ratio / m.ratio_degrees_of_freedom, -m.ratio_degrees_of_freedom / 2)));
  CHECK(m.consistent());
  // Welch and Satterthwaite, JCGM 100 G.4.1: (w u)^2 of the parts are 4/9, 1/9 and 1/9.
  const double freedom = square * square / (16.0 / 81 / 4 + 1.0 / 81 / 9 + 1.0 / 81 / 16);
  CHECK(m.mean.degrees_of_freedom == std::floor(freedom));
  const double k = quantile(boost::math::students_t(std::floor(freedom)), 0.975);
  CHECK(m.mean.coverage_factor == Approx(k));
  CHECK(m.mean.expanded_uncertainty == Approx(k * std::sqrt(square + weighing)));
}

TEST_CASE("a mean of few readings covers, and agreeing results are seldom called inconsistent", "[combine]") {
  // Five laboratories of four readings each, as in 2,000 sets: 95 % is known to 0.5 %, and 5 % likewise. Weights taken
  // for known cover 78 % and reject 24 %.
  const tracing::Matrix z = tracing::normals(2000 * 5, 4, 3, 1);
  int covered = 0, rejected = 0;
  for (int set = 0; set < 2000; ++set) {
    std::vector<Results> labs;
    for (int lab = 0; lab < 5; ++lab) {
      const auto x = z.row(5 * set + lab).array();
      const double s = std::sqrt((x - x.mean()).square().sum() / 3);
      labs.push_back(result(x.mean(), {component("x" + std::to_string(lab), s / 2, 3)}, 3));
    }
    const WeightedMean m = mean_of(labs);
    covered += std::fabs(m.mean.estimate) <= m.mean.expanded_uncertainty;
    rejected += !m.consistent();
  }
  CHECK(covered >= 0.91 * 2000);
  CHECK(covered <= 0.97 * 2000);
  CHECK(rejected <= 0.075 * 2000);
}

TEST_CASE("results that contradict each other are inconsistent", "[combine]") {
  const auto apart = [](double d) { return mean_of({result(0, {component("a", 1)}), result(d, {component("b", 1)})}); };
  const double limit = std::sqrt(2 * quantile(boost::math::chi_squared(1), 0.95));
  CHECK(apart(0.999 * limit).consistent());
  CHECK_FALSE(apart(1.001 * limit).consistent());
  CHECK(apart(limit).probability == Approx(0.05));
}

TEST_CASE("what results share stays in their mean, and cancels in their difference", "[combine]") {
  // V = diag(9, 1) + 16.
  const WeightedMean m = mean_of({result(0, {component("own", 3), component("reference", -4, 8)}, 20),
                                  result(6, {component("own", 1, 5), component("reference", -4, 12)}, 30)},
                                 {"reference"});
  const double square = 16 + 1 / (1.0 / 9 + 1), weighing = 0.9 * 4 * 0.09 / 3; // of five degrees of freedom
  CHECK(m.mean.standard_uncertainty == Approx(std::sqrt(square + weighing)));
  CHECK(m.parts[0].weight == Approx(0.1));
  CHECK(m.parts[1].weight == Approx(0.9));
  CHECK(m.mean.estimate == Approx(5.4));
  CHECK(m.chi_squared == Approx(36.0 / 10));
  REQUIRE(m.shared.size() == 1);
  CHECK(m.shared[0].contributions == std::vector<double>{-4, -4});
  CHECK(m.shared[0].degrees_of_freedom == 8); // the fewer
  CHECK(m.parts[1].own == Approx(1));
  CHECK(m.parts[1].own_degrees_of_freedom == Approx(5));
  CHECK(std::isinf(m.parts[0].own_degrees_of_freedom));
  const double freedom = square * square / (256.0 / 8 + std::pow(0.9, 4) / 5);
  CHECK(m.mean.degrees_of_freedom == std::floor(freedom));
  CHECK(m.alike.empty());
}

TEST_CASE("a strong correlation makes a weight negative", "[combine]") {
  // V = ((1.25, 3), (3, 9.25))
  const WeightedMean m = mean_of({result(10, {component("own", 0.5), component("gauge", 1)}),
                                  result(11, {component("own", 0.5), component("gauge", 3)})},
                                 {"gauge"});
  CHECK(m.parts[0].weight == Approx(6.25 / 4.5));
  CHECK(m.parts[1].weight == Approx(-1.75 / 4.5));
  CHECK(m.mean.estimate == Approx(10 - 1.75 / 4.5)); // outside both
  CHECK(m.mean.standard_uncertainty == Approx(std::sqrt((1.25 * 9.25 - 9) / 4.5)));
}

TEST_CASE("a component whose u is a t's counts in samples by its standard deviation", "[combine]") {
  // Four degrees of freedom: variance 4 / (4 - 2) u^2 in the samples' u of 3.
  auto t = component("reference", 2, 4);
  t.distribution = "t";
  Results a = result(0, {component("own", 1), t}), b = result(1, {component("own", 1), t});
  for (Results* r : {&a, &b}) {
    Summary& s = r->summaries[0];
    s.standard_uncertainty = 3; // own 1, reference 2 sqrt(2)
    s.expanded_uncertainty = 3 * s.coverage_factor;
  }
  // Where the budgets account for that, u is theirs: 1 + 4.
  const WeightedMean law = mean_of({a, b}, {"reference"});
  CHECK(law.shared[0].contributions[0] == Approx(2));
  CHECK(law.mean.standard_uncertainty == Approx(std::sqrt(4 + 0.5)));
  // One that is not linear, and all are those of the samples.
  b.budgets[0].applicable = false;
  const WeightedMean m = mean_of({a, b}, {"reference"});
  CHECK(m.shared[0].contributions[0] == Approx(2 * std::sqrt(2.0)));
  CHECK(m.parts[0].own == Approx(1));
  CHECK(m.mean.standard_uncertainty == Approx(std::sqrt(8 + 0.5)));
}

TEST_CASE("what is no result of the same measurand, or has no weight, is not combined", "[combine]") {
  const Results good = result(1, {component("a", 1)});
  const auto refused = [&](const std::vector<Results>& results, const std::string& why,
                           const std::vector<std::string>& same = {}) {
    CHECK_THROWS_WITH(weighted_means(named(results), same, ""), Catch::Contains(why));
  };
  refused({good}, "a single result");
  Results other = good;
  other.summaries[0].output.name = "z";
  refused({good, other}, "no measurand in common");
  Results angle = good;
  angle.summaries[0].output.si_unit = "rad";
  refused({good, angle}, "different dimensions");
  Results exact = good;
  exact.summaries[0].standard_uncertainty = 0;
  refused({good, exact}, "no standard uncertainty");
  Results wide = good;
  wide.coverage_probability = 0.99;
  refused({good, wide}, "coverage probabilit");
  refused({good, good}, "differ by nothing but what they share", {"a"});
  refused({good, good}, "not a quantity in the budgets", {"b"});
  auto kink = component("a", 1);
  kink.sensitivity = kink.contribution = gumshoe::nan;
  Results unknown = good;
  unknown.budgets[0].contributions = {kink};
  refused({good, unknown}, "what it shares is not known", {"a"});
  CHECK_THROWS_WITH(weighted_means(named({good, good}), {}, "yy"), Catch::Contains("--measurand yy: no two results have it"));
}

TEST_CASE("the difference of two results has the uncertainty of what they do not share", "[compare]") {
  const Results before = result(0, {component("own", 3), component("reference", 4)});
  const Results after = result(12, {component("own", 1), component("reference", 4), component("new", 0.5)});
  const double k = before.summaries[0].coverage_factor;
  const Agreements free = agreements(before, after, {}), tied = agreements(before, after, {"reference"});
  REQUIRE(free.rows.size() == 1);
  CHECK(free.rows[0].difference.difference == 12);
  CHECK(free.rows[0].difference.standard_uncertainty == Approx(std::sqrt(9 + 16 + 1 + 16 + 0.25)));
  CHECK(free.rows[0].difference.expanded_uncertainty == Approx(k * std::sqrt(42.25)));
  CHECK(free.rows[0].difference.normalised_error == Approx(12 / (k * std::sqrt(42.25))));
  CHECK(free.rows[0].alike == std::vector<std::string>{"reference"});
  CHECK(free.rows[0].counted.empty());
  CHECK(tied.rows[0].difference.root_sum_square == Approx(std::sqrt(42.25)));
  CHECK(tied.rows[0].difference.standard_uncertainty == Approx(std::sqrt(10.25)));
  CHECK(tied.rows[0].difference.expanded_uncertainty == Approx(k * std::sqrt(10.25)));
  CHECK(tied.rows[0].counted == std::vector<std::string>{"reference"});
  CHECK(tied.rows[0].alike.empty());
  // By the change of the contribution squared: -8 of own, 0.25 of what is new; the reference did not change.
  REQUIRE(tied.rows[0].changes.size() == 2);
  CHECK(tied.rows[0].changes[0].quantity == "own");
  CHECK(tied.rows[0].changes[0].before == Approx(3));
  CHECK(tied.rows[0].changes[0].after == Approx(1));
  CHECK(tied.rows[0].changes[1].quantity == "new");
  CHECK(tied.rows[0].changes[1].after == Approx(0.5));
  // The opposite sign adds up.
  const Results opposite = result(12, {component("own", 1), component("reference", -4)});
  CHECK(agreements(before, opposite, {"reference"}).rows[0].difference.standard_uncertainty == Approx(std::sqrt(74.0)));
}

TEST_CASE("quantities that two budgets list alike are told where they would change u by more than 1 %", "[compare]") {
  // u(d)^2 = 2 (100 + a^2); counting them would change u by a^2 / u(d)^2.
  const auto told = [](double share) {
    const double a = std::sqrt(200 * share / (1 - 2 * share));
    const Results r = result(0, {component("own", 10), component("scale", a)});
    Results other = r;
    other.budgets[0].contributions[0].standard_uncertainty = 9; // own is another quantity there
    return !agreements(r, other, {}).rows[0].alike.empty();
  };
  CHECK_FALSE(told(0.0099));
  CHECK(told(0.0101));
}

TEST_CASE("measurands of one result alone are listed, and a difference without uncertainty has no E_n", "[compare]") {
  Results before = result(1, {component("a", 0)}), after = result(3, {component("a", 0)});
  before.summaries.push_back(before.summaries[0]);
  before.summaries[1].output.name = "only here";
  after.summaries.push_back(after.summaries[0]);
  after.summaries[1].output.name = "only there";
  after.summaries.push_back(after.summaries[0]);
  after.summaries[2].output.name = "chi-squared";
  after.summaries[2].output.diagnostic = true;
  const Agreements out = agreements(before, after, {});
  CHECK(out.only_before == std::vector<std::string>{"only here"});
  CHECK(out.only_after == std::vector<std::string>{"only there"});
  CHECK(out.rows[0].difference.difference == 2);
  CHECK(out.rows[0].difference.standard_uncertainty == 0);
  CHECK(std::isnan(out.rows[0].difference.normalised_error));
  after.summaries[0].output.si_unit = "rad";
  CHECK_THROWS_WITH(agreements(before, after, {}), Catch::Contains("different dimensions"));
}
