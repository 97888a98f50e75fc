/// Kernels that belong to no model: the same bits on every instruction set, and the values of a plain loop.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analysis/pick_freeze_sums.h"
#include "analysis/sieve_kernels.h"
#include "kernel_variants.h"
#include "math/products_kernels.h"
#include "tracing/noise/elimination.h"
#include "tracing/noise/elimination_kernels.h"

GUMSHOE_VARIANTS(gumshoe::ProductKernels, products)
GUMSHOE_VARIANTS(gumshoe::analysis::PickFreezeKernels, pick_freeze)
GUMSHOE_VARIANTS(gumshoe::analysis::SieveKernels, sieve)
GUMSHOE_VARIANTS(gumshoe::tracing::EliminationKernels, elimination)

using namespace gumshoe;

namespace {

std::vector<double> drawn(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(1, 2);
  std::vector<double> x(n);
  for (double& v : x) v = normal(engine);
  return x;
}

} // namespace

TEST_CASE("matrix products have the same bits on every instruction set", "[math][kernels]") {
  const std::size_t rows = 53, m = 11, n = 7; // no multiples of lanes
  const auto a = drawn(rows * m, 1), b = drawn(rows * n, 2);
  std::vector<double> first;
  for (const auto& [set, kernels] : products_variants()) {
    INFO(name(set));
    std::vector<double> c(m * n, 0.5);
    kernels->transposed(rows, m, n, a.data(), b.data(), c.data());
    if (first.empty()) first = c;
    CHECK(c == first);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < m; ++i) {
        double sum = 0.5, size = 0;
        for (std::size_t r = 0; r < rows; ++r)
          sum += a[i * rows + r] * b[j * rows + r], size += std::fabs(a[i * rows + r] * b[j * rows + r]);
        CHECK(std::fabs(c[j * m + i] - sum) < 1e-16 * static_cast<double>(rows) * size);
      }
  }
}

TEST_CASE("a sieve keeps what lies in its intervals, in order, on every instruction set", "[summary][kernels]") {
  const analysis::SieveBounds bounds{{-3, 4}, {-1, 5}};
  const auto inside = [&](double v) { return (v >= -3 && v <= -1) || (v >= 4 && v <= 5); };
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  // Every pattern of eight lanes, then numbers, ends of the intervals and what is no number, not in whole lanes.
  std::vector<double> x;
  for (unsigned pattern = 0; pattern < 256; ++pattern)
    for (unsigned lane = 0; lane < 8; ++lane) x.push_back((pattern >> lane & 1u) ? -2 - 1e-3 * lane : 1e-3 * pattern);
  for (const double v : drawn(901, 7)) x.push_back(v);
  for (const double v : {-3.0, -1.0, 4.0, 5.0, -inf, inf, nan}) x.push_back(v);
  std::vector<double> expected;
  for (const double v : x)
    if (inside(v)) expected.push_back(v);
  for (const auto& [set, kernels] : sieve_variants()) {
    INFO(name(set));
    std::vector<double> found(x.size(), nan);
    found.resize(kernels->within(x.data(), x.size(), bounds, found.data()));
    CHECK(found == expected);
    std::size_t below = 0, above = 0;
    kernels->outside(x.data(), x.size(), -3, 5, below, above);
    CHECK(below == static_cast<std::size_t>(std::ranges::count_if(x, [](double v) { return v < -3; })));
    CHECK(above == static_cast<std::size_t>(std::ranges::count_if(x, [](double v) { return v > 5; })));
  }
}

TEST_CASE("sums of a pick-freeze design have the same bits on every instruction set", "[sensitivity][kernels]") {
  using namespace analysis;
  const std::size_t rows = 104, per_group = 32, groups = 4; // the last group is short
  const auto a = drawn(rows, 1), b = drawn(rows, 2), c = drawn(rows, 3), d = drawn(rows, 4), c2 = drawn(rows, 5),
             d2 = drawn(rows, 6);
  std::vector<double> first;
  for (const auto& [set, kernels] : pick_freeze_variants()) {
    INFO(name(set));
    std::vector<double> sums((std::size_t{base_sums} + frozen_sums + 1) * groups, 0.0);
    double* const frozen = &sums[base_sums * groups];
    double* const pairs = &sums[(std::size_t{base_sums} + frozen_sums) * groups];
    kernels->base(a.data(), b.data(), 0.7, rows, per_group, sums.data(), groups);
    kernels->frozen(a.data(), b.data(), c.data(), 0.7, rows, per_group, frozen, groups);
    kernels->mirrored(a.data(), b.data(), c.data(), d.data(), 0.7, rows, per_group, frozen, groups);
    kernels->pair(a.data(), b.data(), c.data(), d.data(), c2.data(), d2.data(), rows, per_group, pairs);
    if (first.empty()) first = sums;
    CHECK(sums == first);
    double ab = 0, cd = 0, products = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      ab += sums[base_ab * groups + g];
      cd += frozen[frozen_cd * groups + g];
      products += pairs[g];
    }
    for (std::size_t i = 0; i < rows; ++i) {
      ab -= (a[i] - 0.7) * (b[i] - 0.7);
      cd -= (c[i] - 0.7) * (d[i] - 0.7);
      products -= (c[i] - a[i]) * (d2[i] - b[i]) + (c2[i] - a[i]) * (d[i] - b[i]);
    }
    for (const double left : {ab, cd, products}) CHECK(std::fabs(left) < 1e-16 * 104 * 104 * 10);
  }
}

TEST_CASE("eliminations have the same bits on every instruction set", "[tracing][kernels]") {
  using namespace tracing;
  // Ten rows; one slot is open over all of them, a second over rows 3 to 7.
  const std::size_t rows = 10;
  const std::vector<std::uint32_t> opened{0, 1}, opened_end{1, 1, 1, 2, 2, 2, 2, 2, 2, 2}, closed{1, 0},
      closed_end{0, 0, 0, 0, 0, 0, 0, 1, 1, 2};
  std::vector<std::uint32_t> slot, rotation_end;
  std::vector<double> cosine, sine;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::uint32_t s = 0; s < (r >= 3 && r <= 7 ? 2u : 1u); ++s) {
      slot.push_back(s);
      cosine.push_back(std::cos(0.3 + 0.1 * static_cast<double>(r)));
      sine.push_back(std::sin(0.3 + 0.1 * static_cast<double>(r)));
    }
    rotation_end.push_back(static_cast<std::uint32_t>(slot.size()));
  }
  EliminationPlan plan{};
  plan.rows = rows, plan.slots = 2, plan.lag = 1, plan.correlation = 0.4;
  plan.opened = opened.data(), plan.opened_end = opened_end.data(), plan.slot = slot.data();
  plan.rotation_end = rotation_end.data(), plan.closed = closed.data(), plan.closed_end = closed_end.data();
  plan.cosine = cosine.data(), plan.sine = sine.data();
  for (const std::size_t lanes : {few_elimination_lanes, elimination_lanes}) {
    const auto y = drawn(rows * lanes, 7);
    std::vector<double> first;
    for (const auto& [set, kernels] : elimination_variants()) {
      INFO(name(set) << ", " << lanes << " columns");
      std::vector<double> all(2 * rows * lanes + 2 * lanes), state((plan.slots + plan.lag) * lanes, 0.0);
      double *const reduced = all.data(), *const restored = &all[rows * lanes], *const kept = &all[2 * rows * lanes];
      std::copy(y.begin(), y.end(), reduced);
      kernels->reduce(plan, lanes, reduced, state.data(), kept);
      std::copy_n(reduced, rows * lanes, restored);
      kernels->restore(plan, lanes, restored, state.data());
      if (first.empty()) first = all;
      CHECK(all == first);
    }
  }
}
