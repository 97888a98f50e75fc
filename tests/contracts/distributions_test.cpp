// Every family keeps the promises of quantities/distribution.h.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "base/hash.h"
#include "quantities/distribution.h"
#include "quantities/quantile_kernels.h"

using namespace gumshoe;
using namespace gumshoe::quantities;

namespace {

Distribution make(Family family, std::array<double, 4> parameters) { return {family, parameters, {}, {}}; }

Distribution with_values(Family family, std::vector<double> values, std::vector<double> probabilities = {}) {
  Distribution d{family, {}, std::make_shared<const std::vector<double>>(std::move(values)), {}};
  if (!probabilities.empty()) d.probabilities = std::make_shared<const std::vector<double>>(std::move(probabilities));
  return d;
}

const double infinity = std::numeric_limits<double>::infinity();

std::vector<Distribution> continuous() {
  return {make(Family::rectangular, {0.02e-3, 0.04e-3}),
          make(Family::curvilinear_trapezoid, {-1, 1, 0.5}),
          make(Family::curvilinear_trapezoid, {2, 4, 1}),
          make(Family::curvilinear_trapezoid, {-3, 1, 0.01}),
          make(Family::trapezoid, {-1, 3, 0.3}),
          make(Family::trapezoid, {-1, 3, 1}),
          make(Family::trapezoid, {-1, 3, 0}),
          make(Family::triangular, {1, 2}),
          make(Family::arcsine, {-2, 5}),
          make(Family::normal, {10, 0.1}),
          make(Family::t, {1, 0.5, 9}),
          make(Family::t, {0, 1, 4.5}),
          make(Family::t, {0, 2, 25.3}),
          make(Family::exponential, {3}),
          make(Family::gamma, {4, 1}),
          make(Family::gamma, {0.7, 2}),
          make(Family::lognormal, {0.2, 0.5}),
          make(Family::truncated_normal, {0, 1, -1, 2}),
          make(Family::truncated_normal, {1, 2, 0, infinity}),
          make(Family::truncated_normal, {0, 1, 4, 5}),
          make(Family::truncated_normal, {0, 1, -6, -5.99})};
}

std::vector<Distribution> with_steps() {
  return {with_values(Family::discrete, {-1, 0, 2.5}, {0.2, 0.5, 0.3}),
          with_values(Family::empirical, {1, 1.5, 1.5, 2, 4, 7, 11})};
}

std::string title(const Distribution& d) {
  for (const FamilyCard& card : families())
    if (card.family == d.family)
      return std::string(card.name) + " " + std::to_string(d.parameters[0]) + " " + std::to_string(d.parameters[1]) +
             " " + std::to_string(d.parameters[2]) + " " + std::to_string(d.parameters[3]);
  return "no card";
}

} // namespace

TEST_CASE("every family has a card, is found by name, and is swept here", "[contracts][distributions]") {
  std::vector<Distribution> all = continuous();
  for (const Distribution& d : with_steps()) all.push_back(d);
  all.push_back(make(Family::constant, {3}));
  for (const FamilyCard& card : families()) {
    INFO(card.name);
    REQUIRE(find_family(card.name) == &card);
    CHECK(std::any_of(all.begin(), all.end(), [&](const Distribution& d) { return d.family == card.family; }));
  }
  CHECK(find_family("gaussian") == nullptr);
  for (const Distribution& d : all) {
    INFO(title(d));
    CHECK(invalid_parameters(d) == "");
  }
}

TEST_CASE("the quantile function inverts the distribution function", "[contracts][distributions]") {
  for (const Distribution& d : continuous()) {
    INFO(title(d));
    double before = -infinity;
    for (int i = 1; i < 512; ++i) {
      const double u = i / 512.0, x = d.quantile(u);
      REQUIRE(x > before); // one uniform, one deviate, in order
      before = x;
      REQUIRE(x >= d.support_low());
      REQUIRE(x <= d.support_high());
      // the roundings of x, and of the parent's probability where a truncated normal is narrow and far out
      CHECK(std::abs(d.probability(x) - u) < 2e-14 + 2e-15 * std::abs(x) * d.density(x));
    }
    CHECK(d.probability(d.support_low()) == 0);
    CHECK(d.probability(d.support_high()) == 1);
  }
  for (const Distribution& d : with_steps())
    for (const double x : *d.values) CHECK(d.quantile(d.probability(x)) == x);
}

TEST_CASE("the density is the derivative of the distribution function", "[contracts][distributions]") {
  for (const Distribution& d : continuous()) {
    INFO(title(d));
    for (const double u : {0.03, 0.2, 0.45, 0.77, 0.96}) { // not 0.5, where some have a corner or a pole
      const double x = d.quantile(u);
      const double scale = std::min({d.quantile(0.75) - d.quantile(0.25), x - d.support_low(), d.support_high() - x});
      const double h = 1e-4 * scale, slope = (d.probability(x + h) - d.probability(x - h)) / (2 * h);
      // (h / scale)^2 = 1e-8, and rounding: 1e-13 (see above) over 1e-4 times the probability within scale
      CHECK(d.density(x) == Approx(slope).epsilon(1e-6));
    }
  }
}

TEST_CASE("moments equal the integrals of the quantile function", "[contracts][distributions]") {
  // Independent of the formulas: E[g(x)] is the integral of g(quantile(u)) over u.
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const Distribution& d : continuous()) {
    // Only light tails: u stops at 2^-53, which cuts off the heavy ones' fourth moments.
    if (d.family == Family::t && d.parameters[2] < 20) continue;
    INFO(title(d));
    const QuantileFunction quantile(d);
    const auto moment = [&](double centre, int power) {
      return integrator.integrate(
          [&](double u) {
            double lanes[8] = {std::min(std::max(u, 0x1p-53), 1 - 0x1p-53), .5, .5, .5, .5, .5, .5, .5};
            quantile(lanes, lanes, 8);
            return std::pow(lanes[0] - centre, power);
          },
          0.0, 1.0, 1e-11);
    };
    const double sd = std::sqrt(d.variance());
    CHECK(std::abs(moment(d.mean(), 1)) < 1e-7 * sd);
    CHECK(moment(d.mean(), 2) == Approx(d.variance()).epsilon(1e-7));
    CHECK(moment(d.mean(), 4) == Approx(d.kurtosis() * d.variance() * d.variance()).epsilon(1e-4));
  }
  const Distribution discrete = with_steps()[0];
  CHECK(discrete.mean() == Approx(0.55));
  CHECK(discrete.variance() == Approx(0.2 * 1.55 * 1.55 + 0.5 * 0.55 * 0.55 + 0.3 * 1.95 * 1.95));
}

TEST_CASE("moments of JCGM 101 Table 1 and of t without them", "[contracts][distributions]") {
  CHECK(make(Family::curvilinear_trapezoid, {-1, 1, 0.5}).variance() == Approx(4.0 / 12 + 0.25 / 9));
  CHECK(std::sqrt(make(Family::curvilinear_trapezoid, {-1, 1, 0.5}).variance()) == Approx(0.600925).margin(5e-7));
  CHECK(make(Family::curvilinear_trapezoid, {-1, 1, 0.5}).quantile(0.975) == Approx(1.1297).margin(6e-5));
  CHECK(make(Family::trapezoid, {0, 2, 0.5}).variance() == Approx(4 * 1.25 / 24));
  CHECK(make(Family::t, {0, 0.5, 9}).variance() == Approx(0.25 * 9 / 7));
  CHECK(std::isinf(make(Family::t, {0, 1, 2}).variance()));
  CHECK(std::isinf(make(Family::t, {0, 1, 1}).variance()));
  CHECK(std::isnan(make(Family::t, {0, 1, 4}).kurtosis()));
  CHECK(make(Family::t, {0, 1, 9}).kurtosis() == Approx(4.2));
  // Textbook formulas of the truncated normal, where they do not cancel.
  const Distribution d = make(Family::truncated_normal, {0, 1, -1, 2});
  const boost::math::normal_distribution<double> z;
  const double weight = cdf(z, 2) - cdf(z, -1), shift = (pdf(z, -1) - pdf(z, 2)) / weight;
  CHECK(d.mean() == Approx(shift).epsilon(1e-13));
  CHECK(d.variance() == Approx(1 + (-pdf(z, -1) - 2 * pdf(z, 2)) / weight - shift * shift).epsilon(1e-12));
}

TEST_CASE("normal, t and gamma deviates agree with Boost.Math", "[contracts][distributions]") {
  std::vector<double> p;
  for (int octave = 2; octave <= 50; ++octave)
    for (const double m : {1.0, 1.03, 1.31, 1.77, 1.9999}) p.push_back(std::ldexp(m, -octave));
  const auto worst = [&](const Distribution& d, auto&& reference) {
    double error = 0;
    for (const double tail : p)
      for (const bool upper : {false, true}) {
        const double u = upper ? 1 - tail : tail;
        const long double exact = reference(upper ? 1 - static_cast<long double>(u) : u, upper);
        error = std::max(error, std::abs(static_cast<double>((d.quantile(u) - exact) / exact)));
      }
    return error;
  };
  const boost::math::normal_distribution<long double> normal;
  CHECK(worst(make(Family::normal, {0, 1}), [&](long double q, bool upper) {
          return upper ? quantile(complement(normal, q)) : quantile(normal, q);
        }) < 1.5e-15);
  for (const double nu : {0.5, 1.0, 2.0, 2.7, 3.0, 4.0, 9.0, 24.0, 1000.0}) {
    INFO("degrees of freedom " << nu);
    const boost::math::students_t_distribution<long double> t(nu);
    CHECK(worst(make(Family::t, {0, 1, nu}), [&](long double q, bool upper) {
            return upper ? quantile(complement(t, q)) : quantile(t, q);
          }) < 1e-12);
  }
  for (const double shape : {0.3, 1.0, 2.5, 8.0, 300.0}) {
    INFO("shape " << shape);
    CHECK(worst(make(Family::gamma, {shape, 1}), [&](long double q, bool upper) {
            const long double k = shape;
            return upper ? boost::math::gamma_q_inv(k, q) : boost::math::gamma_p_inv(k, q);
          }) < 1e-12);
  }
}

TEST_CASE("many quantiles have the bits of one, on every instruction set", "[contracts][distributions]") {
  constexpr std::size_t n = 1024;
  std::vector<double> u(n), batch(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = (static_cast<double>(mix64(i) >> 12) + 0.5) * 0x1p-52;
  u[0] = 0x1p-53, u[1] = 1 - 0x1p-53, u[2] = 0.5, u[3] = 0.075, u[4] = 0.925;                // ends and joins
  for (std::size_t i = 5; i < 58; ++i) u[i] = std::ldexp(1.3, -static_cast<int>(i) + 5 - 1); // far tails among others
  std::vector<Distribution> all = continuous();
  for (const Distribution& d : with_steps()) all.push_back(d);
  for (const Distribution& d : all) {
    INFO(title(d));
    const QuantileFunction quantile(d);
    quantile(u.data(), batch.data(), n);
    for (std::size_t i = 0; i < n; i += 7) REQUIRE(batch[i] == d.quantile(u[i]));
    std::vector<double> in_place = u;
    quantile(in_place.data(), in_place.data(), n);
    CHECK(in_place == batch);
    for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!available(set)) continue;
      INFO(name(set));
      std::vector<double> other(n);
      select_kernels(set);
      QuantileFunction{d}(u.data(), other.data(), n); // its constants come from the set's kernels too
      select_kernels(best_instruction_set());
      CHECK(other == batch);
    }
  }
}

TEST_CASE("invalid parameters are named", "[contracts][distributions]") {
  const double nan = std::nan("");
  for (const Distribution& d :
       {make(Family::rectangular, {1, 1}), make(Family::triangular, {2, 1}), make(Family::arcsine, {nan, 1}),
        make(Family::curvilinear_trapezoid, {0, 1, 0.6}), make(Family::curvilinear_trapezoid, {0, 1, 0}),
        make(Family::trapezoid, {0, 1, 1.1}), make(Family::normal, {0, 0}), make(Family::normal, {0, infinity}),
        make(Family::t, {0, 1, 0}), make(Family::exponential, {-1}), make(Family::gamma, {0, 1}),
        make(Family::lognormal, {0, -1}), make(Family::truncated_normal, {0, 1, 2, 1}),
        make(Family::truncated_normal, {0, 1, 50, 51}), make(Family::discrete, {}), make(Family::empirical, {}),
        with_values(Family::discrete, {1, 2}, {0.5, 0.6}), with_values(Family::empirical, {2, 1})}) {
    INFO(title(d));
    CHECK(invalid_parameters(d) != "");
  }
}
