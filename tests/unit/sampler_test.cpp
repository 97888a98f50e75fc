#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "quantities/quantile_kernels.h"
#include "unit/sampling.h"

using namespace gumshoe;
using namespace gumshoe::fixture;

namespace {

std::vector<InputQuantity> every_family() {
  Distribution discrete = make(Family::discrete, {});
  discrete.values = std::make_shared<const std::vector<double>>(std::vector<double>{-1, 0, 2});
  discrete.probabilities = std::make_shared<const std::vector<double>>(std::vector<double>{0.25, 0.25, 0.5});
  Distribution empirical = make(Family::empirical, {});
  empirical.values = std::make_shared<const std::vector<double>>(std::vector<double>{1, 2, 4, 8, 16});
  return {simple("rectangular", make(Family::rectangular, {-1, 2})),
          simple("curvilinear", make(Family::curvilinear_trapezoid, {-1, 1, 0.5})),
          simple("trapezoid", make(Family::trapezoid, {0, 1, 0.4})),
          simple("triangular", make(Family::triangular, {3, 5})),
          simple("arcsine", make(Family::arcsine, {-1, 1})),
          simple("normal", make(Family::normal, {5, 0.2})),
          simple("t", make(Family::t, {1, 0.5, 9})),
          simple("exponential", make(Family::exponential, {2})),
          simple("gamma", make(Family::gamma, {6, 1})),
          simple("lognormal", make(Family::lognormal, {0, 0.3})),
          simple("truncated", make(Family::truncated_normal, {0, 1, -0.5, 3})),
          simple("discrete", discrete),
          simple("empirical", empirical)};
}

} // namespace

TEST_CASE("a million draws have the moments of JCGM 101 Table 1", "[sampler]") {
  const auto quantities = every_family();
  const SamplePlan plan = make_plan(quantities, {}, one_reading, 7);
  constexpr std::size_t n = 1'000'000;
  const auto rows = draw(plan, n);
  REQUIRE(rows.size() == quantities.size());
  for (std::size_t v = 0; v < rows.size(); ++v) {
    INFO(plan.variates[v].name);
    const Distribution& d = plan.variates[v].distribution;
    double mean = 0, variance = 0;
    for (const double x : rows[v]) mean += x / n;
    for (const double x : rows[v]) variance += (x - mean) * (x - mean) / n;
    // standard errors: sd / sqrt(n) and variance sqrt((kurtosis - 1) / n)
    CHECK(std::abs(mean - d.mean()) < 4 * std::sqrt(d.variance() / n));
    CHECK(std::abs(variance - d.variance()) < 4 * d.variance() * std::sqrt((d.kurtosis() - 1) / n));
    double third = 0, sixth = 0; // the third one's standard error is at most the root of the sixth over n
    for (const double x : rows[v]) third += std::pow(x - mean, 3) / n, sixth += std::pow(x - mean, 6) / n;
    CHECK(std::abs(third - d.skewness() * std::pow(d.variance(), 1.5)) < 5 * std::sqrt(sixth / n));
  }
}

TEST_CASE("sample i is the same for every block, instruction set, and run length", "[sampler]") {
  auto quantities = every_family();
  Correlation correlation{
      Correlation::Kind::copula, {"normal", "t", "rectangular"}, {1, .5, .2, .5, 1, -.3, .2, -.3, 1}};
  const SamplePlan plan = make_plan(quantities, {&correlation, 1}, one_reading, 7);
  constexpr std::size_t n = 8192;
  for (const PointSet design : {PointSet::monte_carlo, PointSet::latin_hypercube, PointSet::sobol}) {
    const auto whole = draw(plan, n, design);
    for (const std::size_t block : {64, 512, 4096}) CHECK(draw(plan, n, design, block) == whole);
    for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!available(set)) continue;
      INFO(name(set));
      select_kernels(set);
      const auto other = draw(plan, n, design);
      select_kernels(best_instruction_set());
      CHECK(other == whole);
    }
    if (design == PointSet::latin_hypercube) continue;
    auto shorter = draw(plan, 2048, design);
    for (std::size_t v = 0; v < shorter.size(); ++v)
      CHECK(std::equal(shorter[v].begin(), shorter[v].end(), whole[v].begin()));
  }
  // a block that starts anywhere on a multiple of 64, with a length that is no multiple of 64
  const Sampler sampler(plan, PointSet::monte_carlo, n);
  const auto whole = draw(plan, n);
  std::vector<double> part(plan.variates.size() * 1000);
  sampler.draw(64 * 17, 1000, Purpose::sampling, part.data(), 1000);
  for (std::size_t v = 0; v < whole.size(); ++v)
    CHECK(std::equal(part.begin() + 1000 * v, part.begin() + 1000 * (v + 1), whole[v].begin() + 64 * 17));
}

TEST_CASE("adding a quantity never changes the draws of another", "[sampler]") {
  std::vector<InputQuantity> few = {simple("b", standard), simple("c", rectangular)};
  std::vector<InputQuantity> many = {simple("a", standard), few[0], simple("bb", standard), few[1],
                                     simple("d", standard)};
  const SamplePlan small = make_plan(few, {}, one_reading, 3), large = make_plan(many, {}, one_reading, 3);
  for (const PointSet design : {PointSet::monte_carlo, PointSet::latin_hypercube, PointSet::sobol}) {
    const auto before = draw(small, 1024, design), after = draw(large, 1024, design);
    CHECK(before[0] == after[1]);
    CHECK(before[1] == after[3]);
    CHECK(after[0] != after[1]);
  }
  const auto other_seed = draw(make_plan(few, {}, one_reading, 4), 1024);
  CHECK(other_seed[0] != draw(small, 1024)[0]);
}

TEST_CASE("purposes and Sobol' dimensions are independent of each other", "[sampler]") {
  std::vector<InputQuantity> quantities;
  for (int i = 0; i < 12; ++i) quantities.push_back(simple("q" + std::to_string(i), rectangular));
  const SamplePlan plan = make_plan(quantities, {}, one_reading, 5);
  constexpr std::size_t n = 1 << 14;
  for (const PointSet design : {PointSet::monte_carlo, PointSet::latin_hypercube, PointSet::sobol}) {
    auto rows = draw(plan, n, design);
    for (auto& row : draw(plan, n, design, 4096, Purpose::pick_freeze)) rows.push_back(std::move(row));
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) REQUIRE(std::abs(pearson(rows[i], rows[j])) < 5 / std::sqrt(double(n)));
  }
}

TEST_CASE("Latin hypercube and Sobol' points fill every variate evenly", "[sampler]") {
  const std::vector<InputQuantity> quantities = {simple("a", rectangular), simple("b", rectangular)};
  const SamplePlan plan = make_plan(quantities, {}, one_reading, 5);
  constexpr std::size_t n = 4096;
  for (const PointSet design : {PointSet::latin_hypercube, PointSet::sobol})
    for (const auto& row : draw(plan, n, design)) {
      std::set<int> strata;
      for (const double x : row) strata.insert(static_cast<int>(x * n));
      CHECK(strata.size() == n);
    }
}
