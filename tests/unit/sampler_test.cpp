#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "base/error.h"
#include "quantities/copula.h"
#include "quantities/quantile_kernels.h"
#include "quantities/sample_plan.h"

using namespace gumshoe;
using namespace gumshoe::quantities;

namespace {

Distribution make(Family family, std::array<double, 4> parameters) { return {family, parameters, {}, {}}; }

Component component(std::string name, Distribution d, std::vector<std::string> per = {}) {
  return {std::move(name), d, 'B', HUGE_VAL, std::move(per), ""};
}

InputQuantity quantity(std::string name, std::vector<Component> components, double value = 0) {
  return {std::move(name), "mm", "m", {{{}, value, std::move(components), ""}}};
}

InputQuantity simple(std::string name, Distribution d) { return quantity(std::move(name), {component("a", d)}); }

Reading reading(Labels labels) { return {std::move(labels), {}, {}, 1}; }

const std::vector<Reading> one_reading = {reading({})};
const Distribution standard = make(Family::normal, {0, 1});
const Distribution rectangular = make(Family::rectangular, {0, 1});

/// All variates of samples [0, n), drawn in blocks.
std::vector<std::vector<double>> draw(const SamplePlan& plan, std::size_t n, PointSet design = PointSet::monte_carlo,
                                      std::size_t block = 4096, Purpose purpose = Purpose::sampling) {
  const Sampler sampler(plan, design, n);
  std::vector<std::vector<double>> rows(plan.variates.size(), std::vector<double>(n));
  std::vector<double> buffer(plan.variates.size() * block);
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = std::min(block, n - first);
    sampler.draw(first, count, purpose, buffer.data(), block);
    for (std::size_t v = 0; v < rows.size(); ++v)
      std::copy_n(buffer.data() + v * block, count, rows[v].begin() + static_cast<std::ptrdiff_t>(first));
  }
  return rows;
}

double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return xy / std::sqrt(xx * yy);
}

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

std::string message(auto&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
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

TEST_CASE("a Gaussian copula keeps margins and gives Pearson's coefficient (6/pi) asin(rho/2)", "[sampler][copula]") {
  constexpr std::size_t n = 1'000'000;
  const std::vector<InputQuantity> quantities = {simple("a", rectangular), simple("b", rectangular)};
  for (const auto& [rho, expected] : {std::pair{0.3, 0.287564}, {0.6, 0.581920}, {0.9, 0.891456}, {-0.6, -0.581920}}) {
    const Correlation correlation{Correlation::Kind::copula, {"a", "b"}, {1, rho, rho, 1}};
    const auto rows = draw(make_plan(quantities, {&correlation, 1}, one_reading, 11), n);
    // The standard error of r is at most (1 - r^2) / sqrt(n) times about 1.2 for these margins.
    const double tolerance = 5 * (1 - expected * expected) / std::sqrt(double(n));
    CHECK(std::abs(expected - rho) > 1.5 * tolerance); // tells the copula's from Pearson's coefficient
    CHECK(std::abs(pearson(rows[0], rows[1]) - expected) < tolerance);
    for (const auto& row : rows) {
      double mean = 0, square = 0;
      for (const double x : row) mean += x / n, square += x * x / n;
      CHECK(std::abs(mean - 0.5) < 4.5 / std::sqrt(12.0 * n));
      CHECK(std::abs(square - 1.0 / 3) < 4.5 * std::sqrt(4.0 / 45 / n));
    }
  }
}

TEST_CASE("a stated Pearson or Spearman coefficient is what the draws have", "[sampler][copula]") {
  constexpr std::size_t n = 1'000'000;
  Distribution steps = make(Family::discrete, {});
  steps.values = std::make_shared<const std::vector<double>>(std::vector<double>{-1, 0, 2});
  steps.probabilities = std::make_shared<const std::vector<double>>(std::vector<double>{0.25, 0.25, 0.5});
  const std::vector<InputQuantity> quantities = {
      simple("normal", standard), simple("lognormal", make(Family::lognormal, {0, 0.8})),
      simple("rectangular", rectangular), simple("exponential", make(Family::exponential, {1})),
      simple("steps", steps)};
  using Pair = std::pair<std::vector<std::string>, double>;
  for (const auto& [names, r] : {Pair{{"normal", "lognormal"}, 0.7}, Pair{{"rectangular", "exponential"}, -0.6},
                                 Pair{{"normal", "rectangular"}, 0.8}, Pair{{"rectangular", "steps"}, 0.5}}) {
    INFO(names[0] << " " << names[1]);
    const Correlation correlation{Correlation::Kind::pearson, names, {1, r, r, 1}};
    const SamplePlan plan = make_plan(quantities, {&correlation, 1}, one_reading, 2);
    const auto rows = draw(plan, n);
    const auto& group = plan.copulas.at(0).variates;
    CHECK(std::abs(pearson(rows[group[0]], rows[group[1]]) - r) < 6.0 / std::sqrt(double(n))); // lognormal: heavier
  }
  // normal with rectangular: r = rho sqrt(3/pi); normal with lognormal: r = rho s / sqrt(e^(s s) - 1)
  const auto coefficient = [&](const char* other, double r) {
    const Correlation c{Correlation::Kind::pearson, {"normal", other}, {1, r, r, 1}};
    return make_plan(quantities, {&c, 1}, one_reading, 2).copulas.at(0).matrix[1];
  };
  CHECK(coefficient("rectangular", 0.8) == Approx(0.8 / std::sqrt(3 / std::numbers::pi)).epsilon(1e-7));
  CHECK(coefficient("lognormal", 0.7) == Approx(0.7 * std::sqrt(std::expm1(0.64)) / 0.8).epsilon(1e-6));
  const Correlation spearman{Correlation::Kind::spearman, {"normal", "exponential"}, {1, 0.5, 0.5, 1}};
  CHECK(make_plan(quantities, {&spearman, 1}, one_reading, 2).copulas.at(0).matrix[1] ==
        Approx(2 * std::sin(std::numbers::pi / 12)));
}

TEST_CASE("labels: values by label, draws per label, shared columns", "[sampler][plan]") {
  std::vector<InputQuantity> quantities = {
      {"rod_length",
       "mm",
       "m",
       {{{{"rod", "rod 1"}}, 0.16, {component("cal", make(Family::normal, {0, 1e-6}))}, ""},
        {{{"rod", "rod 2"}}, 0.18, {component("cal", make(Family::normal, {0, 1e-6}))}, ""}}},
      quantity("beam_pitch", {component("set", make(Family::t, {0, 1, 9}), {"setup"}), component("level", rectangular)},
               5),
      quantity("spindle_z", {component("a", standard, {"reading"})}),
      quantity("offset", {component("fixed", make(Family::constant, {2}))}, 1)};
  std::vector<Reading> readings;
  for (const char* setup : {"1", "2"})
    for (const char* rod : {"rod 1", "rod 2"}) readings.push_back(reading({{"setup", setup}, {"rod", rod}}));
  const SamplePlan plan = make_plan(quantities, {}, readings, 1);

  std::vector<std::string> names;
  for (const Variate& v : plan.variates) names.push_back(v.name);
  const std::set<std::string> expected = {
      "rod_length[rod 1]",        "rod_length[rod 2]",    "beam_pitch[setup 1]: set",
      "beam_pitch[setup 2]: set", "beam_pitch: level",    "spindle_z[reading 1]",
      "spindle_z[reading 2]",     "spindle_z[reading 3]", "spindle_z[reading 4]"};
  CHECK(std::set<std::string>(names.begin(), names.end()) == expected);
  CHECK(names.size() == expected.size());

  const auto& g = plan.gather;
  CHECK(g[0][0] == g[2][0]); // rod 1 in both setups
  CHECK(g[0][0] != g[1][0]);
  CHECK(g[0][1] == g[1][1]); // both rods in setup 1
  CHECK(g[0][1] != g[2][1]);
  CHECK(std::set<std::size_t>{g[0][2], g[1][2], g[2][2], g[3][2]}.size() == 4);
  CHECK(g[0][3] == g[3][3]);
  CHECK(plan.estimate(g[1][0]) == 0.18);
  CHECK(plan.estimate(g[0][1]) == 5.5);
  CHECK(plan.estimate(g[0][3]) == 3);

  constexpr std::size_t n = 4096;
  const auto rows = draw(plan, n);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(std::abs(pearson(rows[i], rows[j])) < 5 / std::sqrt(double(n)));

  std::vector<const double*> pointers;
  for (const auto& row : rows) pointers.push_back(row.data());
  std::vector<double> columns(plan.columns.size() * n);
  plan.assemble(pointers, n, columns.data(), n);
  const Column& pitch = plan.columns[g[0][1]];
  REQUIRE(pitch.variates.size() == 2);
  for (std::size_t i = 0; i < n; i += 97)
    CHECK(columns[g[0][1] * n + i] == (5 + rows[pitch.variates[0]][i]) + rows[pitch.variates[1]][i]);
}

TEST_CASE("coefficients of +1 and -1 are drawn exactly, whatever the distributions", "[sampler][copula]") {
  Distribution wide = make(Family::t, {0, 3, 4}), steps = make(Family::discrete, {});
  steps.values = std::make_shared<const std::vector<double>>(std::vector<double>{-1, 0, 1});
  steps.probabilities = std::make_shared<const std::vector<double>>(std::vector<double>{0.3, 0.4, 0.3});
  const std::vector<InputQuantity> quantities = {
      simple("n1", standard),       simple("n2", make(Family::normal, {2, 3})), simple("t1", make(Family::t, {0, 1, 4})),
      simple("t2", wide),           simple("r1", rectangular),                  simple("r2", make(Family::rectangular, {-4, 0})),
      simple("tri1", make(Family::triangular, {0, 1})), simple("tri2", make(Family::triangular, {0, 2})),
      simple("e1", make(Family::exponential, {1})),     simple("e2", make(Family::exponential, {5})),
      simple("s1", steps),          simple("s2", steps)};
  using enum Correlation::Kind;
  for (std::size_t i = 0; i < quantities.size(); i += 2)
    for (const double r : {1.0, -1.0})
      for (const auto kind : {copula, pearson, spearman}) {
        const bool stepped = i == 10, mirrored = i != 8 || r > 0; // no linear relation of opposite exponentials
        if ((kind == spearman && stepped) || (kind == pearson && !mirrored)) continue;
        const std::vector<InputQuantity> two(quantities.begin() + std::ptrdiff_t(i), quantities.begin() + std::ptrdiff_t(i) + 2);
        INFO(two[0].name << " " << r << " " << int(kind));
        const Correlation c{kind, {two[0].name, two[1].name}, {1, r, r, 1}};
        const SamplePlan plan = make_plan(two, {&c, 1}, one_reading, 3);
        const auto rows = draw(plan, 4096);
        const auto& a = plan.variates[0].distribution;
        const auto& b = plan.variates[1].distribution;
        for (std::size_t k = 0; k < 4096; k += 41) {
          if (mirrored) { // a straight line through the means, to the rounding of the quantile functions
            const double line = b.mean() + r * std::sqrt(b.variance() / a.variance()) * (rows[0][k] - a.mean());
            REQUIRE(std::abs(rows[1][k] - line) < 1e-9 * std::sqrt(b.variance()));
          } else {
            REQUIRE(std::abs(a.probability(rows[0][k]) + b.probability(rows[1][k]) - 1) < 1e-9);
          }
        }
        // and the framework's coefficient is the same
        if (mirrored) CHECK(pearson_coefficient(plan.copulas[0].matrix[1], a, b) == r);
      }
}

TEST_CASE("a singular matrix is drawn exactly: quantities that determine another", "[sampler][copula]") {
  // c = 0.6 a + 0.8 b; the same with c named first, and with a fourth that is opposite to a.
  const std::vector<InputQuantity> quantities = {simple("a", standard), simple("b", standard), simple("c", standard),
                                                 simple("d", standard)};
  for (const auto& [names, matrix] :
       {std::pair<std::vector<std::string>, std::vector<double>>{
            {"a", "b", "c", "d"}, {1, 0, .6, -1, 0, 1, .8, 0, .6, .8, 1, -.6, -1, 0, -.6, 1}},
        {{"d", "a", "c", "b"}, {1, -1, -.6, 0, -1, 1, .6, 0, -.6, .6, 1, .8, 0, 0, .8, 1}}}) {
    const Correlation c{Correlation::Kind::pearson, names, matrix};
    const SamplePlan plan = make_plan(quantities, {&c, 1}, one_reading, 3);
    CHECK(plan.copulas.at(0).singular());
    const auto rows = draw(plan, 1 << 16);
    double variance = 0;
    for (std::size_t k = 0; k < rows[0].size(); ++k) {
      REQUIRE(std::abs(0.6 * rows[0][k] + 0.8 * rows[1][k] - rows[2][k]) < 1e-12);
      REQUIRE(rows[3][k] == -rows[0][k]);
      variance += rows[2][k] * rows[2][k] / double(rows[0].size());
    }
    CHECK(std::abs(variance - 1) < 5 * std::sqrt(2.0 / double(rows[0].size())));
  }
}

TEST_CASE("correlated quantities are tied cell by cell", "[sampler][plan]") {
  const std::vector<InputQuantity> quantities = {
      quantity("x", {component("a", standard, {"setup"})}),
      quantity("y.z", {component("a", standard, {"setup"}), component("b", standard)})};
  const std::vector<Reading> readings = {reading({{"setup", "1"}}), reading({{"setup", "2"}})};
  const Correlation correlation{Correlation::Kind::pearson, {"x", "y.z.a"}, {1, 0.8, 0.8, 1}};
  const SamplePlan plan = make_plan(quantities, {&correlation, 1}, readings, 1);
  REQUIRE(plan.copulas.size() == 2);
  constexpr std::size_t n = 1 << 16;
  const auto rows = draw(plan, n);
  for (const CopulaGroup& group : plan.copulas) {
    CHECK(plan.variates[group.variates[0]].cell == plan.variates[group.variates[1]].cell);
    CHECK(std::abs(pearson(rows[group.variates[0]], rows[group.variates[1]]) - 0.8) < 5 * 0.36 / std::sqrt(double(n)));
  }
  CHECK(std::abs(pearson(rows[plan.copulas[0].variates[0]], rows[plan.copulas[1].variates[1]])) <
        5 / std::sqrt(double(n)));
}

TEST_CASE("plans refuse what cannot be meant, and say why", "[sampler][plan]") {
  using Catch::Contains;
  const auto refuse = [](std::vector<InputQuantity> q, std::vector<Correlation> c, std::vector<Reading> r) {
    return message([&] { make_plan(q, c, r, 1); });
  };
  const std::vector<InputQuantity> abc = {simple("a", standard), simple("b", standard), simple("c", standard),
                                          simple("e", make(Family::exponential, {1})),
                                          simple("cauchy", make(Family::t, {0, 1, 2}))};
  const auto tie = [&](Correlation::Kind kind, std::vector<std::string> names, std::vector<double> matrix) {
    return refuse(abc, {{kind, std::move(names), std::move(matrix)}}, one_reading);
  };
  // 1, 0.9, 0.9 against -0.9: eigenvalues 1.9, 1.9, -0.8
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "b", "c"}, {1, .9, .9, .9, 1, -.9, .9, -.9, 1}),
             Contains("the matrix is not positive semidefinite") && Contains("its smallest eigenvalue is -0.8") &&
                 Contains("multiply those off the diagonal by 0.555555")); // 1 / (1 + 0.8)
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "b"}, {1, 1, 1, 1}), Contains("no error"));
  // Three rectangulars whose sum is constant: no Gaussian copula has their matrix, although it is one.
  CHECK_THAT(refuse({simple("a", rectangular), simple("b", rectangular), simple("c", rectangular)},
                    {{Correlation::Kind::pearson, {"a", "b", "c"}, {1, -.5, -.5, -.5, 1, -.5, -.5, -.5, 1}}}, one_reading),
             Contains("no Gaussian copula of these distributions has this matrix"));
  CHECK_THAT(tie(Correlation::Kind::pearson, {"e", "a"}, {1, 1, 1, 1}),
             Contains("+1 and -1 need distributions of one shape") && Contains("kind = \"spearman\""));
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "b"}, {1, .5, .4, 1}), Contains("not symmetric"));
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "b"}, {1, 2, 2, 1}), Contains("between -1 and 1"));
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "b"}, {1, .5, .5}), Contains("the matrix needs 2 x 2 numbers, not 3"));
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "zz"}, {1, .5, .5, 1}), Contains("'zz' is not a quantity"));
  CHECK_THAT(tie(Correlation::Kind::copula, {"a", "a"}, {1, .5, .5, 1}), Contains("named twice"));
  // Two exponentials reach no Pearson coefficient below 1 - pi^2/6 = -0.645; a normal and one, none above 0.9032.
  CHECK_THAT(tie(Correlation::Kind::pearson, {"a", "e"}, {1, -.95, -.95, 1}), Contains("a Gaussian copula cannot reach"));
  CHECK_THAT(tie(Correlation::Kind::pearson, {"a", "cauchy"}, {1, .5, .5, 1}),
             Contains("a Pearson coefficient does not exist"));
  CHECK(tie(Correlation::Kind::spearman, {"a", "cauchy"}, {1, .5, .5, 1}) == "no error");

  const std::vector<Reading> setups = {reading({{"setup", "1"}}), reading({{"setup", "2"}})};
  CHECK_THAT(refuse({quantity("p", {component("a", standard, {"setpu"})})}, {}, setups),
             Contains("'setpu' is not a label") && Contains("'setup'"));
  CHECK_THAT(refuse({{"p", "m", "m", {{{{"setup", "1"}}, 0, {}, ""}}}}, {}, setups),
             Contains("p: no value for setup 2"));
  CHECK_THAT(refuse({quantity("p", {component("a", standard), component("b", standard)}), simple("q", standard)},
                    {{Correlation::Kind::copula, {"p", "q"}, {1, .5, .5, 1}}}, one_reading),
             Contains("several components"));
  CHECK_THAT(refuse({quantity("p", {component("a", standard, {"setup"})}), simple("q", standard)},
                    {{Correlation::Kind::copula, {"p", "q"}, {1, .5, .5, 1}}}, setups),
             Contains("has no draw"));
  CHECK_THAT(refuse({quantity("p", {component("a", standard), component("a", standard)})}, {}, one_reading),
             Contains("two components are named 'a'"));
}
