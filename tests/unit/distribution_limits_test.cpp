// Distributions at the limits of their parameters can be drawn.
#include <catch2/catch.hpp>

#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "quantities/quantile_kernels.h"
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

// Tails are computed apart from the centre: strips without tails, of tails alone, of both, and of several lengths.
TEST_CASE("normal quantiles are those of each probability alone, in the centre and in the tails", "[distributions]") {
  const boost::math::normal exact;
  const auto expect = [&](const std::vector<double>& u) {
    QuantileSpec standard{Form::normal, {0, 1}, {}}, logarithmic{Form::lognormal, {0.5, 2}, {}};
    for (const QuantileSpec* spec : {&standard, &logarithmic}) {
      std::vector<double> together(u);
      kernels().quantile(spec, together.data(), together.data(), u.size()); // in place, as the sampler does
      for (std::size_t i = 0; i < u.size(); ++i) {
        std::vector<double> alone(8, u[i]);
        kernels().quantile(spec, alone.data(), alone.data(), 8);
        CHECK(together[i] == alone[0]);
        const double upper = u[i] > 0.5 ? 1 - u[i] : u[i]; // exact
        const double z =
            u[i] > 0.5 ? boost::math::quantile(complement(exact, upper)) : boost::math::quantile(exact, upper);
        // A few units in the last place; of the exponential, of its argument.
        if (spec == &standard) CHECK(std::fabs(together[i] - z) <= 1e-15 * std::fabs(z));
        if (spec == &logarithmic)
          CHECK(std::fabs(std::log(together[i]) - 0.5 - 2 * z) <= 3e-15 * (1 + std::fabs(2 * z)));
      }
    }
  };
  for (const std::size_t n : {8, 504, 512, 520, 1032}) {
    std::vector<double> all, centre, tails;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      all.push_back(x);
      centre.push_back(0.08 + 0.84 * x);
      tails.push_back(i % 2 == 0 ? 0.07 * x : 1 - 0.07 * x);
    }
    expect(all);
    expect(centre);
    expect(tails);
  }
  expect({0x1p-53, 1e-12, 0.075, 0.5, 0.925, std::nextafter(0.925, 1.0), 1 - 1e-12, 1 - 0x1p-53});
}
