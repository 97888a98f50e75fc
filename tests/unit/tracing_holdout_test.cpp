/// Readings that a fit has not seen, and sizes that were reported because they were large.
#include <catch2/catch.hpp>

#include <boost/math/distributions/normal.hpp>

#include "tracing/findings/errors.h"
#include "tracing/findings/interval.h"
#include "tracing/judgement/holdout.h"
#include "unit/tracing_dense.h"

using namespace tracing_dense;

namespace {

/// Four blocks of seven readings: a slope common to all, and a constant of each block's own.
Design blocks_of_seven() {
  Design d = random_design(28, 1, 5, 2, 7, 21);
  for (Index i = 0; i < 28; ++i)
    for (Index b = 0; b < 4; ++b) d.fixed(i, 1 + b) = i / 7 == b ? 1 : 0;
  return d;
}

std::vector<Index> range(Index first, Index last) {
  std::vector<Index> out;
  for (Index i = first; i < last; ++i) out.push_back(i);
  return out;
}

} // namespace

TEST_CASE("a block is predicted from the others, its own constant projected out", "[tracing]") {
  const Design d = blocks_of_seven();
  const std::vector<Index> train = range(0, 21), test = range(21, 28);
  std::mt19937_64 chance(2);
  const Matrix residual = 1e-6 * normal_matrix(28, 3, chance);
  for (const CovarianceModel& s : {CovarianceModel{}, CovarianceModel{0.4, -1, 0}, CovarianceModel{0.2, 0, 1.4}}) {
    const HeldOut held = hold_out(d, residual, train, test, s, s);
    CHECK(held.count == 6); // seven readings, one constant
    // By dense matrices: coefficients of the training rows, without the column to which none of them is sensitive.
    const Matrix f = chosen(d.fixed, train).leftCols(4),
                 local = local_factor(d, test) * local_factor(d, test).transpose();
    const Matrix own = chosen(d.fixed, test).col(4);
    for (Index j = 0; j < residual.cols(); ++j) {
      const Gls fit = gls(covariance(d, train, s), f, chosen(residual.col(j), train));
      const Vector rest = chosen(residual.col(j), test) - chosen(d.fixed, test).leftCols(4) * fit.size;
      // The draws as the training rows have them: their expectation given the residuals.
      const Vector left = chosen(residual.col(j), train) - f * fit.size,
                   draws = chosen(d.random, train).transpose() * solved(covariance(d, train, s), left),
                   given = rest - chosen(d.random, test) * draws;
      const Gls constant = gls(local, own, given);
      CHECK((held.residual.col(j) - (given - own * constant.size)).norm() < 1e-9 * given.norm());
      CHECK(held.whitened[j] ==
            Approx(gls(covariance(d, test, {0, s.scatter, s.ratio}), own, rest).squares).epsilon(1e-9));
    }
    CHECK(held.declared.dot(held.weighted) == Approx(held.whitened[0]).epsilon(1e-9));
    // The block's own constant may be anything.
    Matrix shifted = residual;
    // A metre: 1e6 times the noise, of which double precision leaves 1e-10.
    shifted.bottomRows(7).array() += 1;
    const HeldOut again = hold_out(d, shifted, train, test, s, s);
    CHECK((again.residual - held.residual).norm() < 1e-9 * held.residual.norm());
    CHECK((again.whitened - held.whitened).norm() < 1e-8 * held.whitened.norm());
  }
}

TEST_CASE("a change is overstated by the normal number that is as improbable for so few readings", "[tracing]") {
  const auto of = [](const Vector& gained, const Vector& left) {
    Design d = random_design(static_cast<std::size_t>(left.size()), 1, 1, 0, 1, 5);
    for (Matrix& noise : d.local) noise.setOnes();
    Scores before, after;
    after.residual = after.declared = after.weighted = left;
    before.residual = before.declared = left + gained;
    return overstated(before, after, d).plain;
  };
  // Two readings of which one tells: Student's t of one degree of freedom is 1, beyond which lies a quarter.
  CHECK(of(Vector::Constant(2, -1), Vector::Unit(2, 0)) == Approx(0.6744897502).epsilon(1e-9));
  // Nine that agree give 3 as it stands, the most that nine can: no chance gives them.
  CHECK(of(Vector::Constant(9, -1), Vector::Ones(9)) > 30);
  // With 400 readings, 230 of them in one direction, it is the ratio itself.
  Vector left = Vector::Ones(400);
  left.tail(170).setConstant(-1);
  CHECK(of(Vector::Constant(400, -1), left) == Approx((230 - 170) / std::sqrt(400.0)).epsilon(0.01));
  CHECK(of(Vector::Constant(400, 1), left) == Approx(-3).epsilon(0.01)); // understated
}

TEST_CASE("a term is fitted to the training rows only", "[tracing]") {
  Design without = blocks_of_seven(), with = without;
  const std::vector<Index> train = range(0, 21), test = range(21, 28);
  std::mt19937_64 chance(3);
  const Matrix signature = normal_matrix(28, 1, chance);
  with.fixed.conservativeResize(28, 6);
  with.fixed.col(5) = signature;
  // A residual that is the signature is predicted in full; without it nothing is.
  CHECK(hold_out(with, 2e-6 * signature, train, test, {}, {}).residual.squaredNorm() <
        1e-15 * hold_out(without, 2e-6 * signature, train, test, {}, {}).residual.squaredNorm());
}

TEST_CASE("a block with no more readings than constants of its own is not scored", "[tracing]") {
  Design d = blocks_of_seven();
  const HeldOut one = hold_out(d, Matrix::Ones(28, 1), range(0, 21), {24}, {}, {});
  CHECK(one.count == 0);
  CHECK(one.whitened[0] == 0);
  // Two constants of their own, two readings; three readings leave one.
  d.fixed.conservativeResize(28, 6);
  d.fixed.col(5).setZero();
  d.fixed(22, 5) = 1;
  d.fixed(25, 5) = 1;
  CHECK(hold_out(d, Matrix::Ones(28, 1), range(0, 21), {21, 22}, {}, {}).count == 0);
  CHECK(hold_out(d, Matrix::Ones(28, 1), range(0, 21), {21, 22, 23}, {}, {}).count == 1);
  // Constants that these readings cannot distinguish count once.
  d.fixed.col(5) = d.fixed.col(4);
  CHECK(hold_out(d, Matrix::Ones(28, 1), range(0, 21), {21, 22, 23}, {}, {}).count == 2);
}

/// Near nothing the interval that excludes zero covers less: of what passes there, the search's error rate is the bound.
TEST_CASE("the interval after selection covers 95 % of what passes the threshold", "[tracing]") {
  const boost::math::normal normal;
  const auto phi = [&](double x) { return boost::math::cdf(normal, x); };
  for (const double c : {0.0, 1.0, 2.0, 3.0, 4.0})
    for (const double mean : {-5.0, -2.0, -0.5, 0.0, 1.0, 2.5, 3.0, 4.0, 8.0}) {
      // Both ends rise with x > 0, so the x whose interval holds m are all between two edges; -x mirrors x.
      const auto edge = [&](double m, bool upper) {
        double low = c, high = c + std::fabs(m) + 12;
        for (int i = 0; i < 40; ++i) {
          const double x = (low + high) / 2;
          const auto [a, b] = gumshoe::tracing::interval_after_selection(x, 1, c);
          ((upper ? a <= m : b < m) ? low : high) = x;
        }
        return (low + high) / 2;
      };
      const double covered = std::max(0.0, phi(edge(mean, true) - mean) - phi(edge(mean, false) - mean)) +
                             std::max(0.0, phi(edge(-mean, true) + mean) - phi(edge(-mean, false) + mean));
      const double passed = phi(mean - c) + phi(-c - mean);
      CAPTURE(c, mean);
      if (c < 1.96)
        CHECK(covered / passed == Approx(0.95).margin(1e-6));
      else if (std::fabs(mean) > 2)
        CHECK(covered / passed == Approx(0.95).margin(0.01));
      else
        CHECK(covered / passed < 0.95 + 1e-6);
    }
}

TEST_CASE("the interval after selection: limits and symmetries", "[tracing]") {
  using gumshoe::tracing::interval_after_selection;
  constexpr double z = 1.959963984540054;
  for (const double x : {-3.0, 0.0, 0.5, 7.0}) {
    const auto [low, high] = interval_after_selection(x, 0.5, 0);
    CHECK(low == Approx(x - 0.5 * z));
    CHECK(high == Approx(x + 0.5 * z));
  }
  // Far above the threshold selection does not matter.
  const auto far = interval_after_selection(20, 1, 3);
  CHECK(far.first == Approx(20 - z).epsilon(1e-9));
  CHECK(far.second == Approx(20 + z).epsilon(1e-9));
  // Both ends rise with the observation, and the estimate is drawn towards zero near the threshold.
  double low = -1e300, high = -1e300;
  for (double x = 3.0; x < 12; x += 0.25) {
    const auto [a, b] = interval_after_selection(x, 1, 3);
    CHECK(a > low);
    CHECK(b > high);
    CHECK(a < b);
    CHECK(b <= x + z + 1e-9);
    low = a;
    high = b;
  }
  CHECK(interval_after_selection(3.05, 1, 3).first == Approx(0.05)); // the test excludes zero
  // A size that would not have passed has its plain interval.
  const auto short_of = interval_after_selection(2.5, 1, 3);
  CHECK(short_of.first == Approx(2.5 - z));
  CHECK(short_of.second == Approx(2.5 + z));
  const auto plus = interval_after_selection(4, 1, 3), minus = interval_after_selection(-4, 1, 3);
  CHECK(plus.first == -minus.second);
  CHECK(plus.second == -minus.first);
  const auto scaled = interval_after_selection(4e-6, 1e-6, 3e-6);
  CHECK(scaled.first == Approx(1e-6 * plus.first));
  CHECK(interval_after_selection(4, 0, 3) == std::pair{4.0, 4.0});
}
