// Distributions at the limits of their parameters can be drawn.
#include <catch2/catch.hpp>

#include <cmath>

#include "unit/sampling.h"

using namespace gumshoe;
using namespace gumshoe::fixture;

TEST_CASE("distributions at the limits of their parameters have quantiles", "[distributions]") {
  const auto ends = [](const Distribution& d) {
    const QuantileFunction quantile(d);
    double u[8] = {0x1p-53, 1e-9, 0.1, 0.5, 0.6, 0.9, 1 - 1e-9, 1 - 0x1p-53};
    quantile(u, u, 8);
    for (int i = 0; i < 8; ++i) CHECK(std::isfinite(std::pow(u[i], 4)));
    for (int i = 1; i < 8; ++i) CHECK(u[i - 1] <= u[i]);
  };
  ends(make(Family::t, {0, 1, least_degrees_of_freedom}));
  ends(make(Family::t, {0, 1, 1e300}));
  ends(make(Family::gamma, {1e-12, 1}));
  ends(make(Family::gamma, {1e6, 1}));
}

TEST_CASE("what cannot be drawn all the same is told by its name", "[distributions]") {
  const std::vector<InputQuantity> quantities = {simple("x", make(Family::t, {0, 1, 0.01}))};
  CHECK_THROWS_WITH(draw(make_plan(quantities, {}, one_reading, 1), 64),
                    Catch::Contains("x: the quantiles of its distribution cannot be computed"));
}

TEST_CASE("a multivariate t with very many degrees of freedom is refused: it is normal", "[distributions][copula]") {
  const auto plan = [](double degrees_of_freedom) {
    const Distribution t = make(Family::t, {0, 1, degrees_of_freedom});
    const std::vector<InputQuantity> quantities = {simple("a", t), simple("b", t)};
    const Correlation c{Correlation::Kind::multivariate_t, {"a", "b"}, {1, 0.5, 0.5, 1}};
    return make_plan(quantities, {&c, 1}, one_reading, 1);
  };
  CHECK_NOTHROW(plan(1e6));
  CHECK_THROWS_WITH(plan(1e10), Catch::Contains("a has 1e+10 degrees of freedom, and a multivariate t at most 2e+09"));
}
