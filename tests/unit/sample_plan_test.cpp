#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "base/error.h"
#include "quantities/copula.h"
#include "unit/sampling.h"

using namespace gumshoe;
using namespace gumshoe::fixture;

namespace {

std::string message(auto&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

} // namespace

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
