// Evidence over campaigns: densities against quadrature, and the promise that looking often costs nothing.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <Eigen/LU>

#include "tracing/campaigns/evidence_over_time.h"

using namespace gumshoe::tracing;

namespace {

/// A campaign of n readings in which `effects` are looked for, each with one size; sizes[k] is that of effect k. The
/// noise's scale and the design are its own.
Campaign campaign(std::mt19937_64& chance, std::size_t n, std::size_t effects, const std::vector<double>& sizes,
                  double noise, int wide = 1) {
  std::normal_distribution<double> normal;
  const auto rows = index(n);
  const Matrix offset = Matrix::Ones(rows, 1) / std::sqrt(static_cast<double>(n));
  const auto left = [&](const Matrix& x) -> Matrix { return x - offset * (offset.transpose() * x); };
  std::vector<Matrix> g;
  Vector y(rows);
  for (Index i = 0; i < rows; ++i) y[i] = 7 + noise * normal(chance);
  for (std::size_t k = 0; k < effects; ++k) {
    Matrix columns(rows, wide);
    for (Index i = 0; i < columns.size(); ++i) columns.data()[i] = normal(chance);
    g.push_back(columns);
    if (k < sizes.size()) y += sizes[k] * columns.col(0);
  }
  Campaign c{"id", "t", "", static_cast<int>(n), y.dot(left(y).col(0)), static_cast<double>(n - 1), {}};
  for (std::size_t k = 0; k < effects; ++k)
    c.scores.push_back({"effect " + std::to_string(k), 0, std::vector<ScoredSize>(std::size_t(wide), {"s", "um", "m"}),
                        g[k].transpose() * left(y).col(0), g[k].transpose() * left(g[k])});
  return c;
}

} // namespace

TEST_CASE("a first campaign's evidence is the Bayes factor of a g-prior", "[tracing]") {
  // Closed form with an unknown scale: (1 + n)^(-k/2) (1 - R^2 n / (1 + n))^(-n/2), n degrees of freedom.
  std::mt19937_64 chance(3);
  for (const int wide : {1, 2, 5}) {
    const Campaign c = campaign(chance, 40, 1, {0.7}, 1.3, wide);
    const Score& s = c.scores[0];
    const double r2 = s.score.dot(s.information.inverse() * s.score) / c.squares, n = c.freedom;
    const double expected = -0.5 * wide * std::log1p(n) - n / 2 * std::log1p(-r2 * n / (1 + n));
    CHECK(evidence_over_time({c}).log_overall == Approx(expected).margin(1e-8));
  }
}

TEST_CASE("evidence of later campaigns has expectation one where nothing is there, whatever was believed",
          "[tracing]") {
  std::mt19937_64 chance(5);
  const Campaign before = campaign(chance, 30, 1, {0.5}, 1);
  const double known = evidence_over_time({before}).log_overall;
  double sum = 0, squares = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    const double e = std::exp(evidence_over_time({before, campaign(chance, 12, 1, {}, 3)}).log_overall - known);
    sum += e, squares += e * e;
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
  CHECK(std::fabs(mean - 1) < 4 * error);
}

TEST_CASE("52 looks at nothing raise at most one false alarm in twenty", "[tracing]") {
  std::mt19937_64 chance(9);
  constexpr int machines = 300, weeks = 52;
  int alarms = 0;
  for (int m = 0; m < machines; ++m) {
    std::vector<Campaign> campaigns;
    bool ever = false;
    for (int week = 0; week < weeks && !ever; ++week) {
      campaigns.push_back(campaign(chance, 20, 6, {}, 1 + 0.1 * week));
      ever = evidence_over_time(campaigns).log_overall > std::log(20.0);
    }
    alarms += ever;
  }
  CHECK(alarms <= 0.05 * machines + 3 * std::sqrt(0.05 * 0.95 * machines)); // the bound is not below 5 %
}

TEST_CASE("a small effect that no campaign shows alone is shown by many", "[tracing]") {
  std::mt19937_64 chance(11);
  std::vector<Campaign> campaigns;
  int first = 0;
  for (int week = 1; week <= 20; ++week) {
    campaigns.push_back(campaign(chance, 25, 8, {0, 0, 0.45}, 1));
    const auto now = evidence_over_time(campaigns);
    if (first == 0 && now.effects[0].log_evidence > std::log(20.0)) first = week;
  }
  const auto last = evidence_over_time(campaigns);
  CHECK(first > 1);
  CHECK(last.effects[0].candidate == "effect 2");
  CHECK(last.effects[0].log_evidence > std::log(1000.0));
  CHECK(last.effects[0].size[0] == Approx(0.45).margin(4 * last.effects[0].u[0]));
  CHECK(last.effects[0].u[0] == Approx(1 / std::sqrt(20 * 25.0)).epsilon(0.15));
  CHECK(last.effects[1].log_evidence < 0);
}

TEST_CASE("what a campaign does not show keeps its evidence", "[tracing]") {
  std::mt19937_64 chance(13);
  std::vector<Campaign> campaigns{campaign(chance, 40, 2, {0.8}, 1)};
  const double before = evidence_over_time(campaigns).effects[0].log_evidence;
  campaigns.push_back(campaign(chance, 40, 2, {0.8}, 1));
  campaigns[1].scores.clear();
  CHECK(evidence_over_time(campaigns).effects[0].log_evidence == before);
  CHECK(evidence_over_time({}).campaigns == 0);
}
