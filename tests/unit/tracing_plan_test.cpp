/// Plans of further readings: D-optimal designs of the textbooks, brute force over all plans, power against closed
/// forms.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numeric>

#include <boost/math/distributions/normal.hpp>

#include "tracing/noise/whitened.h"
#include "tracing/planning/exchange.h"
#include "tracing/planning/power.h"

using namespace gumshoe::tracing;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Readings of a polynomial at x = -1, -0.75, ... 1, of cost 1 each.
PlanTask polynomial(int degree, int most) {
  PlanTask task;
  task.base = 1e-9 * Matrix::Identity(degree + 1, degree + 1);
  for (int i = -4; i <= 4; ++i) {
    Matrix row(1, degree + 1);
    for (int d = 0; d <= degree; ++d) row(0, d) = std::pow(0.25 * i, d);
    task.rows.push_back(row);
  }
  task.cost.assign(task.rows.size(), 1);
  task.opens.resize(task.rows.size());
  for (Index d = 0; d <= degree; ++d) task.free.push_back(d);
  task.most = most;
  return task;
}

/// The cheapest plan that meets all goals, of all there are; infinity: none.
double cheapest(const PlanTask& task) {
  double best = infinity;
  std::vector<int> count(task.rows.size(), 0);
  const std::function<void(std::size_t, int)> each = [&](std::size_t i, int left) {
    if (i == count.size()) {
      double cost = 0;
      std::vector<bool> open(task.opening.size(), false);
      for (std::size_t k = 0; k < count.size(); ++k) {
        cost += count[k] * task.cost[k];
        for (const std::size_t s : task.opens[k]) open[s] = open[s] || count[k] > 0;
      }
      for (std::size_t s = 0; s < open.size(); ++s) cost += open[s] ? task.opening[s] : 0;
      if (cost >= best || cost > task.budget) return;
      const Matrix m = information(task, count);
      for (const PlanGoal& goal : task.goals)
        if (reached(goal, m) < enough) return;
      best = cost;
      return;
    }
    for (int n = 0; n <= left; ++n) {
      count[i] = n;
      each(i + 1, left - n);
    }
    count[i] = 0;
  };
  each(0, task.most);
  return best;
}

/// Eight readings, some in a new set-up with its own offset. Goals: tell one effect from another, and determine a sum.
PlanTask made_up(std::uint64_t seed) {
  const Matrix x = normals(8, 3, seed, 90);
  PlanTask task;
  task.base = Matrix::Zero(5, 5);
  task.base.diagonal() << 4, 1e-6, 1, 0.5,
      0.5; // offset measured, offset new, a declared draw, two effects hardly known
  for (int i = 0; i < 8; ++i) {
    const bool fresh = i >= 4;
    Matrix row(1, 5);
    row << (fresh ? 0 : 1), (fresh ? 1 : 0), x(i, 0), x(i, 1), x(i, 1) + 0.7 * x(i, 2);
    task.rows.push_back(row);
    task.cost.push_back(1 + 0.5 * (i % 3));
    task.opens.push_back(fresh ? std::vector<std::size_t>{0} : std::vector<std::size_t>{});
  }
  task.opening = {seed % 2 == 0 ? 1.5 : 0.25};
  task.most = 6;
  task.goals.push_back({PlanGoal::Kind::size, {3}, {0, 1, 2, 4}, Vector::Constant(1, 1.5), 2});
  task.goals.push_back({PlanGoal::Kind::uncertainty, {0, 3}, {1, 2, 4}, Vector::Ones(2), 0.8});
  return task;
}

} // namespace

TEST_CASE("D-optimal plans of a line and a parabola are those of the textbooks", "[tracing][plan]") {
  // Fedorov 1972, section 2.3: a line is measured at its ends, a parabola at -1, 0, 1, in equal parts.
  CHECK(find_plan(polynomial(1, 8)).count == std::vector<int>{4, 0, 0, 0, 0, 0, 0, 0, 4});
  CHECK(find_plan(polynomial(2, 9)).count == std::vector<int>{3, 0, 0, 0, 3, 0, 0, 0, 3});
}

TEST_CASE("a budget buys the more informative readings for its costs", "[tracing][plan]") {
  PlanTask task = polynomial(1, 100);
  task.cost.back() = 3;
  task.budget = 24;
  // x = 1 costs three times as much. D-optimal with cost: half of the money at each end if only the ends were allowed;
  // x = 0.75 for a third of the price is better. The determinant is n1 n2 (x2 - x1)^2: 12 * 12 * 1.75^2 > 12 * 4 * 2^2.
  const PlanFound found = find_plan(task);
  CHECK(found.count == std::vector<int>{12, 0, 0, 0, 0, 0, 0, 12, 0});
  CHECK(found.cost == Approx(24));
}

TEST_CASE("no plan of all is cheaper than the one that is found", "[tracing][plan]") {
  int possible = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const PlanTask task = made_up(seed);
    const double least = cheapest(task);
    const PlanFound found = find_plan(task);
    INFO("seed " << seed << ", of all plans " << least << ", found " << found.cost);
    CHECK(found.met == std::isfinite(least));
    if (!std::isfinite(least)) continue;
    ++possible;
    CHECK(found.cost == Approx(least).epsilon(1e-9));
    const Matrix m = information(task, found.count);
    for (const PlanGoal& goal : task.goals) CHECK(reached(goal, m) >= enough);
  }
  CHECK(possible >= 20); // else the test says little
}

TEST_CASE("one reading of a new set-up says nothing, two do", "[tracing][plan]") {
  // Offset known exactly as far as readings of the set-up tell it, effect of size 1 at x = 0 and 10, noise 1.
  PlanTask task;
  task.base = Matrix::Zero(2, 2);
  task.base.diagonal() << 1e-9, 1e-9;
  for (const double x : {0.0, 10.0}) {
    Matrix row(1, 2);
    row << 1, x;
    task.rows.push_back(row);
    task.opens.push_back({0});
  }
  task.cost = {1, 1};
  task.opening = {5};
  task.most = 4;
  task.goals.push_back({PlanGoal::Kind::size, {1}, {0}, Vector::Ones(1), 49});
  // Non-centrality of n and m readings: 100 n m / (n + m); one each gives 50.
  const PlanFound found = find_plan(task);
  CHECK(found.met);
  CHECK(found.count == std::vector<int>{1, 1});
  CHECK(found.cost == Approx(7));
}

TEST_CASE("u of a mean after n readings with a shared offset is the closed form", "[tracing][plan]") {
  // Columns: mean, the set-up's declared draw (standard uncertainty 0.5, noise 1): u^2 = 0.25 + 1 / n.
  PlanTask task;
  task.base = Matrix::Zero(2, 2);
  task.base.diagonal() << 1e-12, 1;
  Matrix row(1, 2);
  row << 1, 0.5;
  task.rows = {row};
  const PlanGoal goal{PlanGoal::Kind::uncertainty, {0}, {1}, Vector::Ones(1), 1};
  for (const int n : {1, 3, 10})
    CHECK(1 / reached(goal, information(task, {n})) == Approx(0.25 + 1.0 / n).epsilon(1e-9));
}

TEST_CASE("power of a test is that of the normal distribution, and F tends to chi-squared", "[tracing][plan]") {
  const boost::math::normal normal;
  for (const double alpha : {0.05, 0.001})
    for (const double size : {0.5, 2.0, 4.0}) {
      const double z = boost::math::quantile(normal, 1 - alpha / 2);
      const double exact = boost::math::cdf(normal, size - z) + boost::math::cdf(normal, -size - z);
      CHECK(power(size * size, 1, infinity, alpha) == Approx(exact).epsilon(1e-9));
      CHECK(power(size * size, 1, 1e7, alpha) == Approx(exact).epsilon(1e-4));
      CHECK(power(size * size, 1, 6, alpha) < exact);
    }
  CHECK(power(noncentrality_for(0.9, 2, infinity, 0.001), 2, infinity, 0.001) == Approx(0.9));
  CHECK(power(noncentrality_for(0.9, 1, 8, 0.05), 1, 8, 0.05) == Approx(0.9));
}

TEST_CASE("an effect of any size may be missed where the noise is hardly known", "[tracing][plan]") {
  // One degree of freedom: the effect d is seen if |d| > t |w|, w normal, t Cauchy's quantile; its own scatter adds 1 /
  // d.
  const boost::math::normal normal;
  const double alpha = 1e-3, t = std::tan(0.5 * 3.14159265358979 * (1 - alpha));
  for (const double d : {150.0, 300.0, 900.0, 1100.0}) { // t is 637; both sides of d^2 = 1e6
    const double exact = 2 * boost::math::cdf(normal, d / t) - 1;
    CHECK(power(d * d, 1, 1, alpha) == Approx(exact).epsilon(1e-4));
  }
  CHECK(power(noncentrality_for(0.9, 1, 1, alpha), 1, 1, alpha) == Approx(0.9));
  CHECK(power(1e12, 1, 0, alpha) == alpha); // no residual is left
}

TEST_CASE("power with an estimated noise is the share of simulated t-tests", "[tracing][plan]") {
  // 10 readings of a mean of 1.2 noises, t-test at 5 %: tolerance of five standard deviations of a share of 20,000
  // sets.
  constexpr int sets = 20'000, n = 10;
  const Matrix noise = normals(n, sets, 7, 91);
  int found = 0;
  for (Index i = 0; i < sets; ++i) {
    const Vector y = noise.col(i).array() + 1.2;
    const double mean = y.mean(), s2 = (y.array() - mean).square().sum() / (n - 1);
    found += mean * mean * n / s2 > 5.1173550; // F(1, 9) at 0.95
  }
  const double p = power(1.2 * 1.2 * n, 1, n - 1, 0.05);
  CHECK(static_cast<double>(found) / sets == Approx(p).margin(5 * std::sqrt(p * (1 - p) / sets)));
}
