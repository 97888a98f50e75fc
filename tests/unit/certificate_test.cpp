/// The certificate's line, units that suit a number, and probabilities as bounds.
#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/certificate.h"
#include "analysis/rounding.h"
#include "analysis/summary.h"

using namespace gumshoe;
using namespace gumshoe::analysis;

namespace {

propagation::Output length() {
  propagation::Output output;
  output.name = output.measurand = "y";
  output.unit = "mm";
  output.si_unit = "m";
  return output;
}

Budget framework(double estimate, double u, double k, double degrees_of_freedom) {
  Budget b;
  b.output = length();
  b.estimate = estimate;
  b.combined_standard_uncertainty = u;
  b.coverage_factor = k;
  b.expanded_uncertainty = k * u;
  b.effective_degrees_of_freedom = degrees_of_freedom;
  return b;
}

} // namespace

TEST_CASE("U by Monte Carlo covers the coverage probability about the estimate of a skewed measurand",
          "[certificate][summary]") {
  // Exponential of mean 1: [1 - U, 1 + U] holds 95 % at U = ln 20 - 1 = 1.9957, where 1 - U is below zero. Half the
  // shortest interval, ln 20 / 2 = 1.4979, would cover 91.8 % only.
  std::vector<double> values;
  constexpr int n = 200'000;
  for (int i = 0; i < n; ++i) values.push_back(-std::log((i + 0.5) / n));
  const Summary s = summarise(length(), values, 0.95);
  CHECK(s.monte_carlo_expanded == Approx(std::log(20.0) - 1).epsilon(1e-3));
}

TEST_CASE("the certificate gives U and k of the framework where it is validated", "[certificate]") {
  Summary s;
  s.output = length();
  s.valid = 1'000'000;
  s.estimate = 10.003387e-3;
  s.standard_uncertainty = 0.0505e-6;
  s.monte_carlo_expanded = 0.11e-6;
  Validation v;
  v.verdict = "validated";
  constexpr double infinite = std::numeric_limits<double>::infinity();
  certify(s, framework(s.estimate, 0.0505e-6, 1.959964, infinite), v, 0.95);
  CHECK(s.certificate == "y = (10.003387 +- 0.000099) mm, k = 1.96, 95 %");
  certify(s, framework(s.estimate, 0.0505e-6, 2.262157, 9), v, 0.95);
  CHECK(s.certificate == "y = (10.00339 +- 0.00011) mm, k = 2.26 (9 effective degrees of freedom), 95 %");
  certify(s, framework(s.estimate, 0.0505e-6, 4.417173, infinite), v, 0.99999);
  CHECK(s.certificate == "y = (10.00339 +- 0.00022) mm, k = 4.42, 99.999 %");
  v.verdict = "not validated";
  certify(s, framework(s.estimate, 0.0505e-6, 1.959964, infinite), v, 0.95);
  CHECK(s.certificate == "y = (10.00339 +- 0.00011) mm, k = 2.18, 95 %");
  s.standard_uncertainty = std::nan("");
  certify(s, framework(s.estimate, 0.0505e-6, 1.959964, infinite), v, 0.95);
  CHECK(s.certificate.empty());
  CHECK(std::isnan(s.expanded_uncertainty));
}

TEST_CASE("an uncertainty stands in the unit that suits it", "[certificate][rounding]") {
  CHECK(with_suitable_unit(0.052e-6, "mm", "m") == "0.052 um");
  CHECK(with_suitable_unit(3.9e-6, "mm", "m") == "3.9 um");
  CHECK(with_suitable_unit(0.12e-3, "mm", "m") == "0.12 mm");
  CHECK(with_suitable_unit(10e-6, "mm", "m") == "0.010 mm");
  CHECK(with_suitable_unit(0.4e-9, "mm", "m") == "0.40 nm");
  CHECK(with_suitable_unit(0, "mm", "m") == "0 mm");
  CHECK(with_suitable_unit(0.005, "degC", "K") == "5.0 mK");
  CHECK(with_suitable_unit(0.0012, "1", "1") == "0.0012");
}

TEST_CASE("a probability that the samples do not resolve is a bound", "[certificate][rounding]") {
  CHECK(probability_text(1, 3e-6) == "> 99.9997 %");
  CHECK(probability_text(0, 3e-6) == "< 0.0003 %");
  CHECK(probability_text(1.08e-52, 1.5e-5) == "< 0.002 %"); // rounded up: the bound holds
  CHECK(probability_text(1, 1.5e-5) == "> 99.998 %");
  CHECK(probability_text(0.975, 3e-6) == "97.50 %");
  CHECK(probability_text(0.151, 3e-6) == "15.1 %");
}
