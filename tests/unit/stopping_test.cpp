// How many trials until a result is known: JCGM 101 7.9 and the two-stage rule.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>

#include "analysis/stopping.h"
#include "analysis/summary.h"
#include "analysis/tolerance.h"
#include "quantities/distribution.h"
#include "random/streams.h"

using namespace gumshoe;
using namespace gumshoe::analysis;

namespace {

const propagation::Output output{"y", "y", 0, "1", "1"};

/// Values [first, first + n) of a normal quantity with u = 5: two digits of u mean delta = 0.05, a hundredth of u.
std::vector<double> draw(std::uint64_t seed, std::uint64_t first, std::size_t n) {
  static const quantities::QuantileFunction normal({quantities::Family::normal, {0, 5}, nullptr, nullptr});
  std::vector<double> x((n + 7) / 8 * 8);
  random::uniforms({seed}, first, x.size(), x.data());
  normal(x.data(), x.data(), x.size());
  x.resize(n);
  return x;
}

Ends ends(std::vector<double> values) { return symmetric_ends(values, 0.95); }

struct Trial {
  std::uint64_t stein = 0, jcgm = 0;
  Ends stein_ends{}, jcgm_ends{};
};
Trial run(std::uint64_t seed) {
  StoppingRules rules({output}, 0.95, 2);
  std::vector<double> all;
  Trial t;
  const auto more = [&] {
    const auto block = draw(seed, all.size(), rules.block());
    all.insert(all.end(), block.begin(), block.end());
    rules.add(0, block);
    if (t.jcgm == 0 && rules.jcgm_blocks() > 0) {
      t.jcgm = all.size();
      t.jcgm_ends = ends(all);
    }
  };
  while (rules.blocks() < StoppingRules::first_stage || rules.blocks() < rules.stein_blocks()) more();
  t.stein = all.size();
  t.stein_ends = ends(all);
  while (t.jcgm == 0) more();
  return t;
}

} // namespace

TEST_CASE("the numerical tolerance is half a unit of the last meaningful digit", "[stopping]") {
  // JCGM 101 7.9.2: u = 0.00035 to two digits is 35e-5, delta = 0.5e-5; 9.96 rounds to 10, two digits of it are 10.
  CHECK(numerical_tolerance(0.00035, 2, output) == Approx(0.5e-5).epsilon(1e-12));
  CHECK(numerical_tolerance(2.0, 1, output) == Approx(0.5).epsilon(1e-12));
  CHECK(numerical_tolerance(9.96, 2, output) == Approx(0.5).epsilon(1e-12));
  // The digits are those of the unit that people read: 0.35 um is 35e-2 um.
  CHECK(numerical_tolerance(0.35e-6, 2, {"y", "y", 0, "um", "m"}) == Approx(0.005e-6).epsilon(1e-12));
}

TEST_CASE("blocks are as long as JCGM 101 7.9.4 asks", "[stopping]") {
  CHECK(StoppingRules({output}, 0.95, 2).block() == 10'000);
  CHECK(StoppingRules({output}, 0.999, 2).block() == 100'000);
}

TEST_CASE("two-stage runs keep their promise, the printed rule stops earlier", "[stopping][coverage]") {
  // Exact ends +-1.959964 * 5. The two-stage rule promises each end within delta with 95 %; it is derived for the mean
  // of the blocks' ends, the pooled end differs from it by O(1 / J). The printed rule stops when chance allows.
  const bool fresh = std::getenv("GUMSHOE_LONG_SEED") != nullptr;
  const std::uint64_t seeds = fresh ? 1000 : 200,
                      start = fresh ? std::strtoull(std::getenv("GUMSHOE_LONG_SEED"), nullptr, 10) : 7;
  const double exact = 1.959963984540054 * 5, delta = 0.05;
  double low = 0, high = 0, jcgm_both = 0, stein_both = 0, trials = 0, jcgm_trials = 0;
  for (std::uint64_t k = 0; k < seeds; ++k) {
    const Trial t = run(start * 1'000'003 + k);
    low += std::fabs(t.stein_ends.low + exact) <= delta;
    high += std::fabs(t.stein_ends.high - exact) <= delta;
    stein_both += std::fabs(t.stein_ends.low + exact) <= delta && std::fabs(t.stein_ends.high - exact) <= delta;
    jcgm_both += std::fabs(t.jcgm_ends.low + exact) <= delta && std::fabs(t.jcgm_ends.high - exact) <= delta;
    trials += static_cast<double>(t.stein);
    jcgm_trials += static_cast<double>(t.jcgm);
  }
  const double n = static_cast<double>(seeds), least = 0.95 - 3 * std::sqrt(0.95 * 0.05 / n);
  INFO("mean trials: two-stage " << trials / n << ", printed " << jcgm_trials / n
                                 << "; both ends within delta: two-stage " << stein_both / n << ", printed "
                                 << jcgm_both / n);
  CHECK(low / n >= least);
  CHECK(high / n >= least);
  CHECK(jcgm_trials < 0.8 * trials);
  CHECK(jcgm_both < stein_both); // stopping by chance has its price
}

TEST_CASE("a constant needs no trials beyond the first blocks, several outputs wait for the slowest", "[stopping]") {
  StoppingRules rules({output, output}, 0.95, 2);
  const std::vector<double> constant(rules.block(), 3.0);
  for (int k = 0; k < 10; ++k) {
    rules.add(0, constant);
    rules.add(1, draw(99, static_cast<std::uint64_t>(k) * rules.block(), rules.block()));
    if (k == 1) CHECK(rules.jcgm_blocks() == 0);
  }
  StoppingRules alone({output}, 0.95, 2);
  for (int k = 0; k < 10; ++k) alone.add(0, draw(99, static_cast<std::uint64_t>(k) * alone.block(), alone.block()));
  CHECK(rules.stein_blocks() == alone.stein_blocks());
  CHECK(rules.stein_blocks() > 10);
  StoppingRules still({output}, 0.95, 2);
  for (int k = 0; k < 10; ++k) still.add(0, constant);
  CHECK(still.jcgm_blocks() == 2);
  CHECK(still.stein_blocks() == 10);
  CHECK(std::isnan(still.tolerances()[0]));
}
