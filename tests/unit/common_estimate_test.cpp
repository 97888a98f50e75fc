/// Draws whose standard uncertainties are multiples of one estimate: jointly t, and one term of Welch-Satterthwaite.
#include <catch2/catch.hpp>

#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "analysis/combine.h"
#include "quantities/sample_plan.h"

using namespace gumshoe;
using namespace gumshoe::quantities;

namespace {

constexpr std::size_t readings = 8, samples = 1 << 17;
constexpr double nu = 3, u = 2;

InputQuantity noise(bool common) {
  InputQuantity q{"d", "m", "m", {}};
  for (std::size_t r = 0; r < readings; ++r) {
    Component c;
    c.name = "repeatability";
    c.distribution = {Family::t, {0, u / std::sqrt(1.0 + static_cast<double>(r % 2)), nu}, nullptr, nullptr};
    c.degrees_of_freedom = nu;
    c.common = common;
    q.entries.push_back({{{"place", std::to_string(r)}}, 0, {c}, {}});
  }
  return q;
}

SamplePlan plan_of(const InputQuantity& q) {
  std::vector<Reading> all;
  for (std::size_t r = 0; r < readings; ++r) all.push_back({{{"place", std::to_string(r)}}, {}, {}});
  return make_plan(std::vector{q}, {}, all, 7);
}

std::vector<double> draw(const SamplePlan& plan, PointSet design = PointSet::monte_carlo) {
  std::vector<double> out(readings * samples);
  Sampler(plan, design, samples).draw(0, samples, Purpose::sampling, out.data(), samples);
  return out;
}

/// Share of samples in which the sum of all draws, over its u, is beyond what a t of so many degrees of freedom exceeds
/// in one case of a hundred.
double beyond(const std::vector<double>& x, double degrees) {
  const double limit = quantile(boost::math::students_t(degrees), 0.995), of_sum = u * std::sqrt(readings * 0.75);
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    double sum = 0;
    for (std::size_t r = 0; r < readings; ++r) sum += x[r * samples + i];
    count += std::fabs(sum) > limit * of_sum;
  }
  return static_cast<double>(count) / samples;
}

const double se = std::sqrt(0.01 * 0.99 / samples);

} // namespace

TEST_CASE("draws that share an estimated standard deviation are jointly t", "[sampler]") {
  const SamplePlan plan = plan_of(noise(true));
  REQUIRE(plan.estimates.size() == 1);
  CHECK(plan.estimates[0].variates.size() == readings);
  for (const PointSet design : {PointSet::monte_carlo, PointSet::latin_hypercube}) {
    const auto x = draw(plan, design);
    CHECK(beyond(x, nu) == Approx(0.01).margin(5 * se)); // any sum is a t with nu degrees of freedom
    // Each by itself is one, too.
    const double limit = quantile(boost::math::students_t(nu), 0.995) * u;
    double count = 0;
    for (std::size_t i = 0; i < samples; ++i) count += std::fabs(x[i]) > limit;
    CHECK(count / samples == Approx(0.01).margin(5 * se));
    // Uncorrelated, although all are wide together: signs agree in half of the samples, but sizes go together.
    double agree = 0, both = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      agree += x[i] * x[2 * samples + i] > 0;
      both += std::fabs(x[i]) > limit && std::fabs(x[2 * samples + i]) > limit;
    }
    CHECK(agree / samples == Approx(0.5).margin(5 * 0.5 / std::sqrt(samples)));
    CHECK(both / samples > 10 * 0.01 * 0.01);
  }
}

TEST_CASE("estimates of their own are independent", "[sampler]") {
  const SamplePlan plan = plan_of(noise(false));
  CHECK(plan.estimates.empty());
  CHECK(beyond(draw(plan), nu) < 0.01 - 10 * se); // a sum of eight independent t has lighter tails
}

TEST_CASE("the same first samples, whatever the block and the number of readings", "[sampler]") {
  const SamplePlan plan = plan_of(noise(true));
  const auto x = draw(plan);
  std::vector<double> part(readings * 64);
  Sampler(plan, PointSet::monte_carlo, samples).draw(640, 64, Purpose::sampling, part.data(), 64);
  for (std::size_t r = 0; r < readings; ++r)
    for (std::size_t i = 0; i < 64; ++i) CHECK(part[r * 64 + i] == x[r * samples + 640 + i]);
  InputQuantity fewer = noise(true);
  const SamplePlan small = make_plan(std::vector{fewer}, {},
                                     std::vector<Reading>{{{{"place", "0"}}, {}, {}}, {{{"place", "1"}}, {}, {}}}, 7);
  std::vector<double> of_two(2 * samples);
  Sampler(small, PointSet::monte_carlo, samples).draw(0, samples, Purpose::sampling, of_two.data(), samples);
  CHECK(std::equal(of_two.begin(), of_two.end(), x.begin()));
}

TEST_CASE("inputs whose u come from one estimate are one term of the Welch-Satterthwaite formula", "[gum]") {
  for (const bool common : {true, false}) {
    const SamplePlan plan = plan_of(noise(common));
    Correlations correlations(plan);
    std::vector<analysis::Term> terms;
    for (std::size_t v = 0; v < readings; ++v) terms.push_back({v, 1.5, nu});
    CHECK(analysis::combine(terms, correlations).effective_degrees_of_freedom ==
          Approx(common ? nu : nu * readings)); // of n equal independent terms n nu
  }
}

TEST_CASE("one statement with a scope has one u for all its draws; observations of one reading have their own",
          "[sampler]") {
  InputQuantity q{"x", "m", "m", {}};
  Component c;
  c.name = "c1";
  c.distribution = {Family::t, {0, 1, 5}, nullptr, nullptr};
  c.degrees_of_freedom = 5;
  c.per = {"place"};
  q.entries.push_back({{}, 0, {c}, {}});
  CHECK(plan_of(q).estimates.size() == 1);
  q.entries[0].components[0].per = {};
  CHECK(plan_of(q).estimates.empty()); // one draw
  q.entries[0].components[0].per = {"place"};
  q.entries[0].components[0].distribution = {Family::rectangular, {-1, 1}, nullptr, nullptr};
  REQUIRE(plan_of(q).estimates.size() == 1);
  CHECK_FALSE(plan_of(q).estimates[0].jointly_t); // keeps its shape; its degrees of freedom are those of one estimate
}
