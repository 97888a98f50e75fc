#include <catch2/catch.hpp>

#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

using namespace gumshoe::tracing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// A named effect of one size: a delay of 0.1 to 5 ms on its card, which is never negative.
Finding delayed(double seconds) {
  Amplitude delay;
  delay.name = "delay";
  delay.unit = "ms";
  delay.si_unit = "s";
  delay.typical = 5e-3;
  delay.least_typical = 0.1e-3;
  delay.positive = true;
  Term term;
  term.candidate.amplitudes = {delay};
  term.size = Vector::Constant(1, seconds);
  Finding out;
  out.name = "trigger_latency";
  remark_on_size(term, out);
  return out;
}

} // namespace

TEST_CASE("a size that no such effect has is likely an alias's", "[tracing]") {
  CHECK(delayed(2e-3).implausible.empty());
  CHECK(delayed(24e-3).implausible.empty()); // a slow control
  CHECK_THAT(delayed(26e-3).implausible, StartsWith("far above"));
  CHECK_THAT(delayed(-2e-3).implausible, StartsWith("negative"));
  CHECK_THAT(delayed(1e-6).implausible, StartsWith("far below"));
  CHECK_THAT(delayed(-2e-3).remarks.at(0), Contains("-2 ms") && Contains("alias"));
}

TEST_CASE("an effect of an implausible size is no effect that the model lacks", "[tracing]") {
  Trace t;
  t.outcome = Outcome::found;
  t.rms.unit = t.rms.si_unit = "m";
  t.findings = {delayed(-2e-3)};
  SizedQuantity& size = t.findings[0].quantities.emplace_back();
  size.name = "delay";
  size.unit = "ms";
  size.si_unit = "s";
  size.value = -2e-3;
  summarise(t);
  CHECK_THAT(t.plain.at(0), StartsWith("A part of the error looks like trigger_latency") && Contains("alias"));
}
