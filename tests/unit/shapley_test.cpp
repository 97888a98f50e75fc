#include <catch2/catch.hpp>

#include "analysis/conditional_draws.h"
#include "analysis/shapley.h"
#include "analysis/sobol.h"
#include "unit/sobol_models.h"

using namespace gumshoe;
using namespace gumshoe::sobol_models;
using analysis::Shapley;
using quantities::Correlation;

namespace {

Correlation pair(const char* a, const char* b, double r) { return {Correlation::Kind::copula, {a, b}, {1, r, r, 1}}; }

void check_against(const Shapley& s, const std::vector<double>& truth, double widest) {
  double sum = 0;
  REQUIRE(s.effects.size() == truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    INFO(s.effects[i].input << " " << s.effects[i].value);
    const double se = (s.effects[i].high - s.effects[i].low) / 2 / 1.96;
    CHECK(std::fabs(s.effects[i].value - truth[i]) <= 4 * se);
    CHECK(se < widest);
    sum += s.effects[i].value;
  }
  CHECK(sum == Approx(1).epsilon(1e-12));
}

/// Ten inputs, more than all subsets are taken of: sum of c_i x_i, c = 1 to 5 twice.
struct Ten {
  static constexpr std::size_t inputs = 10, outputs = 1;
  void operator()(const auto& x, auto& y) const {
    y[0] = 0;
    for (std::size_t i = 0; i < 10; ++i) y[0] += static_cast<double>(i % 5 + 1) * x[i];
  }
  static std::vector<Distribution> distributions() { return std::vector(10, normal(1)); }
};

/// Ten inputs, of which three matter only together: the last of the three in an order has all of their effect.
struct Together {
  static constexpr std::size_t inputs = 10, outputs = 1;
  void operator()(const auto& x, auto& y) const {
    y[0] = 3 * x[0] * x[4] * x[9];
    for (const std::size_t i : {1, 2, 3, 5, 6, 7, 8}) y[0] += x[i];
  }
};

struct Mixed {
  static constexpr std::size_t inputs = 3, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = x[0] * x[1] + x[2]; }
};

struct Failing {
  static constexpr std::size_t inputs = 2, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = x[0] > 1 ? std::nan("") : x[0] + x[1]; }
};

} // namespace

TEST_CASE("Shapley effects of a sum of correlated normals", "[shapley]") {
  // X1 + X2 + X3, standard deviations 1, 1, 2. SE of order n^(-1/2) = 0.004.
  for (const double rho : {0.0, 0.5, -0.9}) {
    const auto toy = experiment<Sum>(Sum::distributions(), 1, {pair("x2", "x3", rho)});
    const auto results = analysis::shapley_effects(*toy->experiment, 65536, 2);
    // In the order (2, 3) x2 adds (s2 + rho s3)^2 to the variance explained, in the order (3, 2) s2^2 (1 - rho^2).
    const double v = 6 + 4 * rho, x2 = ((1 + 2 * rho) * (1 + 2 * rho) + 1 - rho * rho) / 2;
    INFO("rho = " << rho);
    check_against(results[0], {1 / v, x2 / v, 1 - (1 + x2) / v}, 0.008);
    if (rho == 0.5) check_against(results[0], {0.125, 0.296875, 0.578125}, 0.008);
  }
}

TEST_CASE("independent inputs: Shapley effects lie between first-order and total indices", "[shapley]") {
  const auto toy = experiment<Ishigami>(Ishigami::distributions(), 1);
  const double s13 = 0.2436836641;
  check_against(analysis::shapley_effects(*toy->experiment, 65536, 2)[0],
                {0.3139051911 + s13 / 2, 0.4424111448, s13 / 2}, 0.006);
}

TEST_CASE("inputs that do not matter alone share through those that they are tied to", "[shapley]") {
  // y = x1 - x3 is independent of x2, unless x2 and x3 are correlated; only what reaches an output has a share, and
  // for the model's code all three do: the effect of x2 is that of the order (2, 3), rho^2 s3^2, half the time.
  const double rho = 0.6;
  const auto toy = experiment<Sum>(Sum::distributions(), 1, {pair("x2", "x3", rho)});
  const auto results = analysis::shapley_effects(*toy->experiment, 65536, 2);
  const double x2 = rho * rho * 4 / 2;
  check_against(results[1], {1 / 5., x2 / 5, (4 - x2) / 5}, 0.008);
}

TEST_CASE("many inputs: random orders agree with the closed form", "[shapley]") {
  // x1 and x10, coefficients 1 and 5, tied: as for two inputs, since the rest is independent.
  const double rho = 0.5, v = 110 + 2 * 5 * rho;
  const auto toy = experiment<Ten>(Ten::distributions(), 1, {pair("x1", "x10", rho)});
  std::vector<double> truth;
  for (int i = 0; i < 10; ++i) truth.push_back((i % 5 + 1) * (i % 5 + 1) / v);
  truth[0] = ((1 + 5 * rho) * (1 + 5 * rho) + 1 - rho * rho) / 2 / v;
  truth[9] = (26 + 2 * 5 * rho) / v - truth[0];
  check_against(analysis::shapley_effects(*toy->experiment, 32768, 2)[0], truth, 0.005);
}

TEST_CASE("many inputs: every order is as likely", "[shapley]") {
  // An order and its reverse share an effect of two inputs equally, whatever the order; one of three inputs only if
  // each of them is as often the last: 9 of the variance 9 + 7.
  const auto toy = experiment<Together>(std::vector(10, normal(1)), 1);
  std::vector<double> truth(10, 1 / 16.);
  truth[0] = truth[4] = truth[9] = 3 / 16.;
  check_against(analysis::shapley_effects(*toy->experiment, 32768, 2)[0], truth, 0.012);
}

TEST_CASE("conditional draws have the joint distribution of the plan, whatever is frozen", "[shapley]") {
  // Rectangular and t inputs under one copula: given any frozen set, the mixture's scores have the copula's
  // correlation again, and with A that of the frozen ones. Checked by Spearman's coefficient, 6/pi asin(rho / 2).
  const std::vector<Distribution> inputs{rectangular(0, 1), {Family::t, {0, 1, 4}, {}, {}}, rectangular(-2, 2)};
  const Correlation tied{Correlation::Kind::copula, {"x1", "x2", "x3"}, {1, 0.7, 0.2, 0.7, 1, -0.4, 0.2, -0.4, 1}};
  const auto toy = experiment<Mixed>(inputs, 1, {tied});
  const auto& plan = toy->experiment->plan();
  const analysis::ConditionalDraws draws(plan);
  constexpr std::size_t n = 32768;
  auto block = draws.draw(0, n);
  const auto ranks = [&](const std::vector<double>& x) {
    std::vector<double> u(3 * n);
    for (std::size_t v = 0; v < 3; ++v)
      for (std::size_t i = 0; i < n; ++i) u[v * n + i] = plan.variates[v].distribution.probability(x[v * n + i]) - 0.5;
    return u;
  };
  const auto spearman = [&](const std::vector<double>& x, std::size_t a, const std::vector<double>& y, std::size_t b) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += x[a * n + i] * y[b * n + i];
    return 12 * sum / n;
  };
  const auto kept = ranks(block.a);
  const auto expected = [](double rho) { return 6 / std::numbers::pi * std::asin(rho / 2); };
  const double rho[3][3] = {{1, 0.7, 0.2}, {0.7, 1, -0.4}, {0.2, -0.4, 1}};
  // The variance of 12 u u' is at most 144 E[u^4] = 144 / 80, by Cauchy and Schwarz.
  const double allowed = 4 * std::sqrt(1.8 / n);
  for (int set = 0; set < 8; ++set) {
    const std::vector<bool> frozen{(set & 1) != 0, (set & 2) != 0, (set & 4) != 0};
    draws.mix(block, frozen, 0, n);
    const auto mixed = ranks(block.mixed);
    for (std::size_t a = 0; a < 3; ++a) {
      if (frozen[a])
        for (std::size_t i = 0; i < n; i += 97) REQUIRE(block.mixed[a * n + i] == block.a[a * n + i]);
      for (std::size_t b = 0; b < a; ++b) {
        INFO("set " << set << ", " << a << " " << b);
        CHECK(std::fabs(spearman(mixed, a, mixed, b) - expected(rho[a][b])) < allowed);
      }
    }
    // With only x1 kept, the new x2 knows of the old x2 by way of x1 alone: rho 0.7^2.
    if (set == 1) CHECK(std::fabs(spearman(mixed, 1, kept, 1) - expected(0.49)) < allowed);
  }
}

TEST_CASE("each output shares among the variates that reach it", "[shapley][sobol]") {
  // x2 has a draw of its own at each of two readings.
  const auto toy = experiment<Sum>(Sum::distributions(), 1);
  auto& s = toy->scenario;
  s.quantities[1].entries[0].components[0].per = {"reading"};
  s.readings.push_back(s.readings[0]);
  const propagation::Experiment e(s);
  const auto results = analysis::shapley_effects(e, 16384, 2);
  const auto indices = analysis::sobol_indices(e, 16384, 2);
  REQUIRE(results.size() == 4);
  for (const std::size_t o : {0, 2}) { // y1 of either reading
    // In the plan's order: x1, x2 of reading 1, x3, x2 of reading 2.
    const std::size_t at = o == 0 ? 1 : 2;
    const std::string own = o == 0 ? "x2[reading 1]" : "x2[reading 2]";
    std::vector<double> truth(3, 4 / 6.);
    truth[0] = truth[at] = 1 / 6.;
    check_against(results[o], truth, 0.012);
    CHECK(results[o].effects[at].input == own);
    REQUIRE(indices[o].indices.size() == 3);
    CHECK(indices[o].indices[at].input == own);
    CHECK(indices[o].indices[at].total == Approx(1 / 6.).margin(4 * 0.0022)); // SE^2 = (3 T^2 - 2 T^3) / n
  }
}

TEST_CASE("intervals of Shapley effects cover at their nominal 95 %", "[shapley][coverage]") {
  const Seeds seeds(400, 4000);
  const std::vector<double> truth{0.125, 0.296875, 0.578125};
  std::vector<int> covered(3);
  int ten = 0;
  for (std::size_t k = 0; k < seeds.repetitions; ++k) {
    const auto toy = experiment<Sum>(Sum::distributions(), seeds.first + k, {pair("x2", "x3", 0.5)});
    const auto results = analysis::shapley_effects(*toy->experiment, 1024, 1);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& e = results[0].effects[i];
      covered[i] += e.low <= truth[i] && truth[i] <= e.high;
    }
    const auto many = experiment<Ten>(Ten::distributions(), seeds.first + k);
    const auto e = analysis::shapley_effects(*many->experiment, 1024, 1)[0].effects[4];
    ten += e.low <= 25 / 110. && 25 / 110. <= e.high;
  }
  const double m = static_cast<double>(seeds.repetitions), allowed = 4 * std::sqrt(0.95 * 0.05 / m);
  for (const int c : covered) CHECK(std::fabs(c / m - 0.95) <= allowed);
  CHECK(std::fabs(ten / m - 0.95) <= allowed);
}

TEST_CASE("failed rows of the Shapley design are dropped whole and counted", "[shapley]") {
  const std::uint64_t n = 16384;
  const auto toy = experiment<Failing>({rectangular(-1, 1.1), normal(1)}, 1);
  const Shapley s = analysis::shapley_effects(*toy->experiment, n, 1)[0];
  const double p = 1 - (20. / 21) * (20. / 21), expected = p * static_cast<double>(n); // two draws of x1 in a row
  CHECK(s.rows == n);
  CHECK(std::fabs(static_cast<double>(s.dropped_rows) - expected) <= 4 * std::sqrt(expected * (1 - p)));
  check_against(s, {0.25, 0.75}, 0.012);
}

TEST_CASE("Shapley effects have the same bits for any number of threads", "[shapley]") {
  const auto bits = [](const propagation::Experiment& e, int threads) {
    std::vector<double> all;
    for (const auto& s : analysis::shapley_effects(e, 10'000, threads))
      for (const auto& i : s.effects) all.insert(all.end(), {i.value, i.low, i.high});
    return all;
  };
  const auto few = experiment<Sum>(Sum::distributions(), 1, {pair("x2", "x3", 0.5)});
  const auto many = experiment<Ten>(Ten::distributions(), 1, {pair("x1", "x10", 0.5)});
  for (const auto* toy : {&few, &many}) {
    const auto one = bits(*(*toy)->experiment, 1);
    CHECK(one == bits(*(*toy)->experiment, 7));
  }
}
