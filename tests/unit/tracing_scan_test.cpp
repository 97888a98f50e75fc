/// The scan of many signatures is generalised least squares with and without each of them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <random>

#include "tracing/noise/declared_response.h"
#include "unit/tracing_dense.h"

using namespace tracing_dense;

namespace {

/// Double precision over condition numbers of some thousands.
constexpr double rounding = 1e-9;

struct Case {
  std::size_t readings, indications;
  Index fixed, random;
  std::size_t groups;
};
const Case cases[] = {{30, 1, 3, 0, 0}, {30, 1, 3, 4, 6}, {15, 2, 2, 3, 6}, {10, 3, 2, 2, 0}, {28, 1, 0, 2, 7}};

/// ln |V| but for the own noise's part, and ln |F'V^-1 F| with F in units of the noise and columns of length one.
double dense_determinant(const Design& d, const std::vector<Index>& rows, const CovarianceModel& s) {
  const Matrix v = covariance(d, rows, s);
  double out = ln_determinant(v) - 2 * local_factor(d, rows).diagonal().array().log().sum();
  if (d.fixed.cols() == 0) return out;
  Matrix f = chosen(d.fixed, rows);
  for (Index j = 0; j < f.cols(); ++j) {
    double square = 0;
    for (Index i = 0; i < f.rows(); ++i)
      square += std::pow(
          f(i, j) / d.reference[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]) % d.indications], 2);
    f.col(j) /= std::sqrt(square);
  }
  return out + ln_determinant(f.transpose() * solved(v, f));
}

/// Residuals none of which needs to be winsorised.
Vector tame(const Scan& scan, const Design& d, const std::vector<Index>& rows, std::uint64_t seed) {
  for (;; ++seed) {
    std::mt19937_64 chance(seed);
    const Vector e = local_factor(d, rows) * normal_matrix(static_cast<Index>(rows.size()), 1, chance) +
                     chosen(d.random, rows) * normal_matrix(d.random.cols(), 1, chance);
    Matrix weight;
    scan.winsorised(e, nullptr, &weight);
    if (weight.minCoeff() == 1) return e;
  }
}

} // namespace

TEST_CASE("likelihood, sizes and information are those of dense generalised least squares", "[tracing]") {
  for (const Case& c : cases)
    for (const std::uint64_t seed : {1, 2}) {
      Design d = random_design(c.readings, c.indications, c.fixed, c.random, c.groups, seed);
      if (c.groups > 0) { // beside groups that come back, some of neighbours
        Grouping neighbours = d.scatter[0];
        for (std::size_t r = 0; r < c.readings; ++r) neighbours.group[r] = r * c.groups / c.readings;
        d.scatter.push_back(std::move(neighbours));
      }
      std::vector<Index> rows = all_rows(d);
      if (seed == 2) // not all readings: the last two left out, whole
        rows.resize(rows.size() - 2 * c.indications);
      const auto n = static_cast<Index>(rows.size());
      std::mt19937_64 chance(seed + 100);
      const Candidate one = candidate(normal_matrix(d.fixed.rows(), 1, chance)),
                      pair = candidate(normal_matrix(d.fixed.rows(), 2, chance));
      const std::vector<const Candidate*> candidates{&one, &pair};
      const Scan scan(d, rows, candidates, 1);
      const Vector y = tame(scan, d, rows, seed + 10);
      const Matrix f = chosen(d.fixed, rows);
      const double freedom = static_cast<double>(n - c.fixed);
      REQUIRE(scan.degrees_of_freedom() == static_cast<std::size_t>(n - c.fixed));
      double base = 1e300, with[2] = {1e300, 1e300};
      std::size_t best = 0, best_with[2] = {0, 0};
      for (std::size_t k = 0; k < scan.covariance_models().size(); ++k) {
        const CovarianceModel& s = scan.covariance_models()[k];
        CAPTURE(c.readings, c.indications, seed, s.correlation, s.scatter, s.ratio);
        const Matrix v = covariance(d, rows, s);
        const double determinant = dense_determinant(d, rows, s);
        CHECK(scan.whitened(k).log_determinant() == Approx(determinant).margin(1e-9 * static_cast<double>(n)));
        const Whitened& w = scan.whitened(k);
        const Gls without = gls(v, f, y);
        CHECK(w.squares(y)[0] == Approx(without.squares).epsilon(rounding));
        if (const double x = freedom * std::log(without.squares) + determinant; x < base) base = x, best = k;
        for (std::size_t a = 0; a < 2; ++a) {
          const Matrix g = chosen(candidates[a]->columns, rows);
          const Gls both = gls(v, joined(f, g), y);
          if (const double x = freedom * std::log(both.squares) + determinant; x < with[a])
            with[a] = x, best_with[a] = k;
          // Coefficients, together with the declared and scattering parts.
          Design extended = d;
          extended.fixed = joined(d.fixed, candidates[a]->columns);
          std::vector<Index> use;
          for (Index j = 0; j < extended.fixed.cols(); ++j) use.push_back(j);
          const Whitened wider(extended, rows, use, s);
          Matrix covariance_of_all;
          const Vector x = wider.coefficients(y, &covariance_of_all);
          const Index p = f.cols();
          for (Index j = 0; j < p + g.cols(); ++j) {
            const double u = std::sqrt(both.covariance(j, j));
            CHECK(x[j] == Approx(both.size[j]).margin(1e-8 * u));
            CHECK(std::sqrt(covariance_of_all(j, j)) == Approx(u).epsilon(1e-7));
          }
          CHECK(wider.squares(y)[0] == Approx(both.squares).epsilon(rounding));
          // g'WMg of one column: one over the variance of its size, given only the fixed columns.
          const Gls alone = gls(v, joined(f, g.col(0)), y);
          CHECK(scan.information(a, 0, k) == Approx(1 / alone.covariance(p, p)).epsilon(1e-8));
        }
      }
      const Statistics found = scan.run(y);
      CHECK(found.covariance_model[0] == best);
      CHECK(found.criterion[0] == Approx(base).epsilon(rounding));
      CHECK(found.variance[0] ==
            Approx(gls(covariance(d, rows, scan.covariance_models()[best]), f, y).squares / freedom).epsilon(1e-8));
      const Matrix local = local_factor(d, rows), plain = covariance(d, rows, {});
      for (std::size_t a = 0; a < 2; ++a) {
        const Matrix g = chosen(candidates[a]->columns, rows);
        const auto row = static_cast<Index>(a);
        CHECK(found.ratio(row, 0) == Approx(std::max(0.0, base - with[a])).margin(1e-7));
        const Fit fit = scan.fit(a, y);
        const Gls dense = gls(covariance(d, rows, scan.covariance_models()[best_with[a]]), joined(f, g), y);
        CHECK(fit.covariance_model == best_with[a]);
        CHECK(fit.ratio == Approx(found.ratio(row, 0)).margin(1e-7));
        for (Index j = 0; j < g.cols(); ++j) {
          const Index at = f.cols() + j;
          const double u =
              std::sqrt(dense.squares / (freedom - static_cast<double>(g.cols())) * dense.covariance(at, at));
          CHECK(fit.size[j] == Approx(dense.size[at]).margin(1e-8 * u));
          CHECK(fit.u[j] == Approx(u).epsilon(1e-7));
        }
        // Share of the signature, in units of the own noise, that fixed and declared columns leave.
        const Matrix x = local.triangularView<Eigen::Lower>().solve(g);
        double left = 0;
        for (Index j = 0; j < g.cols(); ++j) left += gls(plain, f, g.col(j)).squares;
        CHECK(scan.identifiable(a) == Approx(left / x.squaredNorm()).epsilon(1e-8));
      }
      // Both together, and a signature that is a fixed column: nothing is left to see.
      const Gls all = gls(covariance(d, rows, scan.covariance_models()[best]),
                          joined(f, joined(chosen(one.columns, rows), chosen(pair.columns, rows))), y);
      const double alone = gls(covariance(d, rows, scan.covariance_models()[best]), f, y).squares;
      CHECK(scan.pair_ratio(0, 1, y, best) == Approx(freedom * std::log(alone / all.squares)).margin(1e-7));
      const double together = found.criterion[0] - freedom * std::log(alone / all.squares);
      CHECK(scan.pair_criteria({0, 1}, 1, y, best)(0, 1) == Approx(together).margin(1e-7));
      CHECK(scan.pair_criteria({1, 0}, 1, y, best_with[1])(0, 0) ==
            Approx(found.criterion[0] - found.ratio(1, 0)).margin(1e-7));
      if (c.fixed > 0) {
        const Candidate absorbed = candidate(d.fixed.col(0) * 3);
        const Scan nothing(d, rows, {&absorbed}, 1);
        CHECK(nothing.identifiable(0) < 1e-12);
        CHECK(nothing.run(y).ratio(0, 0) == 0);
        CHECK(nothing.absorbed_by(0) == 0);
      }
    }
}

TEST_CASE("draws of the noise have the dense covariance", "[tracing]") {
  constexpr Index draws = 20000;
  for (const Case& c : {cases[1], cases[2]}) {
    const Design d = random_design(c.readings, c.indications, c.fixed, c.random, c.groups, 3);
    const std::vector<Index> rows = all_rows(d);
    std::vector<Index> use;
    for (Index j = 0; j < d.fixed.cols(); ++j) use.push_back(j);
    const CovarianceModel s{0.6, 0, 2.8};
    const Whitened w(d, rows, use, s);
    const Matrix e = w.draw(draws, 17), v = covariance(d, rows, s);
    std::mt19937_64 chance(5);
    // Variance of a mean square of normal numbers is 2 / draws of its square; five standard deviations.
    const double tolerance = 5 * std::sqrt(2.0 / static_cast<double>(draws));
    for (int i = 0; i < 20; ++i) {
      const Vector direction = normal_matrix(e.rows(), 1, chance);
      const double expected = direction.dot(v * direction);
      CHECK((e.transpose() * direction).squaredNorm() / static_cast<double>(draws) ==
            Approx(expected).epsilon(tolerance));
    }
    // What is left of it is chi-squared: its mean is the degrees of freedom.
    const double freedom = static_cast<double>(e.rows() - d.fixed.cols());
    CHECK(w.squares(e).mean() == Approx(freedom).margin(5 * std::sqrt(2 * freedom / static_cast<double>(draws))));
  }
}

TEST_CASE("outlying residuals are winsorised to 3.5 robust standard deviations", "[tracing]") {
  const Design d = random_design(60, 1, 2, 0, 0, 4);
  const std::vector<Index> rows = all_rows(d);
  const Scan scan(d, rows, {}, 1);
  Vector y = tame(scan, d, rows, 8);
  CHECK((scan.winsorised(y) - y).norm() < 1e-12 * y.norm());
  const double own = d.local[20](0, 0);
  y[20] += 400 * own;
  Vector scale;
  Matrix weight;
  const Vector drawn = scan.winsorised(y, &scale, &weight);
  CHECK(weight(20, 0) < 0.1);
  // The outlier comes in to 3.5 times the scale of what the fit of the winsorised readings leaves, within the hundredth
  // of it to which that is repeated.
  const Vector left = y - d.fixed * gls(covariance(d, rows, {}), d.fixed, drawn).size;
  std::vector<double> sizes;
  for (Index i = 0; i < 60; ++i) sizes.push_back(std::fabs(left[i]) / d.local[static_cast<std::size_t>(i)](0, 0));
  std::sort(sizes.begin(), sizes.end());
  CHECK(scale[0] == Approx(sizes[30] / 0.6744897501960817 / std::sqrt(58.0 / 60.0)).epsilon(0.01));
  CHECK(std::fabs(left[20] - (y[20] - drawn[20])) == Approx(3.5 * scale[0] * own).epsilon(0.01));
}

TEST_CASE("an outlying reading makes no outliers of those that share its unknowns", "[tracing]") {
  // Five readings with a constant and a slope of their own, the third off by 25 standard deviations: by least squares a
  // fifth of that is in each of the others, beyond 3.5 standard deviations.
  Design d = random_design(60, 1, 3, 0, 0, 4);
  for (Index i = 0; i < 60; ++i) {
    const bool own = i < 5;
    d.fixed.row(i) << (own ? 0 : 1e-6), (own ? 1e-6 : 0), (own ? 1e-6 * static_cast<double>(i) : 0);
  }
  for (Matrix& l : d.local) l(0, 0) = 1e-6;
  const std::vector<Index> rows = all_rows(d);
  const Scan scan(d, rows, {}, 1);
  Vector y = tame(scan, d, rows, 8);
  y[2] += 25e-6;
  Matrix weight;
  scan.winsorised(y, nullptr, &weight);
  CHECK(weight(2, 0) < 0.2);
  for (const Index i : {0, 1, 3, 4}) CHECK(weight(i, 0) == 1);
}

TEST_CASE("rounded readings, most of them equal, still have a scale", "[tracing]") {
  Design d = random_design(40, 1, 0, 0, 0, 6);
  for (Matrix& l : d.local) l(0, 0) = 1e-6;
  Vector y = Vector::Zero(40);
  for (Index i = 0; i < 40; i += 3) y[i] = 1e-6; // a third of them one step off
  Vector scale;
  Matrix weight;
  const Scan scan(d, all_rows(d), {}, 1);
  CHECK((scan.winsorised(y, &scale, &weight) - y).norm() < 1e-18);
  CHECK(weight.minCoeff() == 1);
  CHECK(scale[0] > 0.1);
}

TEST_CASE("a third of the readings one step off are no outliers", "[tracing]") {
  // Normal noise of half a step, read in steps, under a slope that leaves no two residuals equal.
  Design d = random_design(90, 1, 0, 0, 0, 6);
  for (Matrix& l : d.local) l(0, 0) = 1;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  Vector y(90);
  for (Index i = 0; i < 90; ++i) y[i] = 2 * std::round(normal(generator) / 2) + 1e-3 * static_cast<double>(i);
  Matrix weight;
  Vector scale;
  const Scan scan(d, all_rows(d), {}, 1);
  scan.winsorised(y, &scale, &weight);
  CHECK(weight.minCoeff() == 1);
  CHECK(scale[0] > 1);
}

TEST_CASE("readings far out are put among the draws in their share", "[tracing]") {
  Design d = random_design(60, 1, 2, 0, 0, 4);
  const std::vector<Index> rows = all_rows(d);
  Vector y = tame(Scan(d, rows, {}, 1), d, rows, 8);
  for (const Index i : {20, 41}) y[i] += 15 * d.local[static_cast<std::size_t>(i)](0, 0);
  const auto found = Scan(d, rows, {}, 1).noise_shape(y);
  REQUIRE(found.sizes.size() == 2);
  CHECK(found.share == Approx(2.0 / 60 - std::erfc(3.5 / std::sqrt(2.0))));
  // One value in ten is outlying: the rest are normal, and smaller by the share of the variance that these have.
  d = {};
  d.reading = {0, 1, 2, 3};
  d.fixed = Matrix(4, 0);
  d.random = Matrix(4, 0);
  d.local.assign(4, Matrix::Constant(1, 1, 2.0));
  d.reference = {2.0};
  const gumshoe::tracing::NoiseShape one_in_ten{0.1, {8.0}, {}};
  CHECK(one_in_ten.core() == Approx(1 / std::sqrt(1 + 0.1 * (3.5 * 3.5 - 1))));
  constexpr std::size_t sets = 20000;
  const Matrix drawn =
      gumshoe::tracing::Whitened(d, all_rows(d), {}, {}).draw(sets, 7, one_in_ten) / (2 * one_in_ten.core());
  const double out = static_cast<double>((drawn.array().abs() > 7.9).count()) / (4 * sets);
  CHECK(out == Approx(0.1).margin(5 * std::sqrt(0.09 / (4 * sets))));
  const double within = (drawn.array().abs() > 7.9).select(0, drawn).squaredNorm() / (4 * sets * 0.9);
  CHECK(within == Approx(1).margin(5 * std::sqrt(2 / (4 * sets * 0.9))));
}

TEST_CASE("a variance component is drawn as the readings jump with it", "[tracing]") {
  // Two readings of one group, the second of which knows only the sign.
  Design d = random_design(2, 1, 0, 0, 1, 4);
  d.local.assign(2, Matrix::Constant(1, 1, 1e-9));
  Matrix table(2, gumshoe::tracing::bend_nodes);
  for (Index j = 0; j < gumshoe::tracing::bend_nodes; ++j) {
    const double z = gumshoe::tracing::bend_node(j);
    table.col(j) << z, (z > 0 ? 3 : -3);
  }
  const gumshoe::tracing::NoiseShape jumping{0, {}, table};
  const Matrix drawn = gumshoe::tracing::Whitened(d, {0, 1}, {}, {0, 0, 1.0}).draw(1000, 7, jumping);
  for (Index j = 0; j < drawn.cols(); ++j)
    if (std::fabs(drawn(0, j)) > 0.06) CHECK(drawn(1, j) == Approx(std::copysign(3, drawn(0, j))).margin(1e-6));
  CHECK(drawn.row(0).squaredNorm() / 1000 == Approx(1).margin(5 * std::sqrt(2.0 / 1000)));
}

TEST_CASE("a declared draw that bends is drawn as it bends", "[tracing]") {
  // Beside z half a unit up or down: variance 1 + E|z| + 1/4, and no noise to summarise of.
  Design d;
  d.reading = {0};
  d.fixed = Matrix(1, 0);
  d.random = Matrix::Ones(1, 1);
  d.local = {Matrix::Constant(1, 1, 0.5)};
  d.straight = {Matrix::Constant(1, 1, 1e-6)};
  d.reference = {0.5};
  d.bent = {0};
  d.bends = {Matrix(1, gumshoe::tracing::bend_nodes)};
  for (Index j = 0; j < gumshoe::tracing::bend_nodes; ++j) {
    const double z = gumshoe::tracing::bend_node(j);
    d.bends[0](0, j) = z > 1e-9 ? 0.5 : z < -1e-9 ? -0.5 : 0;
  }
  constexpr std::size_t sets = 40000;
  const Matrix drawn = gumshoe::tracing::Whitened(d, {0}, {}, {}).draw(sets, 7);
  const double expected = 1.25 + std::sqrt(2 / std::numbers::pi);
  // The variance of a mean square is below that of a normal one of this size, 2 expected^2 / n; half a node's width
  // about zero has no bend: 0.04 of the draws, each less by at most 0.3.
  CHECK(drawn.squaredNorm() / sets == Approx(expected).margin(5 * expected * std::sqrt(2.0 / sets) + 0.012));
  CHECK(drawn.mean() == Approx(0).margin(5 * std::sqrt(expected / sets)));
}
