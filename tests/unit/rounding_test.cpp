/// Numbers as text: digits that follow the uncertainty, no sign of zero, no probability of 0 or 1.
#include <catch2/catch.hpp>

#include "analysis/rounding.h"

using namespace gumshoe::analysis;

TEST_CASE("an uncertainty has two digits, a number those of its uncertainty", "[rounding]") {
  CHECK(decimals_for(0.25) == 2);
  CHECK(decimals_for(0.0996) == 2); // 0.0996 rounds to 0.10
  CHECK(decimals_for(250) == -1);
  CHECK(decimals_for(0) == 6);
  CHECK(fixed(3.14159, 2) == "3.14");
  CHECK(fixed(-0.04, 1) == "0.0");
  CHECK(fixed(1254, -1) == "1250");
}

TEST_CASE("more than 15 decimals are written as a power of ten", "[rounding]") {
  CHECK(fixed(1, 16) == "1.0000000000000000e+00");
  CHECK(fixed(1.25e-18, 20) == "1.25e-18");
  CHECK(fixed(-1e-30, 20) == "0e+00"); // less than the last digit
  CHECK(fixed(0, 16) == "0e+00");
}

TEST_CASE("no share and no probability is said to be 0 or 1", "[rounding]") {
  CHECK(share_text(0.004) == "< 1 %");
  CHECK(share_text(0.996) == "> 99 %");
  CHECK(share_text(1.25) == "125 %"); // shares of dependent inputs may exceed 1
  CHECK(share_text(0.5) == "50 %");
  CHECK(probability_text(0, 3e-6) == "< 0.0003 %");
  CHECK(probability_text(1, 3e-6) == "> 99.9997 %");
  CHECK(probability_text(0.25, 3e-6) == "25.0 %");
}

TEST_CASE("a coverage probability is given with the digits that it has, never as 0 or 1", "[rounding]") {
  CHECK(coverage_text(0.95) == "95 %");
  CHECK(coverage_text(0.6827) == "68.27 %");
  CHECK(coverage_text(0.954499736) == "95.45 %");
  CHECK(coverage_text(0.9973) == "99.73 %");
  CHECK(coverage_text(0.5) == "50 %");
  CHECK(coverage_text(0.99999) == "99.999 %");
  CHECK(coverage_text(1 - 1e-9) == "99.9999999 %");
  CHECK(coverage_text(1 - 1e-15) == "> 99.9999999999 %");
  CHECK(coverage_text(1e-5) == "0.001 %");
  CHECK(coverage_text(1e-15) == "< 0.0000000001 %");
}
