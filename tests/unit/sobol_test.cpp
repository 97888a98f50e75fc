#include <catch2/catch.hpp>

#include <limits>

#include "analysis/sobol.h"
#include "base/error.h"
#include "unit/sobol_models.h"

using namespace gumshoe;
using namespace gumshoe::sobol_models;
using analysis::Sensitivity;
using analysis::sobol_indices;

namespace {

struct Truth {
  std::vector<double> first, total, second; ///< second: pairs in the order (1, 2), (1, 3), ...
};

const Truth ishigami{{0.3139051911, 0.4424111448, 0}, {0.5575888552, 0.4424111448, 0.2436836641}, {0, 0.2436836641, 0}};
const Truth product{{0, 0}, {1, 1}, {1}};
const Truth borgonovo{{3 / 19., 3 / 19., 12 / 19.}, {4 / 19., 4 / 19., 12 / 19.}, {1 / 19., 0, 0}};
const Truth sum{{1 / 6., 1 / 6., 4 / 6.}, {1 / 6., 1 / 6., 4 / 6.}, {0, 0, 0}};

/// V_i = 1 / 3 (1 + a_i)^2, of a product of independent factors of mean 1: V = prod (1 + V_i) - 1.
Truth g_function() {
  Truth t;
  std::vector<double> v;
  double all = 1;
  for (const double a : G::a) {
    v.push_back(1 / (3 * (1 + a) * (1 + a)));
    all *= 1 + v.back();
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    t.first.push_back(v[i] / (all - 1));
    t.total.push_back(v[i] * all / (1 + v[i]) / (all - 1));
    for (std::size_t j = i + 1; j < v.size(); ++j) t.second.push_back(v[i] * v[j] / (all - 1));
  }
  return t;
}

template <class F> Sensitivity run(std::uint64_t n, std::uint64_t seed, bool second_order, int threads = 1) {
  const auto toy = experiment<F>(F::distributions(), seed, {}, second_order);
  return sobol_indices(*toy->experiment, n, threads).at(0);
}

/// Every index lies within four of its own standard errors of the truth; the widest standard error.
double check_against(const Sensitivity& s, const Truth& t) {
  double widest = 0;
  const auto check = [&](double value, double low, double high, double truth) {
    const double se = (high - low) / 2 / 1.96;
    CHECK(std::fabs(value - truth) <= 4 * se + 1e-14);
    widest = std::max(widest, se);
  };
  REQUIRE(s.indices.size() == t.first.size());
  for (std::size_t i = 0; i < s.indices.size(); ++i) {
    INFO(s.indices[i].input);
    check(s.indices[i].first, s.indices[i].first_low, s.indices[i].first_high, t.first[i]);
    check(s.indices[i].total, s.indices[i].total_low, s.indices[i].total_high, t.total[i]);
  }
  for (std::size_t i = 0; i < s.pairs.size(); ++i) {
    INFO(s.pairs[i].a + " " + s.pairs[i].b);
    check(s.pairs[i].second, s.pairs[i].low, s.pairs[i].high, t.second[i]);
  }
  return widest;
}

/// Of `repetitions` 95 % intervals the share that covers the truth lies within four binomial standard deviations.
template <class F> void check_coverage(const Truth& t, std::uint64_t n, bool second_order) {
  const Seeds seeds(400, 4000);
  std::vector<int> first(t.first.size()), total(t.total.size()), second(t.second.size());
  for (std::size_t k = 0; k < seeds.repetitions; ++k) {
    const Sensitivity s = run<F>(n, seeds.first + k, second_order);
    for (std::size_t i = 0; i < first.size(); ++i) {
      first[i] += s.indices[i].first_low <= t.first[i] && t.first[i] <= s.indices[i].first_high;
      total[i] += s.indices[i].total_low <= t.total[i] && t.total[i] <= s.indices[i].total_high;
    }
    for (std::size_t i = 0; i < s.pairs.size(); ++i)
      second[i] += s.pairs[i].low <= t.second[i] && t.second[i] <= s.pairs[i].high;
  }
  const double m = static_cast<double>(seeds.repetitions), allowed = 4 * std::sqrt(0.95 * 0.05 / m);
  const auto check = [&](const std::vector<int>& counts, const char* what) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      INFO(what << " " << i + 1 << ", n = " << n << ", second order " << second_order);
      CHECK(std::fabs(counts[i] / m - 0.95) <= allowed);
    }
  };
  check(first, "first-order index");
  check(total, "total index");
  if (second_order) check(second, "pair");
}

/// Fails where x1 > 1.
struct Failing {
  static constexpr std::size_t inputs = 2, outputs = 1;
  void operator()(const auto& x, auto& y) const {
    y[0] = x[0] > 1 ? std::numeric_limits<double>::quiet_NaN() : x[0] + x[1];
  }
  static std::vector<Distribution> distributions() { return {rectangular(-1, 1.1), normal(1)}; }
};

struct Constant {
  static constexpr std::size_t inputs = 1, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = 3 + 0 * x[0]; }
  static std::vector<Distribution> distributions() { return {normal(1)}; }
};

/// x2 does not matter.
struct Idle {
  static constexpr std::size_t inputs = 2, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = x[0] * x[0] + 0 * x[1]; }
  static std::vector<Distribution> distributions() { return {normal(1), normal(1)}; }
};

} // namespace

TEST_CASE("Sobol' indices agree with published and closed forms", "[sobol]") {
  // With n = 2^16 the standard errors of indices are of the order of n^(-1/2) = 0.004; the widest is the total
  // index of a product of normals, whose squares have a kurtosis of 9 each.
  for (const bool second_order : {false, true}) {
    CHECK(check_against(run<Ishigami>(65536, 1, second_order, 2), ishigami) < 0.006);
    CHECK(check_against(run<G>(65536, 1, second_order, 2), g_function()) < 0.006);
    CHECK(check_against(run<Borgonovo>(65536, 1, second_order, 2), borgonovo) < 0.006);
    CHECK(check_against(run<Product>(65536, 1, second_order, 2), product) < 0.012);
    CHECK(check_against(run<Sum>(65536, 1, second_order, 2), sum) < 0.006);
  }
  // Facts as printed, to their digits.
  const Truth g = g_function();
  CHECK(g.first[0] == Approx(0.716192).margin(5e-7));
  CHECK(g.total[1] == Approx(0.242198).margin(5e-7));
}

TEST_CASE("a product of centred normals has no first-order indices and all of the second", "[sobol]") {
  const Sensitivity s = run<Product>(65536, 3, true, 2);
  for (const auto& i : s.indices) {
    CHECK(i.first_verdict == "zero within its interval");
    CHECK(i.total_verdict == "resolved");
    CHECK(i.total == Approx(1).margin(0.06));
  }
  REQUIRE(s.pairs.size() == 1);
  CHECK(s.pairs[0].a == "x1");
  CHECK(s.pairs[0].b == "x2");
  CHECK(s.pairs[0].verdict == "resolved");
  CHECK(s.pairs[0].second == Approx(1).margin(0.06));
}

TEST_CASE("verdicts on indices", "[sobol]") {
  CHECK(run<Product>(256, 1, false).indices[0].total_verdict == "not converged"); // SE near 0.15
  const Sensitivity idle = run<Idle>(4096, 1, true);
  CHECK(idle.indices[0].first == Approx(1).margin(1e-12)); // all of the variance: no error at all
  CHECK(idle.indices[1].first == 0);
  CHECK(idle.indices[1].total == 0);
  CHECK(idle.indices[1].first_verdict == "zero within its interval");
  CHECK(idle.indices[1].total_verdict == "zero within its interval");
  CHECK(idle.pairs[0].verdict == "zero within its interval");
  // A hundredth of a percent is small, not zero.
  const Sensitivity g = run<G>(65536, 1, false, 2);
  CHECK(g.indices[7].total_verdict == "resolved");
  CHECK(g.indices[7].first_verdict == "zero within its interval");
  const Sensitivity constant = run<Constant>(1024, 1, false);
  CHECK(std::isnan(constant.indices[0].total));
  CHECK(std::isnan(constant.indices[0].first));
  CHECK(constant.indices[0].first_verdict == "not converged");
}

TEST_CASE("intervals of Sobol' indices cover at their nominal 95 %", "[sobol][coverage]") {
  for (const bool second_order : {false, true}) {
    check_coverage<Ishigami>(ishigami, 1024, second_order);
    check_coverage<Product>(product, 2048, second_order);
    check_coverage<Borgonovo>(borgonovo, 1024, second_order);
    check_coverage<Sum>(sum, 1024, second_order);
    check_coverage<G>(g_function(), 1024, second_order);
  }
  check_coverage<Ishigami>(ishigami, 4096, false);
}

TEST_CASE("intervals of Sobol' indices of heavy-tailed output are wide enough", "[sobol][coverage]") {
  // V_i = exp(a_i^2) - 1 of each factor, V = (1 + V_1)(1 + V_2) - 1.
  const double v1 = std::expm1(1.0), v2 = std::expm1(0.49), v = (1 + v1) * (1 + v2) - 1;
  const double first[] = {v1 / v, v2 / v}, total[] = {1 - v2 / v, 1 - v1 / v};
  const Seeds seeds(400, 4000);
  for (const std::uint64_t n : {1024, 16'384}) {
    int held[4] = {};
    for (std::size_t k = 0; k < seeds.repetitions; ++k) {
      const Sensitivity s = run<HeavyTails>(n, seeds.first + k, false);
      for (std::size_t i = 0; i < 2; ++i) {
        held[i] += s.indices[i].first_low <= first[i] && first[i] <= s.indices[i].first_high;
        held[2 + i] += s.indices[i].total_low <= total[i] && total[i] <= s.indices[i].total_high;
      }
    }
    for (const int h : held) {
      INFO(n << " rows: " << h << " of " << seeds.repetitions);
      CHECK(h >= 0.9 * static_cast<double>(seeds.repetitions));
    }
  }
}

TEST_CASE("standard errors of Sobol' indices fall as the root of the rows", "[sobol]") {
  const auto width = [](std::uint64_t n) {
    const Sensitivity s = run<Ishigami>(n, 5, false, 2);
    return s.indices[0].total_high - s.indices[0].total_low;
  };
  CHECK(width(16384) / width(262144) == Approx(4).epsilon(0.1)); // each known to 3 %
}

TEST_CASE("a row with a failed run is dropped whole and counted", "[sobol]") {
  // A row of A, B, AB_1, AB_2 holds two draws of x1; each is impossible with probability 1 / 21.
  const std::uint64_t n = 16384;
  for (const bool second_order : {false, true}) {
    const Sensitivity s = run<Failing>(n, 1, second_order);
    const double p = 1 - (20. / 21) * (20. / 21), expected = p * static_cast<double>(n);
    CHECK(std::fabs(static_cast<double>(s.dropped_rows) - expected) <= 4 * std::sqrt(expected * (1 - p)));
    // What is left is x1 rectangular in [-1, 1], of variance 1 / 3, and x2.
    check_against(s, {{0.25, 0.75}, {0.25, 0.75}, {0}});
  }
}

TEST_CASE("Sobol' indices have the same bits for any number of threads", "[sobol]") {
  const auto bits = [](int threads) {
    const Sensitivity s = run<Ishigami>(100'000, 1, true, threads);
    std::vector<double> all;
    for (const auto& i : s.indices)
      all.insert(all.end(), {i.first, i.first_low, i.first_high, i.total, i.total_low, i.total_high});
    for (const auto& p : s.pairs) all.insert(all.end(), {p.second, p.low, p.high});
    return all;
  };
  const auto one = bits(1), seven = bits(7);
  CHECK(one == seven);
}

TEST_CASE("correlated inputs have no Sobol' indices", "[sobol]") {
  const auto toy = experiment<Sum>(Sum::distributions(), 1,
                                   {{quantities::Correlation::Kind::pearson, {"x2", "x3"}, {1, 0.5, 0.5, 1}}});
  CHECK_THROWS_WITH(sobol_indices(*toy->experiment, 1024, 1),
                    Catch::Contains("correlated") && Catch::Contains("shapley = 4096"));
}

TEST_CASE("the draws of one quantity together are one factor", "[sobol]") {
  // y = x1 x2 + x3, x1 the sum of two draws: S_1 = v1 m2^2 / V and T_1 = S_1 + v1 v2 / V, with v1 the sum of two.
  const auto toy = experiment<Borgonovo>(Borgonovo::distributions(), 5, {}, true);
  auto& s = toy->scenario;
  s.quantities[0].entries[0].components.push_back({"more", normal(0.3), 'B', HUGE_VAL, {}, ""});
  s.analysis.sensitivity.by_quantity = true;
  const propagation::Experiment grouped(s);
  const double v = 1 / 12., v1 = v + 0.09, all = v1 * v + v1 / 4 + v / 4 + v;
  const Truth truth{{v1 / 4 / all, v / 4 / all, v / all},
                    {(v1 / 4 + v1 * v) / all, (v / 4 + v1 * v) / all, v / all},
                    {v1 * v / all, 0, 0}};
  REQUIRE(truth.first[0] > 1.5 * truth.first[1]); // the second draw matters
  const Sensitivity found = sobol_indices(grouped, 65536, 2).at(0);
  CHECK(found.indices.at(0).input == "x1");
  CHECK(check_against(found, truth) < 0.01);

  s.analysis.sensitivity.by_quantity = false;
  const propagation::Experiment apart(s);
  const auto single = sobol_indices(apart, 65536, 2).at(0).indices;
  REQUIRE(single.size() == 4);
  CHECK(single[0].first + single[1].first == Approx(truth.first[0]).margin(0.02));
}
